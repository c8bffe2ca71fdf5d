//! The report as a page that needs nothing but itself.

use std::fmt::Write;

use super::chart;
use super::compare::Comparison;
use super::report::EXPLANATION;
use crate::text::fixed;

const HEAD: &str = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
<meta name=\"viewport\" content=\"width=device-width\">\n<style>\n\
:root { color-scheme: light dark; --line: #8884; }\n\
body { font: 15px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; }\n\
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }\n\
th, td { padding: .25rem .7rem; border-bottom: 1px solid var(--line); text-align: right; }\n\
th:first-child, td:first-child { text-align: left; }\n\
figure { margin: 1.5rem 0; } svg { width: 100%; height: auto; }\n\
svg text { fill: currentColor; font-size: 12px; } .wide { overflow-x: auto; }\n\
</style>\n";

/// The page.
pub(super) fn page(comparison: &Comparison) -> String {
    let name = escaped(&comparison.name);
    let mut page = format!(
        "{HEAD}<title>In-betweens of {name}</title></head><body>\n<h1>In-betweens of {name}</h1>\n\
         <p>{}. {EXPLANATION}</p>\n",
        comparison.summary()
    );
    let (heads, rows) = comparison.table();
    table(&mut page, &heads, &rows);
    page.push_str("<h2>Over time</h2>\n");
    page.push_str(&chart::over_time(comparison));
    page.push_str("<h2>Joint by joint</h2>\n<p>Mean and largest angle, in degrees.</p>\n");
    let methods: Vec<String> = comparison
        .methods
        .iter()
        .map(|(m, _)| m.to_string())
        .collect();
    let mut heads = vec!["joint"];
    heads.extend(methods.iter().map(String::as_str));
    let rows: Vec<Vec<String>> = comparison
        .joints
        .iter()
        .enumerate()
        .map(|(index, name)| {
            let cells = comparison.methods.iter().map(|(_, error)| {
                let joint = &error.joints[index];
                format!("{} / {}", fixed(joint.mean_deg, 3), fixed(joint.max_deg, 2))
            });
            std::iter::once(name.clone()).chain(cells).collect()
        })
        .collect();
    table(&mut page, &heads, &rows);
    page.push_str("</body></html>\n");
    page
}

fn table(page: &mut String, heads: &[&str], rows: &[Vec<String>]) {
    page.push_str("<div class=\"wide\"><table><thead><tr>");
    for head in heads {
        // Writing to a string does not fail.
        let _ = write!(page, "<th>{}</th>", escaped(head));
    }
    page.push_str("</tr></thead><tbody>\n");
    for row in rows {
        page.push_str("<tr>");
        for cell in row {
            let _ = write!(page, "<td>{}</td>", escaped(cell));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody></table></div>\n");
}

/// Text that is no markup.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
