//! The report as Markdown: text and tables. Curves and pictures are in the HTML.

use super::document::{Block, Document, Entry, Mark, PictureTable, Span, Table, spans};

/// Writes a report.
pub(super) fn write(document: &Document) -> String {
    let mut out = format!("# {}\n\n{}\n\n", document.title, plain(&document.subtitle));
    out.push_str("## In short\n\n");
    push_list(&mut out, &document.summary);
    for block in &document.blocks {
        push(&mut out, block);
    }
    out
}

fn push(out: &mut String, block: &Block) {
    match block {
        Block::Heading(level, title) => {
            let hashes = "#".repeat(usize::from(*level) + 1);
            out.push_str(&format!("{hashes} {title}\n\n"));
        }
        Block::Paragraph(text) => out.push_str(&format!("{}\n\n", plain(text))),
        Block::List(points) => push_list(out, points),
        Block::Terms(terms) => {
            let terms = terms
                .iter()
                .map(|(term, meaning)| format!("**{term}**: {meaning}"));
            push_list(out, &terms.collect::<Vec<_>>());
        }
        Block::Table(table) => push_table(out, table),
        Block::Drawing { caption, .. } => {
            out.push_str(&format!("(In the HTML, a figure: {})\n\n", plain(caption)));
        }
        Block::Pictures(table) => push_pictures(out, table),
        Block::Commands(commands) => {
            for (title, command) in commands {
                out.push_str(&format!("{}\n\n```text\n{command}\n```\n\n", plain(title)));
            }
        }
        Block::Code(text) => out.push_str(&format!("```text\n{text}\n```\n\n")),
    }
}

fn push_list(out: &mut String, points: &[String]) {
    for point in points {
        out.push_str(&format!("- {}\n", plain(point)));
    }
    out.push('\n');
}

fn push_table(out: &mut String, table: &Table) {
    out.push_str(&format!("{}\n\n", plain(&table.caption)));
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    out.push_str(&row(table
        .columns
        .iter()
        .map(|column| plain(column))
        .collect()));
    let rule = |index: usize| match index {
        0 => "---",
        _ if table.is_text => "---",
        _ => "---:",
    };
    out.push_str(&row((0..table.columns.len())
        .map(|index| rule(index).to_owned())
        .collect()));
    for cells in &table.rows {
        out.push_str(&row(cells.iter().map(entry).collect()));
    }
    out.push('\n');
}

fn push_pictures(out: &mut String, table: &PictureTable) {
    let mut entries = table.rows.iter().flat_map(|(_, row)| row);
    if entries.all(|entry| entry.lines.is_empty()) {
        out.push_str(&format!(
            "(In the HTML, a picture: {})\n\n",
            plain(&table.caption)
        ));
    } else {
        push_table(out, &without_pictures(table));
    }
}

fn entry(entry: &Entry) -> String {
    let text = plain(&entry.text).replace('|', "\\|");
    match entry.mark {
        Mark::Best => format!("**{text}**"),
        Mark::None | Mark::Good | Mark::Bad => text,
    }
}

/// What stands under the pictures, as a table.
fn without_pictures(table: &PictureTable) -> Table {
    let mut columns = vec![String::new()];
    let width = table
        .rows
        .iter()
        .map(|(_, row)| row.len())
        .max()
        .unwrap_or(0);
    columns.extend((0..width).map(|index| table.columns.get(index).cloned().unwrap_or_default()));
    let rows = table.rows.iter().map(|(title, row)| {
        let mut cells = vec![Entry::new(title.clone())];
        cells.extend((0..width).map(|index| match row.get(index) {
            Some(picture) => {
                let lines: Vec<&str> = picture
                    .lines
                    .iter()
                    .map(|line| line.text.as_str())
                    .collect();
                Entry::new(lines.join("; "))
            }
            None => Entry::default(),
        }));
        cells
    });
    Table {
        caption: table.caption.clone(),
        columns,
        is_text: true,
        rows: rows.collect(),
    }
}

/// Marks as Markdown has them; formulae as code.
fn plain(text: &str) -> String {
    let write = |span: Span<'_>| match span {
        Span::Plain(text) => text.to_owned(),
        Span::Code(text) | Span::Formula(text) => format!("`{text}`"),
        Span::Strong(text) => format!("**{text}**"),
    };
    spans(text).into_iter().map(write).collect()
}
