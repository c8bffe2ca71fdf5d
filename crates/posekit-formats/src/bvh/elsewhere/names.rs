//! Names that programs stumble over, and names in their place.

use std::collections::BTreeSet;

use crate::bvh::document::implied_end_name;
use crate::bvh::{Bvh, EndName, MAX_NAME_BYTES};

/// Blender's bones hold 63 bytes of a name.
pub(super) const LONGEST_IN_BLENDER: usize = 63;

/// What three.js takes for an object inside the bone when a name ends in it (`PropertyBinding.js`,
/// `_supportedObjectNames`).
const OBJECTS_IN_THREE: [&[u8]; 4] = [b".material", b".materials", b".bones", b".map"];

pub(super) fn has_blank(name: &[u8]) -> bool {
    name.iter().any(u8::is_ascii_whitespace)
}

/// A name up to its first blank.
pub(super) fn first_word(name: &[u8]) -> &[u8] {
    name.split(u8::is_ascii_whitespace).next().unwrap_or(name)
}

/// Whether three.js looks for the bone of this name in a folder, or for something in it.
pub(super) fn is_path_in_three(name: &[u8]) -> bool {
    let word = first_word(name);
    word.iter().any(|byte| b":/".contains(byte))
        || OBJECTS_IN_THREE.iter().any(|object| word.ends_with(object))
}

pub(super) fn has_bracket(name: &[u8]) -> bool {
    name.iter().any(|byte| b"[]".contains(byte))
}

/// Gives every joint that is no End Site a name that programs take: UTF-8, blanks as underscores, told apart;
/// for three.js also without the characters that its own `PropertyBinding.sanitizeNodeName` removes. Says what
/// was renamed, as pairs of old and new names.
pub(super) fn make_plain(bvh: &mut Bvh, is_for_three: bool) -> Vec<(String, String)> {
    let mut taken = BTreeSet::new();
    let mut renamed = Vec::new();
    let mut is_renamed = vec![false; bvh.joints.len()];
    for (joint, is_renamed) in bvh.joints.iter_mut().zip(&mut is_renamed) {
        if joint.is_end_site {
            continue;
        }
        let name = told_apart(plain(&joint.name, is_for_three), &taken);
        taken.insert(name.clone());
        if name.as_bytes() != joint.name {
            renamed.push((joint.name().into_owned(), name.clone()));
            joint.name = name.into_bytes();
            *is_renamed = true;
        }
    }
    for index in 0..bvh.joints.len() {
        let parent = bvh.joints[index].parent;
        if let Some(parent) = parent.filter(|&parent| is_renamed[parent])
            && bvh.joints[index].is_end_site
            && bvh.joints[index].end_name == EndName::Implied
        {
            bvh.joints[index].name = implied_end_name(&bvh.joints[parent].name);
        }
    }
    renamed
}

fn plain(name: &[u8], is_for_three: bool) -> String {
    let text = String::from_utf8_lossy(name);
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let mut plain = words.join("_").replace(char::REPLACEMENT_CHARACTER, "_");
    if is_for_three {
        plain.retain(|letter| !"[]:/".contains(letter));
        if is_path_in_three(plain.as_bytes()) {
            plain = plain.replace('.', "");
        }
    }
    if plain.is_empty() {
        "joint".to_owned()
    } else {
        plain
    }
}

/// The name, or with `.001` and so on after it.
fn told_apart(name: String, taken: &BTreeSet<String>) -> String {
    if !taken.contains(&name) {
        return name;
    }
    let mut stem = name.as_str();
    while stem.len() + 8 > MAX_NAME_BYTES {
        let mut letters = stem.chars();
        letters.next_back();
        stem = letters.as_str();
    }
    let mut number = 0_usize;
    loop {
        number += 1;
        let candidate = format!("{stem}.{number:03}");
        if !taken.contains(&candidate) {
            return candidate;
        }
    }
}
