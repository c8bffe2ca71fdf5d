//! The report before it is a file: headings, text, tables, curves, pictures. HTML and Markdown are two ways
//! to write it.
//!
//! Text has three marks in it: `` `code` ``, `**strong**` and `$formula$`.

use super::experiment::Cell;

/// A report.
#[derive(Debug)]
pub(super) struct Document {
    /// Its title.
    pub(super) title: String,
    /// The line under it.
    pub(super) subtitle: String,
    /// What came out, in few sentences.
    pub(super) summary: Vec<String>,
    /// The rest.
    pub(super) blocks: Vec<Block>,
    /// The pictures that it refers to, by number.
    pub(super) shots: Vec<Shot>,
}

/// A piece of a report.
#[derive(Debug)]
pub(super) enum Block {
    /// A heading: 1 for a chapter, 2 for a section.
    Heading(u8, String),
    /// A paragraph.
    Paragraph(String),
    /// Points.
    List(Vec<String>),
    /// Words and what they mean.
    Terms(Vec<(String, String)>),
    /// A table.
    Table(Table),
    /// A drawing, as SVG, with what it shows.
    Drawing {
        /// The drawing.
        svg: String,
        /// What it shows.
        caption: String,
    },
    /// A table of pictures.
    Pictures(PictureTable),
    /// Lines to be typed.
    Code(String),
    /// What commands show, and the commands.
    Commands(Vec<(String, String)>),
}

/// A table.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// What it shows.
    pub(super) caption: String,
    /// The heading of each column; the first is of text, the others of numbers unless `is_text`.
    pub(super) columns: Vec<String>,
    /// Whether all columns hold text.
    pub(super) is_text: bool,
    /// The rows.
    pub(super) rows: Vec<Vec<Entry>>,
}

/// A table with more columns than this is too wide for a page.
const MOST_COLUMNS: usize = 9;

impl Table {
    /// A table of numbers that fits a page: one that is too wide has its rows as columns.
    pub(super) fn fitted(self) -> Self {
        if self.columns.len() <= MOST_COLUMNS || self.rows.len() >= MOST_COLUMNS {
            return self;
        }
        let first = self.columns.iter().take(1).cloned();
        let heads = self
            .rows
            .iter()
            .filter_map(|row| Some(row.first()?.text.clone()));
        let rows = (1..self.columns.len()).map(|column| {
            let entries = self
                .rows
                .iter()
                .map(|row| row.get(column).cloned().unwrap_or_default());
            let head = Entry::new(self.columns[column].clone());
            std::iter::once(head).chain(entries).collect()
        });
        Self {
            columns: first.chain(heads).collect(),
            rows: rows.collect(),
            ..self
        }
    }
}

/// What stands in a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Entry {
    /// The text.
    pub(super) text: String,
    /// Whether it stands out.
    pub(super) mark: Mark,
}

/// How an entry stands out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Mark {
    /// Not at all.
    #[default]
    None,
    /// It is the best of its column.
    Best,
    /// It is reached.
    Good,
    /// It is not.
    Bad,
}

impl Entry {
    /// Plain text.
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            mark: Mark::None,
        }
    }
}

/// A table of pictures.
#[derive(Debug)]
pub(super) struct PictureTable {
    /// What it shows.
    pub(super) caption: String,
    /// The heading of each column; none where the columns mean nothing.
    pub(super) columns: Vec<String>,
    /// The rows, each with its heading.
    pub(super) rows: Vec<(String, Vec<PictureEntry>)>,
}

/// A picture and what stands under it.
#[derive(Debug)]
pub(super) struct PictureEntry {
    /// Number of the picture.
    pub(super) shot: usize,
    /// What it shows, for those who do not see it.
    pub(super) alt: String,
    /// What stands under it, a line each.
    pub(super) lines: Vec<Entry>,
}

/// A picture that is to be taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Shot {
    /// The start pose with a chain and its named targets.
    Start(usize),
    /// The pose that a run left.
    Run(Cell),
}

