//! Names that are longer than their room: what is left out, and where.

use egui::{FontId, Ui};

/// The sign for what is left out.
const ELLIPSIS: char = '\u{2026}';

/// As much of a name's beginning stays, where there is room for it, when its end tells more: points.
const HEAD_ROOM: f32 = 24.0;

/// How much of a word stays before and after the place where it goes another way than other names, in
/// characters: as much as there is room for.
const REACHES: [[usize; 2]; 4] = [[16, 16], [6, 8], [3, 5], [1, 3]];

/// A name as it fits into a width. Its words at `branches`, the bytes at which it goes another way than those
/// beside it, stay; what is left out first is what it has in common with them. Then its end stays before its
/// beginning.
#[must_use]
pub fn name_within(ui: &Ui, name: &str, branches: &[usize], font: &FontId, width: f32) -> String {
    ui.fonts_mut(|fonts| {
        let mut measure = |c: char| fonts.glyph_width(font, c);
        elided(name, branches, width, &mut measure)
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

/// As many of a text's parts as fit into a width, the first ones; of the first alone what fits.
#[must_use]
pub fn parts_within<'a>(
    ui: &Ui,
    text: &'a str,
    between: &str,
    font: &FontId,
    width: f32,
) -> &'a str {
    ui.fonts_mut(|fonts| parts(text, between, width, &mut |c| fonts.glyph_width(font, c)))
}

fn parts<'a>(
    text: &'a str,
    between: &str,
    width: f32,
    measure: &mut impl FnMut(char) -> f32,
) -> &'a str {
    let mut shown = text;
    while width_of(shown, measure) > width
        && let Some((first, _)) = shown.rsplit_once(between)
    {
        shown = first;
    }
    shown
}

