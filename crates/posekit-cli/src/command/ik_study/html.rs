//! The report as one HTML file that needs nothing else: no script, no other file, no network. It is
//! well-formed XML too.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::document::{
    Block, Document, Entry, Mark, PictureEntry, PictureTable, Span, Table, spans,
};

/// How it looks, on a screen and on paper.
const STYLE: &str = include_str!("style.css");

/// On paper a table with more rows than this may break between two of them.
const MOST_KEPT_ROWS: usize = 14;

/// Writes a report; `pictures` are PNG files, by number.
pub(super) fn write(document: &Document, pictures: &[Vec<u8>]) -> String {
    let mut page = Page {
        out: String::new(),
        chapters: 0,
        sections: 0,
        tables: 0,
        figures: 0,
        pictures,
    };
    page.head(document);
    page.contents(document);
    for block in &document.blocks {
        page.block(block);
    }
    page.out.push_str("</main>\n</body>\n</html>\n");
    page.out
}

/// Text as it stands in HTML.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no word for them.
            c if c.is_control() || c == '\u{fffe}' || c == '\u{ffff}' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

fn marked_up(text: &str) -> String {
    let write = |span: Span<'_>| match span {
        Span::Plain(text) => escaped(text),
        Span::Code(text) => format!("<code>{}</code>", escaped(text)),
        Span::Strong(text) => format!("<strong>{}</strong>", escaped(text)),
        Span::Formula(text) => format!("<span class=\"formula\">{}</span>", escaped(text)),
    };
    spans(text).into_iter().map(write).collect()
}

/// The file as far as it is written.
struct Page<'a> {
    out: String,
    chapters: u32,
    sections: u32,
    tables: u32,
    figures: u32,
    pictures: &'a [Vec<u8>],
}

