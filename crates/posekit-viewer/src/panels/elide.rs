//! Names that are longer than their room: what is left out, and where.

use egui::{FontId, Ui};

/// The sign for what is left out.
const ELLIPSIS: char = '\u{2026}';

/// As much of a name's beginning stays, where there is room for it, when its end tells more: points.
const HEAD_ROOM: f32 = 24.0;

/// A name as it fits into a width. What it has in common with those beside it, its first `common` bytes, is
/// left out first; then the middle of the rest, so that its end stays.
#[must_use]
pub fn name_within(ui: &Ui, name: &str, common: usize, font: &FontId, width: f32) -> String {
    ui.fonts_mut(|fonts| {
        let mut measure = |c: char| fonts.glyph_width(font, c);
        elided(name, common, width, &mut measure)
    })
}

/// A path as it fits into a width: its beginning is left out.
#[must_use]
pub fn path_within(ui: &Ui, path: &str, font: &FontId, width: f32) -> String {
    ui.fonts_mut(|fonts| {
        let mut measure = |c: char| fonts.glyph_width(font, c);
        if width_of(path, &mut measure) <= width {
            return path.to_owned();
        }
        let room = width - measure(ELLIPSIS);
        format!("{ELLIPSIS}{}", tail(path, room, &mut measure))
    })
}

fn width_of(text: &str, measure: &mut impl FnMut(char) -> f32) -> f32 {
    text.chars().map(measure).sum()
}

/// As much of a text's beginning as there is room for.
fn head<'a>(text: &'a str, room: f32, measure: &mut impl FnMut(char) -> f32) -> &'a str {
    let mut used = 0.0;
    for (at, c) in text.char_indices() {
        used += measure(c);
        if used > room {
            return &text[..at];
        }
    }
    text
}

/// As much of a text's end as there is room for.
fn tail<'a>(text: &'a str, room: f32, measure: &mut impl FnMut(char) -> f32) -> &'a str {
    let mut used = 0.0;
    for (at, c) in text.char_indices().rev() {
        used += measure(c);
        if used > room {
            return &text[at + c.len_utf8()..];
        }
    }
    text
}

fn elided(name: &str, common: usize, width: f32, measure: &mut impl FnMut(char) -> f32) -> String {
    if width_of(name, measure) <= width {
        return name.to_owned();
    }
    let ellipsis = measure(ELLIPSIS);
    let (shared, own) = match name.split_at_checked(common) {
        Some((shared, own)) if !own.is_empty() => (shared, own),
        _ => ("", name),
    };
    let room = width - ellipsis - width_of(own, measure);
    if room >= 0.0 && !shared.is_empty() {
        return format!("{}{ELLIPSIS}{own}", head(shared, room, measure));
    }
    // What tells it apart is itself too long: both its ends stay.
    let mut left = (width - ellipsis).max(0.0);
    let mut before = String::new();
    if !shared.is_empty() && left > 6.0 * HEAD_ROOM {
        before = format!("{}{ELLIPSIS}", head(shared, HEAD_ROOM, measure));
        left -= width_of(&before, measure);
    }
    let start = head(own, left / 2.0, measure);
    let rest = &own[start.len()..];
    let end = tail(rest, left - width_of(start, measure), measure);
    format!("{before}{start}{ELLIPSIS}{end}")
}

/// How many bytes all of some names have in common at their beginning, back to the end of a word.
#[must_use]
pub fn common_prefix<'a>(names: impl IntoIterator<Item = &'a str>) -> usize {
    let mut names = names.into_iter();
    let Some(first) = names.next() else { return 0 };
    let mut common = first;
    let mut count = 1;
    for name in names {
        count += 1;
        let pairs = common.char_indices().zip(name.chars());
        let last = pairs.take_while(|((_, a), b)| a == b).last();
        common = last.map_or("", |((at, c), _)| &common[..at + c.len_utf8()]);
    }
    if count < 2 {
        return 0;
    }
    let word_end = common.rfind(|c: char| !c.is_alphanumeric());
    word_end.map_or(0, |at| {
        at + common[at..].chars().next().map_or(0, char::len_utf8)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn within(name: &str, common: usize, width: f32) -> String {
        elided(name, common, width, &mut |_| 1.0)
    }

    #[test]
    fn what_tells_names_apart_stays() {
        let names = [
            "dataset-1_walk-left_normal_001.bvh",
            "dataset-1_walk-right_normal_001.bvh",
        ];
        let common = common_prefix(names);
        assert_eq!(&names[0][..common], "dataset-1_walk-");
        assert_eq!(within(names[0], common, 50.0), names[0]);
        assert_eq!(
            within(names[0], common, 24.0),
            "data\u{2026}left_normal_001.bvh"
        );
        assert_eq!(
            within(names[0], common, 20.0),
            "\u{2026}left_normal_001.bvh"
        );
        assert_eq!(within(names[0], common, 13.0), "left_n\u{2026}01.bvh");
        assert_eq!(within(names[1], common, 13.0), "right_\u{2026}01.bvh");
    }

    #[test]
    fn names_of_every_kind_are_cut_between_characters() {
        for (name, common) in [("\u{e9}\u{e9}\u{e9}\u{e9}\u{e9}", 3), ("ab", 9), ("", 0)] {
            for width in [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0] {
                let shown = within(name, common, width);
                assert!(
                    shown.chars().count() <= name.chars().count().max(1),
                    "{shown}"
                );
            }
        }
        assert_eq!(common_prefix(["only.bvh"]), 0);
        assert_eq!(common_prefix(["a1.bvh", "b1.bvh"]), 0);
        assert_eq!(common_prefix([]), 0);
        assert_eq!(common_prefix(["walk_01", "walk_02"]), 5);
    }
}
