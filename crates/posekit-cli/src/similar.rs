//! Of the names that there are, the one that a mistyped name was meant to be.

/// A name of `known` so near to `typed` that a slip explains the difference: other capitals, a part of the
/// name, or, in a name of three letters and more, a letter in three that is missing, too many, another, or swapped
/// with its neighbour. The nearest, and the first of equals.
pub(crate) fn nearest<'a>(
    typed: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let typed = folded(typed);
    if typed.is_empty() {
        return None;
    }
    let mut best: Option<(Nearness, &str)> = None;
    for name in known {
        let nearness = nearness(&typed, &folded(name));
        if let Some(nearness) = nearness
            && best.is_none_or(|(other, _)| nearness < other)
        {
            best = Some((nearness, name));
        }
    }
    best.map(|(_, name)| name)
}

/// How a name is like another, the nearest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Nearness {
    /// So many slips apart, none where only capitals differ.
    Slips(usize),
    /// What was typed is a part of the name, which is longer by so many letters.
    Part(usize),
}

/// Longer names are not compared letter by letter: the work grows with the square.
const LONGEST: usize = 200;

fn folded(name: &str) -> Vec<char> {
    name.chars().flat_map(char::to_lowercase).collect()
}

fn nearness(typed: &[char], name: &[char]) -> Option<Nearness> {
    if typed == name {
        return Some(Nearness::Slips(0));
    }
    let most = typed.len().min(name.len()) / 3;
    if typed.len().max(name.len()) <= LONGEST && typed.len().abs_diff(name.len()) <= most {
        let slips = slips(typed, name);
        if slips <= most {
            return Some(Nearness::Slips(slips));
        }
    }
    let is_part = typed.len() > 1 && name.windows(typed.len()).any(|part| part == typed);
    is_part.then(|| Nearness::Part(name.len() - typed.len()))
}

/// The fewest letters inserted, left out, replaced or swapped with their neighbour that make one word of the
/// other, none touched twice: the optimal string alignment distance (Damerau 1964; Boytsov 2011).
fn slips(a: &[char], b: &[char]) -> usize {
    let width = b.len() + 1;
    let mut two_before = vec![0; width];
    let mut before: Vec<usize> = (0..width).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; width];
        for j in 1..=b.len() {
            let other = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (before[j] + 1)
                .min(row[j - 1] + 1)
                .min(before[j - 1] + other);
            let are_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if are_swapped {
                row[j] = row[j].min(two_before[j - 2] + 1);
            }
        }
        two_before = std::mem::replace(&mut before, row);
    }
    before[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 6] = [
        "Hips",
        "lWrist",
        "rWrist",
        "lWrist_end",
        "LeftUpLeg",
        "LeftLeg",
    ];

    #[test]
    fn a_slip_finds_the_name() {
        for (typed, meant) in [
            ("lWrst", "lWrist"),
            ("rWirst", "rWrist"),
            ("LWRIST", "lWrist"),
            ("Hip", "Hips"),
            ("leftupleg", "LeftUpLeg"),
            ("LeftLg", "LeftLeg"),
            ("Wrist", "lWrist"),
            ("UpLeg", "LeftUpLeg"),
        ] {
            assert_eq!(nearest(typed, NAMES), Some(meant), "{typed}");
        }
    }

    #[test]
    fn what_is_unlike_all_finds_none() {
        for typed in ["", "x", "Tail", "Shoulder", "h"] {
            assert_eq!(nearest(typed, NAMES), None, "{typed}");
        }
        assert_eq!(nearest(&"a".repeat(5000), NAMES), None);
    }

    #[test]
    fn slips_are_counted_as_in_the_published_examples() {
        // Wikipedia, "Damerau-Levenshtein distance": CA to ABC is 3 where no letter is touched twice.
        let of = |a: &str, b: &str| slips(&folded(a), &folded(b));
        assert_eq!(of("CA", "ABC"), 3);
        assert_eq!(of("kitten", "sitting"), 3);
        assert_eq!(of("", "abc"), 3);
        assert_eq!(of("abcd", "abdc"), 1);
    }
}