impl Page<'_> {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn head(&mut self, document: &Document) {
        let title = escaped(&document.title);
        self.line("<!DOCTYPE html>");
        self.line("<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>");
        self.line("<meta charset=\"utf-8\"/>");
        self.line("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
        self.line("<meta name=\"color-scheme\" content=\"light dark\"/>");
        self.line("<meta name=\"generator\" content=\"posekit\"/>");
        self.line(&format!(
            "<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>"
        ));
        self.line(&format!("<header>\n<h1>{title}</h1>"));
        let subtitle = marked_up(&document.subtitle);
        self.line(&format!("<p class=\"subtitle\">{subtitle}</p>\n</header>"));
        self.line("<section class=\"summary\">\n<h2>In short</h2>\n<ul>");
        for sentence in &document.summary {
            self.line(&format!("<li>{}</li>", marked_up(sentence)));
        }
        self.line("</ul>\n</section>");
    }

    fn contents(&mut self, document: &Document) {
        self.line("<nav>\n<ol>");
        let mut chapters = 0;
        for block in &document.blocks {
            if let Block::Heading(1, title) = block {
                chapters += 1;
                let title = escaped(title);
                self.line(&format!(
                    "<li><a href=\"#chapter-{chapters}\">{title}</a></li>"
                ));
            }
        }
        self.line("</ol>\n</nav>");
    }

    fn block(&mut self, block: &Block) {
        match block {
            Block::Heading(1, title) => {
                self.chapters += 1;
                self.sections = 0;
                let (number, title) = (self.chapters, escaped(title));
                self.line(&format!(
                    "<h2 id=\"chapter-{number}\"><span class=\"number\">{number}</span> {title}</h2>"
                ));
            }
            Block::Heading(_, title) => {
                self.sections += 1;
                let (chapter, section) = (self.chapters, self.sections);
                let title = escaped(title);
                self.line(&format!(
                    "<h3 id=\"section-{chapter}-{section}\"><span class=\"number\">{chapter}.{section}</span> \
                     {title}</h3>"
                ));
            }
            Block::Paragraph(text) => {
                let text = marked_up(text);
                self.line(&format!("<p>{text}</p>"));
            }
            Block::List(points) => {
                self.line("<ul>");
                for point in points {
                    let point = marked_up(point);
                    self.line(&format!("<li>{point}</li>"));
                }
                self.line("</ul>");
            }
            Block::Terms(terms) => {
                self.line("<dl>");
                for (term, meaning) in terms {
                    let (term, meaning) = (marked_up(term), marked_up(meaning));
                    self.line(&format!("<dt>{term}</dt><dd>{meaning}</dd>"));
                }
                self.line("</dl>");
            }
            Block::Table(table) => self.table(table),
            Block::Drawing { svg, caption } => {
                self.figures += 1;
                let (number, caption) = (self.figures, marked_up(caption));
                self.line(&format!(
                    "<figure class=\"drawing\">\n{svg}\n<figcaption><b>Figure {number}.</b> {caption}</figcaption>\n\
                     </figure>"
                ));
            }
            Block::Pictures(table) => self.picture_table(table),
            Block::Commands(commands) => {
                self.line("<ul class=\"commands\">");
                for (title, command) in commands {
                    let (title, command) = (marked_up(title), escaped(command));
                    self.line(&format!("<li>{title}<pre>{command}</pre></li>"));
                }
                self.line("</ul>");
            }
            Block::Code(text) => {
                let text: Vec<String> = text.lines().map(escaped).collect();
                self.line(&format!("<pre>{}</pre>", text.join("\n")));
            }
        }
    }

    fn picture(&self, entry: &PictureEntry) -> String {
        let png = self.pictures.get(entry.shot).map_or(&[][..], Vec::as_slice);
        embedded(png, &entry.alt)
    }

    fn table(&mut self, table: &Table) {
        self.tables += 1;
        let (number, caption) = (self.tables, marked_up(&table.caption));
        let class = match (table.is_text, table.rows.len()) {
            (true, _) => "text",
            (false, 0..=MOST_KEPT_ROWS) => "numbers",
            (false, _) => "numbers long",
        };
        self.line(&format!(
            "<figure class=\"table\"><figcaption><b>Table {number}.</b> {caption}</figcaption>\n<table class=\"{class}\">"
        ));
        let heads = table
            .columns
            .iter()
            .map(|column| format!("<th>{}</th>", marked_up(column)));
        let heads: String = heads.collect();
        self.line(&format!("<thead><tr>{heads}</tr></thead>\n<tbody>"));
        for row in &table.rows {
            self.out.push_str("<tr>");
            for (index, entry) in row.iter().enumerate() {
                let tag = if index == 0 { "th" } else { "td" };
                let (class, text) = (class_of(entry.mark), marked_up(&entry.text));
                self.out.push_str(&format!("<{tag}{class}>{text}</{tag}>"));
            }
            self.line("</tr>");
        }
        self.line("</tbody>\n</table></figure>");
    }

    fn picture_table(&mut self, table: &PictureTable) {
        if let [(title, row)] = table.rows.as_slice()
            && let [only] = row.as_slice()
            && title.is_empty()
        {
            self.figures += 1;
            let (number, caption) = (self.figures, marked_up(&table.caption));
            let picture = self.picture(only);
            self.line(&format!(
                "<figure class=\"picture\">{picture}<figcaption><b>Figure {number}.</b> {caption}</figcaption></figure>"
            ));
            return;
        }
        self.tables += 1;
        let (number, caption) = (self.tables, marked_up(&table.caption));
        let width = table
            .rows
            .iter()
            .map(|(_, row)| row.len())
            .max()
            .unwrap_or(0);
        self.line(&format!(
            "<figure class=\"table\"><figcaption><b>Table {number}.</b> {caption}</figcaption>\n\
             <table class=\"pictures across-{width}\">"
        ));
        let has_titles = table.rows.iter().any(|(title, _)| !title.is_empty());
        if !table.columns.is_empty() {
            let heads = table
                .columns
                .iter()
                .map(|column| format!("<th>{}</th>", marked_up(column)));
            let corner = if has_titles { "<td></td>" } else { "" };
            let heads: String = heads.collect();
            self.line(&format!("<thead><tr>{corner}{heads}</tr></thead>"));
        }
        self.line("<tbody>");
        for (title, row) in &table.rows {
            self.out.push_str("<tr>");
            if has_titles {
                self.out.push_str(&format!("<th>{}</th>", marked_up(title)));
            }
            for entry in row {
                let lines: String = entry.lines.iter().map(line_under).collect();
                let picture = self.picture(entry);
                self.out.push_str(&format!("<td>{picture}{lines}</td>"));
            }
            self.line("</tr>");
        }
        self.line("</tbody>\n</table></figure>");
    }
}

/// The picture as part of the page.
fn embedded(png: &[u8], alt: &str) -> String {
    let (data, alt) = (STANDARD.encode(png), escaped(alt));
    format!("<img src=\"data:image/png;base64,{data}\" alt=\"{alt}\"/>")
}

fn line_under(entry: &Entry) -> String {
    format!(
        "<div{}>{}</div>",
        class_of(entry.mark),
        marked_up(&entry.text)
    )
}

fn class_of(mark: Mark) -> &'static str {
    match mark {
        Mark::None => "",
        Mark::Best => " class=\"best\"",
        Mark::Good => " class=\"good\"",
        Mark::Bad => " class=\"bad\"",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_others_named_cannot_break_out() {
        assert_eq!(
            marked_up("`<b>` & **\"x\"**"),
            "<code>&lt;b&gt;</code> &amp; <strong>&quot;x&quot;</strong>"
        );
        assert_eq!(escaped("a\u{1}b"), "a b");
    }
}
