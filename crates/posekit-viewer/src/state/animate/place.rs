//! Paths of a scene: relative to its folder in its file, those of this machine while it is open.
//!
//! They are compared as text, links not followed. On a page files have no place: names stay as they are.

use std::path::{Component, Path, PathBuf};

use posekit_formats::scene::{SAMPLE_PREFIX, Scene, SkeletonSource};

/// The scene with files named by where they are, as `folder` has it: the folder of its file.
#[must_use]
pub fn opened(scene: &Scene, folder: &Path) -> Scene {
    renamed(scene, |name| {
        let path = normal(&folder.join(name));
        path.to_str().map_or_else(|| name.to_owned(), str::to_owned)
    })
}

/// The scene as its file in a folder says it.
#[must_use]
pub fn written(scene: &Scene, folder: &Path) -> Scene {
    let folder = absolute(folder);
    renamed(scene, |name| {
        let path = Path::new(name);
        if path.is_relative() {
            return name.to_owned();
        }
        relative(&normal(path), &folder).unwrap_or_else(|| name.to_owned())
    })
}

/// A path from the root of the file system, without `.` and `..`.
#[must_use]
pub fn absolute(path: &Path) -> PathBuf {
    #[cfg(not(target_arch = "wasm32"))]
    let path = &std::path::absolute(path).unwrap_or_else(|_no_folder| path.to_owned());
    normal(path)
}

/// What of a scene names a file, named otherwise.
fn renamed(scene: &Scene, name: impl Fn(&str) -> String) -> Scene {
    let mut scene = scene.clone();
    let change = |file: &mut String| {
        if !file.starts_with(SAMPLE_PREFIX) {
            *file = name(file);
        }
    };
    if let SkeletonSource::File(file) = &mut scene.skeleton {
        change(file);
    }
    for layer in &mut scene.motions {
        change(&mut layer.file);
    }
    for prop in &mut scene.props {
        if !is_simple_shape(&prop.shape) {
            change(&mut prop.shape);
        }
    }
    scene
}

/// Whether a prop's shape is one that needs no file.
#[must_use]
pub fn is_simple_shape(shape: &str) -> bool {
    matches!(shape, "box" | "sphere")
}

/// A path without `.` and `..`, as text.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if out.file_name().is_some() => {
                out.pop();
            }
            // Above the root there is nothing.
            Component::ParentDir if out.has_root() => {}
            part => out.push(part),
        }
    }
    out
}

/// A path as seen from a folder, with `/` between its parts; `None` from one disk to another.
fn relative(path: &Path, folder: &Path) -> Option<String> {
    let (path, folder): (Vec<_>, Vec<_>) =
        (path.components().collect(), folder.components().collect());
    let shared = path.iter().zip(&folder).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return None;
    }
    let up = folder[shared..].iter().map(|_| Some(".."));
    let down = path[shared..].iter().map(|part| part.as_os_str().to_str());
    let parts: Option<Vec<&str>> = up.chain(down).collect();
    parts.map(|parts| parts.join("/"))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn paths_go_out_relative_and_come_back() {
        let folder = Path::new("/home/me/takes");
        for name in [
            "walk.bvh",
            "takes/walk.bvh",
            "../walk.bvh",
            "../../../data/w.bvh",
            "sample:walk",
        ] {
            let scene = Scene::new(SkeletonSource::File(name.to_owned()));
            let open = opened(&scene, folder);
            assert_eq!(written(&open, folder), scene, "{name}");
        }
        let open = opened(
            &Scene::new(SkeletonSource::File("a/../b.bvh".into())),
            folder,
        );
        assert_eq!(
            open.skeleton,
            SkeletonSource::File("/home/me/takes/b.bvh".into())
        );
        let elsewhere = written(&open, Path::new("/home/me/other"));
        assert_eq!(
            elsewhere.skeleton,
            SkeletonSource::File("../takes/b.bvh".into())
        );
    }
}