fn width_of(text: &str, measure: &mut impl FnMut(char) -> f32) -> f32 {
    text.chars().map(measure).sum()
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

fn elided(
    name: &str,
    branches: &[usize],
    width: f32,
    measure: &mut impl FnMut(char) -> f32,
) -> String {
    if width_of(name, measure) <= width {
        return name.to_owned();
    }
    let mut cut = Cut {
        chars: name.chars().map(|c| (c, measure(c))).collect(),
        stays: vec![false; name.chars().count()],
        ellipsis: measure(ELLIPSIS),
        width,
    };
    let branches: Vec<usize> = branches
        .iter()
        .map(|at| name.char_indices().take_while(|(i, _)| i < at).count())
        .collect();
    cut.keep_words_at(&branches);
    let word = cut.stays.iter().position(|stays| *stays);
    let spare = match word {
        None => cut.left() / 2.0,
        Some(0) => cut.left(),
        Some(_) if cut.left() > 4.0 * HEAD_ROOM => cut.left() - HEAD_ROOM,
        Some(_) => cut.left(),
    };
    cut.extend_head(spare);
    // Both sides of what is left out in the middle come nearer to each other.
    while cut.extend_end() | word.is_some_and(|word| cut.extend_from(word)) {}
    let before = cut.stays.clone();
    // One or two characters say nothing.
    if cut.extend_head(0.0) < 3 && before.first() == Some(&false) {
        cut.stays = before;
    }
    cut.text()
}

/// Which characters of a name stay.
struct Cut {
    /// With their widths.
    chars: Vec<(char, f32)>,
    stays: Vec<bool>,
    ellipsis: f32,
    width: f32,
}

impl Cut {
    /// How much of the width is left.
    fn left(&self) -> f32 {
        let mut used = 0.0;
        let mut is_gap = false;
        for ((_, width), stays) in self.chars.iter().zip(&self.stays) {
            used += match (stays, is_gap) {
                (true, _) => *width,
                (false, false) => self.ellipsis,
                (false, true) => 0.0,
            };
            is_gap = !stays;
        }
        self.width - used
    }

    /// Keeps the words at these characters: whole ones, else what of them is nearest to the characters, else
    /// those of the last ones.
    fn keep_words_at(&mut self, branches: &[usize]) {
        for reach in REACHES {
            self.stays.fill(false);
            self.mark(branches, reach);
            if self.left() >= 0.0 {
                return;
            }
        }
        for kept in 1..=branches.len() {
            self.stays.fill(false);
            self.mark(&branches[kept..], REACHES[3]);
            if self.left() >= 0.0 {
                return;
            }
        }
        self.stays.fill(false);
    }

    fn mark(&mut self, branches: &[usize], [back, on]: [usize; 2]) {
        let is_word = |at: usize| self.chars.get(at).is_some_and(|(c, _)| c.is_alphanumeric());
        for &at in branches {
            let mut start = at.min(self.chars.len());
            while start > 0 && at - start < back && is_word(start - 1) {
                start -= 1;
            }
            let mut end = at;
            // Where a word ends in one name and goes on in another, the next one tells as much.
            while end < self.chars.len() && end - at < on && !is_word(end) {
                end += 1;
            }
            while end - at < on && is_word(end) {
                end += 1;
            }
            self.stays[start..end.min(self.chars.len())].fill(true);
        }
        // A sign for one narrow character would say less in more room.
        for at in 0..self.chars.len() {
            let is_kept =
                |at: Option<usize>| at.is_none_or(|at| self.stays.get(at).copied().unwrap_or(true));
            if is_kept(at.checked_sub(1))
                && is_kept(Some(at + 1))
                && self.chars[at].1 <= self.ellipsis
            {
                self.stays[at] = true;
            }
        }
    }

    fn add(&mut self, at: Option<usize>, spare: f32) -> bool {
        let Some(at) = at else { return false };
        self.stays[at] = true;
        let fits = self.left() >= spare;
        self.stays[at] = fits;
        fits
    }

    /// One more character of the end.
    fn extend_end(&mut self) -> bool {
        let at = self.stays.iter().rposition(|stays| !stays);
        // The last gap is that before everything: the beginning comes later.
        let at = at.filter(|at| *at + 1 == self.chars.len() || self.stays[..*at].contains(&true));
        self.add(at, 0.0)
    }

    /// One more character after the part that stays from there on.
    fn extend_from(&mut self, start: usize) -> bool {
        let gap = self.stays[start..].iter().position(|stays| !stays);
        self.add(gap.map(|gap| start + gap), 0.0)
    }

    /// As much of the beginning as leaves `spare`: how many characters.
    fn extend_head(&mut self, spare: f32) -> usize {
        let mut count = 0;
        while count < self.stays.len() && (self.stays[count] || self.add(Some(count), spare)) {
            count += 1;
        }
        count
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for ((c, _), stays) in self.chars.iter().zip(&self.stays) {
            if *stays {
                text.push(*c);
            } else if !text.ends_with(ELLIPSIS) {
                text.push(ELLIPSIS);
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::names::branches;

    /// Names as they stand beside each other in so many characters.
    fn all_within(names: &[&str], width: f32) -> Vec<String> {
        let branches = branches(names);
        let pairs = names.iter().zip(&branches);
        pairs
            .map(|(name, branches)| elided(name, branches, width, &mut |_| 1.0))
            .collect()
    }

    #[test]
    fn what_tells_names_apart_stays() {
        let names = [
            "dataset-1_walk-left_normal_001.bvh",
            "dataset-1_walk-right_normal_001.bvh",
        ];
        let shown = |width| all_within(&names, width);
        assert_eq!(shown(50.0), names);
        assert_eq!(shown(24.0)[0], "data\u{2026}left_normal_001.bvh");
        assert_eq!(shown(20.0)[0], "\u{2026}left_normal_001.bvh");
        assert_eq!(shown(13.0)[0], "\u{2026}left_no\u{2026}.bvh");
        assert_eq!(shown(13.0)[1], "\u{2026}right_no\u{2026}bvh");
    }

    #[test]
    fn long_names_are_told_apart_wherever_they_differ() {
        // In the middle, at the end, by a word more, in two places; and others beside them.
        const LONG: &str = "subject01_session2026-11-30_markerset-plugingait_trial_walking_normal_speed_right_foot_first";
        let names: Vec<String> = ["left", "right"]
            .map(|side| format!("recording of the {side} side of the treadmill, incline 5 percent, speed 1.2 metres a second, with shoes.bvh"))
            .into_iter()
            .chain(["take01", "take02", "take02_cleaned"].map(|take| format!("{LONG}_{take}.bvh")))
            .chain(["left_01", "left_02", "right_01", "right_02"].map(|end| format!("walk_at_a_comfortable_speed_{end}_of_a_long_session_on_a_treadmill.bvh")))
            .chain(["run.bvh".to_owned()])
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        for width in [18.0, 20.0, 24.0, 30.0, 48.0] {
            let shown = all_within(&names, width);
            for (index, one) in shown.iter().enumerate() {
                assert!(one.chars().count() as f32 <= width, "{one}");
                let same = shown.iter().filter(|other| *other == one).count();
                assert_eq!(
                    same, 1,
                    "{width}: {} is {one}, and so is another",
                    names[index]
                );
            }
        }
        let shown = all_within(&names, 30.0);
        assert!(
            shown[0].contains("left") && shown[1].contains("right"),
            "{shown:?}"
        );
        assert!(
            shown[3].contains("take02.bvh") && shown[4].contains("cleaned"),
            "{shown:?}"
        );
    }

    #[test]
    fn of_numbers_whole_ones_are_left_out() {
        let shown = |width| {
            parts(
                "4.4 s \u{b7} 120 fps \u{b7} 38 joints",
                " \u{b7} ",
                width,
                &mut |_| 1.0,
            )
        };
        assert_eq!(shown(40.0), "4.4 s \u{b7} 120 fps \u{b7} 38 joints");
        assert_eq!(shown(20.0), "4.4 s \u{b7} 120 fps");
        assert_eq!(shown(14.0), "4.4 s");
        assert_eq!(shown(2.0), "4.4 s");
    }

    #[test]
    fn a_name_alone_keeps_both_its_ends() {
        let shown = elided("a_rather_long_name.bvh", &[], 11.0, &mut |_| 1.0);
        assert_eq!(shown, "a_rat\u{2026}e.bvh");
    }

    #[test]
    fn names_of_every_kind_are_cut_between_characters() {
        for (name, at) in [("\u{e9}\u{e9}\u{e9}\u{e9}\u{e9}", 4), ("ab", 9), ("", 0)] {
            for width in [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0] {
                let shown = elided(name, &[0, at], width, &mut |_| 1.0);
                assert!(
                    shown.chars().count() <= name.chars().count().max(1),
                    "{shown}"
                );
            }
        }
    }
}
