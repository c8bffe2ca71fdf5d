//! The list of all keys: made from the tables that keys are looked for in, so that none is missing.

use super::{Binding, Command, Group, Place, is_mac};
use crate::gizmo::Tool;

/// A line of the list: all keys of a command in one place, and what it does there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The keys, as they are shown.
    pub keys: Vec<String>,
    /// What they do.
    pub says: &'static str,
    /// Where the line stands.
    pub group: Group,
    /// What they ask for; `None` for keys that only mean something while they are held beside something.
    pub command: Option<Command>,
}

/// Keys that are in no table: they are about what is held, open or typed into just then.
const HELD: [(&[&str], Group, &str); 14] = [
    (
        &["X", "Y", "Z"],
        Group::Edit,
        "While something is in hand: along or about this axis alone, or freely again",
    ),
    (
        &["Enter"],
        Group::Edit,
        "While something is in hand: keep it there",
    ),
    (
        &["Esc"],
        Group::Edit,
        "While a handle is held: let it go without effect",
    ),
    (
        &["Esc"],
        Group::Edit,
        "Select nothing; end the solver's steps",
    ),
    (
        &["Esc"],
        Group::Edit,
        "While a pose is blended in: give it up",
    ),
    (
        &["Esc"],
        Group::Window,
        "Close what is open; clear a filter",
    ),
    (&["Enter"], Group::Window, "In a window: its first button"),
    (
        &["Esc"],
        Group::Timeline,
        "While keys follow the pointer: give it up",
    ),
    (
        &["Enter"],
        Group::Timeline,
        "While keys follow the pointer: keep them there",
    ),
    (
        &["X", "Y"],
        Group::Timeline,
        "While keys follow the pointer in the graph: in time, in value alone",
    ),
    (&["Tab"], Group::Chooser, "Complete the name"),
    (&["Up", "Down"], Group::Chooser, "Go through the list"),
    (&["Alt+Up"], Group::Chooser, "The folder above"),
    (
        &["Ctrl+Space"],
        Group::Chooser,
        "One more file, or one less",
    ),
];

/// What commands do in the labs, where that is something else.
const IN_LABS: [(Command, Group, &str); 15] = [
    (
        Command::Tool(Tool::Move),
        Group::ArmLab,
        "Bring the tip to a place",
    ),
    (
        Command::Tool(Tool::Turn),
        Group::ArmLab,
        "Bring it there turned in a certain way",
    ),
    (
        Command::NextSpace,
        Group::ArmLab,
        "The gizmo's axes: the world's, the tip's",
    ),
    (
        Command::Solve,
        Group::ArmLab,
        "Another way to the same place",
    ),
    (Command::Deselect, Group::ArmLab, "Forget the target"),
    (
        Command::ResetPose,
        Group::ArmLab,
        "All joints to their home",
    ),
    (Command::ToggleAxes, Group::ArmLab, "Frames of the joints"),
    (Command::ToggleLabels, Group::ArmLab, "Names of the joints"),
    (
        Command::NextFrame,
        Group::InterpolationLab,
        "A hundredth of the way on",
    ),
    (
        Command::PreviousFrame,
        Group::InterpolationLab,
        "A hundredth of the way back",
    ),
    (
        Command::TenFramesOn,
        Group::InterpolationLab,
        "A tenth of the way on",
    ),
    (
        Command::TenFramesBack,
        Group::InterpolationLab,
        "A tenth of the way back",
    ),
    (
        Command::NextSpace,
        Group::InterpolationLab,
        "The rings' axes: the world's, the body's",
    ),
    (
        Command::ToggleCompare,
        Group::InterpolationLab,
        "Side by side, overlaid, on a sphere",
    ),
    (
        Command::ToggleCurves,
        Group::InterpolationLab,
        "The curves, or more room for the view",
    ),
];

/// All lines, group by group.
#[must_use]
pub fn lines() -> Vec<Line> {
    let mut lines = Vec::new();
    for group in Group::ALL {
        for binding in all().filter(|binding| binding.group == group) {
            let says = said(binding);
            let is_there = |line: &Line| line.group == group && line.says == says;
            if !lines.iter().any(is_there) {
                let keys = keys_of(binding.command, |other| other.group == group);
                let command = Some(binding.command);
                lines.push(Line {
                    keys,
                    says,
                    group,
                    command,
                });
            }
        }
        for (command, _, says) in IN_LABS.iter().filter(|line| line.1 == group) {
            let keys = keys_of(*command, |binding| !binding.group.is_of_animation());
            if !keys.is_empty() {
                let command = Some(*command);
                lines.push(Line {
                    keys,
                    says,
                    group,
                    command,
                });
            }
        }
        for (keys, _, says) in HELD.iter().filter(|line| line.1 == group) {
            let keys = keys.iter().map(|key| (*key).to_owned()).collect();
            let command = None;
            lines.push(Line {
                keys,
                says,
                group,
                command,
            });
        }
    }
    lines
}

/// Every key that is looked for anywhere, once.
fn all() -> impl Iterator<Item = &'static Binding> {
    let mut seen: Vec<&'static Binding> = Vec::new();
    for binding in Place::ALL.into_iter().flat_map(Place::bindings) {
        if !seen.iter().any(|other| std::ptr::eq(*other, binding)) {
            seen.push(binding);
        }
    }
    seen.into_iter()
}

