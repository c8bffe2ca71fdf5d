//! Text for people: aligned columns, counts, and numbers with as many digits as matter.

use std::io::{self, Write};

use crate::console::{DIM, styled};
use crate::failure::one_line;

/// `1 joint`, `25 joints`, `1,000 joints`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", grouped(count))
}

/// A count with commas between its thousands.
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// How many decimals show a thousandth of `size`, the length that the numbers are about.
pub(crate) fn decimals_for(size: f64) -> usize {
    match size.abs() {
        size if size >= 300.0 => 0,
        size if size >= 30.0 => 1,
        size if size >= 3.0 => 2,
        size if size >= 0.3 => 3,
        size if size >= 0.03 => 4,
        _ => 5,
    }
}

/// How many decimals show a number itself, to about three digits: a length of a millionth is not 0.
pub(crate) fn decimals_to_show(value: f64) -> usize {
    const MOST: usize = 12;
    let mut decimals = 3;
    let mut shown = value.abs() * 10.0;
    while shown > 0.0 && shown < 1.0 && decimals < MOST {
        shown *= 10.0;
        decimals += 1;
    }
    decimals
}

/// A number with at most `decimals` of them and no zeros at the end.
pub(crate) fn trimmed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A number with exactly `decimals` of them; never `-0.00`.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| byte == b'0' || byte == b'.') => {
            digits.to_owned()
        }
        _ => text,
    }
}

/// Seconds, or minutes and seconds from two minutes on.
pub(crate) fn duration(secs: f64) -> String {
    if secs < 120.0 {
        return format!("{} s", trimmed(secs, 2));
    }
    let minutes = (secs / 60.0).floor();
    format!("{minutes} min {} s", trimmed(secs - minutes * 60.0, 1))
}

/// How a column stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    /// Text.
    Left,
    /// Numbers.
    Right,
}

/// Rows of cells under a heading, every column as wide as its widest cell.
#[derive(Debug)]
pub(crate) struct Table {
    columns: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub(crate) fn new(columns: &[(&str, Align)]) -> Self {
        let columns = columns
            .iter()
            .map(|&(title, align)| (title.to_owned(), align))
            .collect();
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row with a cell for every column; names in them are shown on one line.
    pub(crate) fn row(&mut self, cells: Vec<String>) {
        debug_assert_eq!(cells.len(), self.columns.len(), "a cell for every column");
        self.rows
            .push(cells.iter().map(|cell| one_line(cell)).collect());
    }

    /// Writes heading and rows.
    pub(crate) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|column| {
                let cells = self.rows.iter().map(|row| width(&row[column]));
                cells.max().unwrap_or(0).max(width(&self.columns[column].0))
            })
            .collect();
        let titles: Vec<String> = self
            .columns
            .iter()
            .map(|(title, _)| title.clone())
            .collect();
        writeln!(out, "{}", styled(DIM, &self.line(&titles, &widths)))?;
        self.rows
            .iter()
            .try_for_each(|row| writeln!(out, "{}", self.line(row, &widths)))
    }

    fn line(&self, cells: &[String], widths: &[usize]) -> String {
        let mut line = String::new();
        for ((cell, &wanted), (_, align)) in cells.iter().zip(widths).zip(&self.columns) {
            let padding = " ".repeat(wanted.saturating_sub(width(cell)));
            if !line.is_empty() {
                line.push_str("  ");
            }
            match align {
                Align::Left => line.extend([cell.as_str(), &padding]),
                Align::Right => line.extend([padding.as_str(), cell]),
            }
        }
        line.truncate(line.trim_end().len());
        line
    }
}

/// How many columns of a terminal text takes; close enough for names.
pub(crate) fn width(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(counted(1, "joint"), "1 joint");
        assert_eq!(counted(3000, "frame"), "3,000 frames");
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(trimmed(59.940_06, 2), "59.94");
        assert_eq!(trimmed(60.0, 2), "60");
        assert_eq!(trimmed(100.0, 0), "100");
        assert_eq!(duration(3.0333), "3.03 s");
        assert_eq!(duration(150.0), "2 min 30 s");
    }

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&[("joint", Align::Left), ("y", Align::Right)]);
        table.row(vec!["Hüfte".to_owned(), "1.50".to_owned()]);
        table.row(vec!["Kopf".to_owned(), "10.25".to_owned()]);
        let mut out = Vec::new();
        table.write(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines, ["Hüfte   1.50", "Kopf   10.25"]);
    }
}
