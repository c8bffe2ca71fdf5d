//! What tells names apart: where each of many goes a way of its own.

/// As many branches of a name are kept: those that tell it from the names most like it.
const MOST: usize = 16;

/// For each name the bytes at which some other name goes on otherwise, in rising order: of `run_left_01` beside
/// `run_left_02` and `run_right_01`, where `left` begins and the last digit. Names that are equal tell nothing
/// of each other.
///
/// Sorted, the names most alike are neighbours, and two names part where the least alike of the neighbours from
/// one to the other do; so one walk in each direction is enough.
#[must_use]
pub fn branches(names: &[&str]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|index| names[*index]);
    let mut found = vec![Vec::new(); names.len()];
    walk(names, order.iter().copied(), &mut found);
    walk(names, order.iter().rev().copied(), &mut found);
    for branches in &mut found {
        branches.sort_unstable();
        branches.dedup();
        let spare = branches.len().saturating_sub(MOST);
        branches.drain(..spare);
    }
    found
}

fn walk(names: &[&str], order: impl Iterator<Item = usize>, found: &mut [Vec<usize>]) {
    // Where the name at hand parts from those before it: the nearest last.
    let mut parts: Vec<usize> = Vec::new();
    let mut before: Option<&str> = None;
    for index in order {
        let name = names[index];
        if let Some(before) = before.filter(|before| *before != name) {
            let alike = alike(before, name);
            while parts.last().is_some_and(|part| *part > alike) {
                parts.pop();
            }
            if parts.last() != Some(&alike) {
                parts.push(alike);
            }
        }
        let spare = parts.len().saturating_sub(MOST);
        found[index].extend_from_slice(&parts[spare..]);
        before = Some(name);
    }
}

/// How many bytes two names have in common at their beginning.
fn alike(a: &str, b: &str) -> usize {
    let pairs = a.char_indices().zip(b.chars());
    let last = pairs.take_while(|((_, a), b)| a == b).last();
    last.map_or(0, |((at, char), _)| at + char.len_utf8())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pair compared.
    fn plain(names: &[&str]) -> Vec<Vec<usize>> {
        let of = |name: &str| {
            let others = names.iter().filter(|other| **other != name);
            let mut parts: Vec<usize> = others.map(|other| alike(name, other)).collect();
            parts.sort_unstable();
            parts.dedup();
            parts
        };
        names.iter().map(|name| of(name)).collect()
    }

    #[test]
    fn a_name_branches_wherever_another_goes_on_otherwise() {
        let names = [
            "run_left_01",
            "run_left_02",
            "run_right_01",
            "walk",
            "walk",
            "walk_2",
            "\u{e9}t\u{e9}",
            "\u{e9}t\u{e8}",
        ];
        assert_eq!(branches(&names), plain(&names));
        assert_eq!(branches(&names)[0], [0, 4, 10]);
        assert_eq!(branches(&["one"]), [Vec::<usize>::new()]);
        assert_eq!(branches(&[]), Vec::<Vec<usize>>::new());
    }

    #[test]
    fn of_many_branches_the_deepest_are_kept() {
        let names: Vec<String> = (0..40).map(|length| "a".repeat(length)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let found = branches(&names);
        assert_eq!(found[39], (23..39).collect::<Vec<_>>());
    }
}