impl Document {
    /// The number of a picture, which is taken once however often it is shown.
    pub(super) fn shot(&mut self, shot: Shot) -> usize {
        if let Some(known) = self.shots.iter().position(|other| *other == shot) {
            return known;
        }
        self.shots.push(shot);
        self.shots.len() - 1
    }

    /// Adds a chapter.
    pub(super) fn chapter(&mut self, title: &str) {
        self.blocks.push(Block::Heading(1, title.to_owned()));
    }

    /// Adds a section.
    pub(super) fn section(&mut self, title: &str) {
        self.blocks.push(Block::Heading(2, title.to_owned()));
    }

    /// Adds a paragraph, unless it is empty.
    pub(super) fn paragraph(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !text.is_empty() {
            self.blocks.push(Block::Paragraph(text));
        }
    }
}

/// A piece of text between marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Span<'a> {
    /// Plain.
    Plain(&'a str),
    /// Between backticks.
    Code(&'a str),
    /// Between double asterisks.
    Strong(&'a str),
    /// Between dollar signs.
    Formula(&'a str),
}

/// The pieces of a text. A mark without its partner is plain.
pub(super) fn spans(text: &str) -> Vec<Span<'_>> {
    type Make = for<'a> fn(&'a str) -> Span<'a>;
    const MARKS: [(&str, Make); 3] = [
        ("`", |text| Span::Code(text)),
        ("**", |text| Span::Strong(text)),
        ("$", |text| Span::Formula(text)),
    ];
    let mut found = Vec::new();
    let mut rest = text;
    let mut plain_from = text;
    while !rest.is_empty() {
        let opened = MARKS.iter().find_map(|&(mark, make)| {
            let inside = rest.strip_prefix(mark)?;
            let end = inside.find(mark)?;
            Some((make(&inside[..end]), &inside[end + mark.len()..]))
        });
        if let Some((span, after)) = opened {
            let plain = &plain_from[..plain_from.len() - rest.len()];
            if !plain.is_empty() {
                found.push(Span::Plain(plain));
            }
            found.push(span);
            (rest, plain_from) = (after, after);
        } else {
            let next = rest.chars().next().map_or(0, char::len_utf8);
            rest = &rest[next..];
        }
    }
    if !plain_from.is_empty() {
        found.push(Span::Plain(plain_from));
    }
    found
}

/// A name that somebody else gave, as code.
pub(super) fn code(name: &str) -> String {
    let clean: String = name
        .chars()
        .map(|c| if c == '`' { '\'' } else { c })
        .filter(|c| !c.is_control())
        .collect();
    format!("`{clean}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_table_has_its_rows_as_columns() {
        let wide = |width: usize| Table {
            caption: "x".to_owned(),
            columns: (0..width).map(|column| column.to_string()).collect(),
            is_text: false,
            rows: vec![
                (0..width)
                    .map(|column| Entry::new(format!("a{column}")))
                    .collect(),
            ],
        };
        assert_eq!(wide(9).fitted().rows.len(), 1);
        let turned = wide(10).fitted();
        assert_eq!(turned.columns, ["0", "a0"]);
        assert_eq!(turned.rows.len(), 9);
        assert_eq!(turned.rows[4], [Entry::new("5"), Entry::new("a5")]);
    }

    #[test]
    fn marks_make_spans_and_lonely_marks_are_text() {
        assert_eq!(
            spans("a `b*$` is **so** $x²$ and 5 $ or *"),
            [
                Span::Plain("a "),
                Span::Code("b*$"),
                Span::Plain(" is "),
                Span::Strong("so"),
                Span::Plain(" "),
                Span::Formula("x²"),
                Span::Plain(" and 5 $ or *"),
            ]
        );
        assert_eq!(spans(""), []);
        assert_eq!(code("a`b\n"), "`a'b`");
    }
}