/// What a key does: a second key of a command does what its first does.
fn said(binding: &'static Binding) -> &'static str {
    let same = |other: &&Binding| other.command == binding.command && other.group == binding.group;
    let mut alike = all().filter(same).map(|other| other.says);
    let first = alike.find(|says| !says.is_empty());
    if binding.says.is_empty() {
        first.unwrap_or_default()
    } else {
        binding.says
    }
}

fn keys_of(command: Command, is_meant: impl Fn(&Binding) -> bool) -> Vec<String> {
    let meant = all().filter(|binding| binding.command == command && is_meant(binding));
    let mut keys: Vec<String> = Vec::new();
    for key in meant.map(|binding| binding.shortcut_text(is_mac())) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// Words of the list, and what other programs call the same.
const ALSO_CALLED: [(&str, &str); 9] = [
    ("turn", "rotate rotation"),
    ("move", "grab translate"),
    ("nearer", "zoom in closer"),
    ("farther", "zoom out"),
    ("delete", "remove"),
    ("curves", "graph plot"),
    ("into view", "frame focus zoom to fit"),
    ("frame everything", "focus zoom to fit view all"),
    ("key", "keyframe"),
];

/// The lines that a search finds: by a key, as `g` or `ctrl+s`, or by words of what it does, here or in other programs.
#[must_use]
pub fn found(lines: &[Line], search: &str) -> Vec<Line> {
    let search = search.trim().to_lowercase();
    let of_key = |line: &Line| {
        let mut keys = line.keys.iter().map(|key| key.to_lowercase());
        keys.any(|key| {
            let last = match key.strip_suffix('+') {
                Some(_) => "+",
                None => key.rsplit('+').next().unwrap_or_default(),
            };
            key == search || last == search
        })
    };
    let of_words = |line: &Line| {
        let mut text = format!(
            "{} {} {}",
            line.says,
            line.group.title(),
            line.keys.join(" ")
        )
        .to_lowercase();
        for (ours, theirs) in ALSO_CALLED {
            if text.contains(ours) {
                text.push(' ');
                text.push_str(theirs);
            }
        }
        crate::state::library::matches(&search, &text)
    };
    let (by_key, rest): (Vec<&Line>, Vec<&Line>) = lines.iter().partition(|line| of_key(line));
    // One letter is in nearly every line: it is a key that is meant.
    let is_one = search.chars().count() == 1;
    if is_one && !by_key.is_empty() {
        return by_key.into_iter().cloned().collect();
    }
    let by_words = rest.into_iter().filter(|line| of_words(line));
    by_key.into_iter().chain(by_words).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_every_place_is_in_the_list() {
        let lines = lines();
        for place in Place::ALL {
            for binding in place.bindings() {
                let key = binding.shortcut_text(is_mac());
                let listed = lines
                    .iter()
                    .find(|line| line.group == binding.group && line.keys.contains(&key));
                let line = listed.unwrap_or_else(|| panic!("{key}: {:?}", binding.command));
                assert!(!line.says.is_empty(), "{key}");
            }
        }
        for (command, _, says) in IN_LABS {
            let is_bound = all().any(|binding| binding.command == command);
            assert!(is_bound, "{says}: no key asks for {command:?}");
        }
    }

    /// Keys that are looked for outside the tables are those of `HELD`: what the sources name is listed.
    #[test]
    fn keys_outside_the_tables_are_in_the_list_too() {
        let sources = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut folders = vec![sources];
        let mut named = std::collections::BTreeSet::new();
        while let Some(folder) = folders.pop() {
            for item in std::fs::read_dir(folder).expect("the sources").flatten() {
                let path = item.path();
                if path.is_dir() {
                    if !path.ends_with("command") {
                        folders.push(path);
                    }
                } else {
                    let text = std::fs::read_to_string(&path).expect("a source");
                    for rest in text.split("Key::").skip(1) {
                        let name: String =
                            rest.chars().take_while(|c| c.is_alphanumeric()).collect();
                        named.insert(name);
                    }
                }
            }
        }
        let listed: Vec<&str> = HELD.iter().flat_map(|line| line.0).copied().collect();
        for name in named {
            let shown = match name.as_str() {
                "Escape" => "Esc",
                "ArrowUp" => "Up",
                "ArrowDown" => "Down",
                // The list itself is closed by the key that opens it.
                "F1" => continue,
                name => name,
            };
            let is_listed = listed
                .iter()
                .any(|key| *key == shown || key.ends_with(&format!("+{shown}")));
            assert!(is_listed, "{name} is looked for, and not in the list");
        }
    }

    #[test]
    fn lines_are_found_by_key_and_by_words() {
        let lines = lines();
        let says = |search: &str| -> Vec<&'static str> {
            found(&lines, search).iter().map(|line| line.says).collect()
        };
        assert!(says("ctrl+s").contains(&"Save the range as BVH"));
        assert!(says("CTRL+S").contains(&"Save the scene"));
        assert!(says("range starts").contains(&"Range starts here"));
        assert!(says("timeline delete").contains(&"Delete"));
        for (word, ours) in [
            ("rotate", "Turn"),
            ("grab", "Move"),
            ("zoom", "Nearer"),
            ("keyframe", "Select all keys"),
        ] {
            let found = says(word);
            assert!(
                found.iter().any(|line| line.contains(ours)),
                "{word}: {found:?}"
            );
        }
        // Ctrl+O and Shift+Ctrl+O, too.
        let o = found(&lines, "o");
        assert!(
            o.iter()
                .all(|line| line.keys.iter().any(|key| key.ends_with('O')))
        );
        assert!(o.len() >= 3);
        assert_eq!(says("").len(), lines.len());
        assert!(says("no such thing").is_empty());
        assert!(says("+").contains(&"Nearer"));
        assert!(says("page").contains(&"IK: one step back"));
    }
}
