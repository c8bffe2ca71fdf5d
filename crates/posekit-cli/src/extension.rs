//! What a file is called against what is written into it.

use std::ffi::OsStr;
use std::path::Path;

use crate::failure::Failure;
use crate::inputs::STDIN;

/// Refuses an output whose name says that something else is in it than what will be: an extension that is none
/// of `known`, the longest of which may have dots in them. `told` says how to have it so anyway.
///
/// A folder, standard output and a name without an extension promise nothing.
pub(crate) fn refuse_other(output: &OsStr, known: &[&str], told: &str) -> Result<(), Failure> {
    let path = Path::new(output);
    let is_folder = path.is_dir() || output.as_encoded_bytes().ends_with(b"/");
    if output == STDIN || is_folder {
        return Ok(());
    }
    let Some(extension) = path.extension() else {
        return Ok(());
    };
    let name = output.to_string_lossy().to_lowercase();
    let fits = |known: &&str| name.ends_with(&format!(".{known}"));
    if extension == "{ext}" || known.iter().any(fits) {
        return Ok(());
    }
    let extension = extension.to_string_lossy();
    let names: Vec<String> = known.iter().map(|known| format!(".{known}")).collect();
    Err(
        Failure::usage(format!("this command does not write .{extension} files"))
            .try_next(format!("name it {}, or {told}", names.join(" or "))),
    )
}

/// How to have an odd name where no option says so.
pub(crate) const REDIRECT: &str = "write to '-' and redirect that";

#[cfg(test)]
mod tests {
    use super::*;

    fn is_refused(output: &str, known: &[&str]) -> bool {
        refuse_other(OsStr::new(output), known, REDIRECT).is_err()
    }

    #[test]
    fn a_name_that_promises_something_else_is_refused() {
        for output in ["y.txt", "a/b.csv", "walk.v2", "x/{stem}.npz", "bvh.fbx"] {
            assert!(is_refused(output, &["bvh"]), "{output}");
        }
        for output in [
            "y.bvh",
            "y.BVH",
            "-",
            "out/",
            "out",
            "x/{stem}.{ext}",
            "{stem}",
        ] {
            assert!(!is_refused(output, &["bvh"]), "{output}");
        }
        assert!(is_refused("walk.toml", &["posekit.toml"]));
        assert!(!is_refused("walk.posekit.toml", &["bvh", "posekit.toml"]));
    }
}
