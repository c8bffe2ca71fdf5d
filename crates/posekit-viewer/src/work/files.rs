//! Files that go out: what is written, and how.

use std::sync::Arc;

use posekit_formats::bvh::{self, Bvh};
use posekit_render::image::Image;

use crate::state::clip::Clip;

/// A file to be written: its bytes, and what it is.
#[derive(Clone, Debug)]
pub struct Parcel {
    /// The name proposed.
    pub name: String,
    /// What kind of file it is, for the dialog.
    pub kind: &'static str,
    /// How its name ends, without the dot.
    pub extension: &'static str,
    /// The bytes.
    pub bytes: Arc<[u8]>,
}

/// The document of a stretch of a clip: what the file said, to the digit, and fewer frames.
#[must_use]
pub fn range_document(clip: &Clip, (first, last): (usize, usize)) -> Bvh {
    let mut document = (*clip.document).clone();
    let channel_count = document.channel_count();
    if let Some(motion) = &mut document.motion
        && motion.frame_count > 0
    {
        let last = last.min(motion.frame_count - 1);
        let first = first.min(last);
        motion.values = motion.values[first * channel_count..(last + 1) * channel_count].to_vec();
        motion.frame_count = last - first + 1;
    }
    document
}

/// The range as a BVH file.
///
/// # Errors
/// If the document cannot be written, for people.
pub fn range_parcel(clip: &Clip, range: (usize, usize)) -> Result<Parcel, String> {
    let document = range_document(clip, range);
    document.validate().map_err(|problem| problem.to_string())?;
    let last = clip.frame_count().saturating_sub(1);
    // The time line may be longer: that of another clip beside this one.
    let range = (range.0.min(last), range.1.min(last));
    let whole = range == (0, last);
    let stem = stem_of(&clip.name);
    let name = if whole {
        format!("{stem}.bvh")
    } else {
        format!("{stem}_{}-{}.bvh", range.0, range.1)
    };
    let bytes = bvh::write(&document).into();
    Ok(Parcel {
        name,
        kind: "BVH motion",
        extension: "bvh",
        bytes,
    })
}

/// The picture as a PNG file.
///
/// # Errors
/// If it cannot be encoded, for people.
pub fn picture_parcel(image: &Image, clip_name: &str, frame: usize) -> Result<Parcel, String> {
    let mut bytes = Vec::new();
    posekit_render::output::write_png(image, &mut bytes).map_err(|error| error.to_string())?;
    let name = format!("{}_{frame}.png", stem_of(clip_name));
    Ok(Parcel {
        name,
        kind: "PNG picture",
        extension: "png",
        bytes: bytes.into(),
    })
}

/// How the names of what can be opened end: a video of `shot.posekit.toml` is `shot.mp4`.
const ENDINGS: [&str; 5] = [".posekit.toml", ".bvh", ".urdf", ".glb", ".gltf"];

/// A clip's name without its extension, fit for a file name.
#[must_use]
pub fn stem_of(name: &str) -> String {
    let stem = ENDINGS
        .iter()
        .find_map(|ending| {
            let cut = name.len().checked_sub(ending.len())?;
            let has_it = name.get(cut..)?.eq_ignore_ascii_case(ending);
            has_it.then(|| &name[..cut])
        })
        .unwrap_or(name);
    let fit = |c: char| {
        if c.is_alphanumeric() || "-_.+".contains(c) {
            c
        } else {
            '_'
        }
    };
    let stem: String = stem.chars().map(fit).collect();
    if stem.is_empty() {
        "clip".to_owned()
    } else {
        stem
    }
}

/// Writes a file beside its place and renames it into it: a failure leaves the old one whole. A link stays one, and what
/// it leads to is written; a file that is write-protected is not replaced, though its folder would allow that.
///
/// # Errors
/// Those of the file system, and of `write`.
#[cfg(not(target_arch = "wasm32"))]
pub fn write_beside<E: From<std::io::Error>>(
    path: &std::path::Path,
    write: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<(), E>,
) -> Result<(), E> {
    let real = std::fs::canonicalize(path);
    let path = real.as_deref().unwrap_or(path);
    if crate::state::chooser::is_write_protected(path) {
        let kind = std::io::ErrorKind::PermissionDenied;
        return Err(std::io::Error::new(kind, "it is write-protected").into());
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let beside = path.with_file_name(name);
    let outcome = std::fs::File::create(&beside)
        .map_err(E::from)
        .and_then(|file| {
            let mut file = std::io::BufWriter::new(file);
            write(&mut file)?;
            std::io::Write::flush(&mut file).map_err(E::from)
        });
    let outcome = outcome.and_then(|()| std::fs::rename(&beside, path).map_err(E::from));
    if outcome.is_err() {
        // What is left of it is of no use; that it cannot be removed either is no news.
        drop(std::fs::remove_file(&beside));
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proposed_name_has_no_ending_of_the_file_that_it_comes_from() {
        for (name, stem) in [
            ("walk.bvh", "walk"),
            ("WALK.BVH", "WALK"),
            ("shot.posekit.toml", "shot"),
            ("arm.urdf", "arm"),
            ("knight.glb", "knight"),
            ("a.b.bvh", "a.b"),
            (".bvh", "clip"),
            ("\u{e9}", "\u{e9}"),
            ("a/b c", "a_b_c"),
        ] {
            assert_eq!(stem_of(name), stem);
        }
    }

    #[test]
    fn what_is_write_protected_stays_and_links_lead_on() {
        let folder = std::env::temp_dir().join(format!("posekit-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let put = |path: &std::path::Path| -> std::io::Result<()> {
            write_beside(path, |file| std::io::Write::write_all(file, b"new"))
        };
        let path = folder.join("a.bvh");
        std::fs::write(&path, "old").expect("written");
        let mut permissions = std::fs::metadata(&path).expect("there").permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).expect("protected");
        let error = put(&path).expect_err("refused");
        assert_eq!(error.to_string(), "it is write-protected");
        assert_eq!(std::fs::read(&path).expect("there"), b"old");
        let names = std::fs::read_dir(&folder).expect("listed").count();
        assert_eq!(names, 1, "nothing is left beside it");
        #[cfg(unix)]
        {
            let (real, link) = (folder.join("real"), folder.join("link"));
            std::fs::write(&real, "old").expect("written");
            std::os::unix::fs::symlink("real", &link).expect("linked");
            put(&link).expect("written");
            assert!(
                std::fs::symlink_metadata(&link)
                    .expect("there")
                    .is_symlink()
            );
            assert_eq!(std::fs::read(&real).expect("there"), b"new");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
