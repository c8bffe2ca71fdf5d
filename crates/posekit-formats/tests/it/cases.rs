//! The small inputs that failed for users once, in `shared/cases` beside the workspace.

use std::fs;
use std::path::Path;

/// The bytes of one of them; nothing, with a word, where there is no such folder.
pub(crate) fn bytes(name: &str) -> Option<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    if !folder.is_dir() {
        eprintln!("{} is missing: skipped", folder.display());
        return None;
    }
    Some(fs::read(folder.join(name)).unwrap())
}
