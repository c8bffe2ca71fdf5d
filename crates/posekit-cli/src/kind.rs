//! What a file is that is not what a command takes, so that the message can say it.

use crate::failure::Failure;

/// A kind of file that posekit knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Bvh,
    Urdf,
    Gltf,
    Scene,
}

/// How much of a file is looked at.
const BEGINNING: usize = 4096;

fn of(bytes: &[u8]) -> Option<Kind> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = text.trim_ascii_start();
    let beginning = String::from_utf8_lossy(&text[..text.len().min(BEGINNING)]);
    let starts_with = |word: &[u8]| {
        let start = text.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    };
    let is_scene = |line: &str| {
        let pair = line.split_once('=');
        pair.is_some_and(|(key, value)| {
            key.trim() == "format" && value.trim().trim_matches('"') == "posekit scene"
        })
    };
    Some(match () {
        () if starts_with(b"HIERARCHY") => Kind::Bvh,
        () if bytes.starts_with(b"glTF") => Kind::Gltf,
        () if starts_with(b"<") && beginning.contains("<robot") => Kind::Urdf,
        () if starts_with(b"{") && beginning.contains("\"asset\"") => Kind::Gltf,
        () if beginning.lines().any(is_scene) => Kind::Scene,
        () => return None,
    })
}

/// What is to be said of a file that could not be read as motion, where its kind is known.
pub(crate) fn not_a_motion(name: &str, bytes: &[u8]) -> Option<Failure> {
    let (what, next) = match of(bytes)? {
        Kind::Bvh => return None,
        Kind::Urdf => (
            "is a robot (URDF), not a motion",
            "posekit info, check and view take robots",
        ),
        Kind::Gltf => (
            "is glTF, which this command does not take as it is",
            "name it in a scene file as skeleton and motion: docs/keyframes.md says how",
        ),
        Kind::Scene => (
            "is a scene, and its name does not say so",
            "save it as NAME.posekit.toml",
        ),
    };
    Some(Failure::new(format!("{name}: {what}")).try_next(next))
}

/// What is to be said of a file that could not be read as a scene, where its kind is known.
pub(crate) fn not_a_scene(name: &str, bytes: &[u8]) -> Option<Failure> {
    let what = match of(bytes)? {
        Kind::Scene => return None,
        Kind::Bvh => "a motion (BVH)",
        Kind::Urdf => "a robot (URDF)",
        Kind::Gltf => "glTF",
    };
    let failure = Failure::new(format!("{name}: is {what}, not a scene"));
    Some(match of(bytes)? {
        Kind::Bvh => failure.try_next("posekit keys reduce makes a scene of a motion"),
        _ => failure,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_by_what_files_begin_with() {
        for (bytes, kind) in [
            (&b"HIERARCHY\nROOT a"[..], Some(Kind::Bvh)),
            (b"\xef\xbb\xbf hierarchy", Some(Kind::Bvh)),
            (b"glTF\x02\0\0\0", Some(Kind::Gltf)),
            (b"{ \"asset\": { \"version\": \"2.0\" } }", Some(Kind::Gltf)),
            (b"{ \"a\": 1 }", None),
            (
                b"<?xml version='1.0'?>\n<robot name='a'/>",
                Some(Kind::Urdf),
            ),
            (b"<html></html>", None),
            (b"# mine\nformat = \"posekit scene\"\n", Some(Kind::Scene)),
            (b"format = \"posekit poses\"\n", None),
            (b"", None),
        ] {
            assert_eq!(of(bytes), kind, "{:?}", String::from_utf8_lossy(bytes));
        }
    }
}
