//! The page over a wire: every file also packed by brotli, which hosts send as it lies there.

use std::fs;
use std::path::Path;

use brotli::enc::BrotliEncoderParams;

/// A file of the page.
#[derive(Debug)]
pub struct Size {
    /// Its name.
    pub name: String,
    /// Its size.
    pub bytes: usize,
    /// Its size as it travels.
    pub packed: usize,
}

/// Takes away what was packed before. Hosts prefer it: while the new files are packed, which takes a while, a browser
/// would get one build's module with another's glue.
pub fn unpack(folder: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)?.flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|ending| ending == "br") {
            fs::remove_file(path).map_err(failed)?;
        }
    }
    Ok(())
}

/// Writes `FILE.br` beside every file of a folder that gets smaller by it.
pub fn pack(folder: &Path) -> Result<Vec<Size>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut names: Vec<String> = fs::read_dir(folder)
        .map_err(failed)?
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| !name.ends_with(".br"))
        .collect();
    names.sort();
    let pack_one = |name: String| {
        let bytes = fs::read(folder.join(&name)).map_err(failed)?;
        let packed = packed(&bytes)?;
        let beside = folder.join(format!("{name}.br"));
        let size = Size {
            name,
            bytes: bytes.len(),
            packed: packed.len().min(bytes.len()),
        };
        if packed.len() < bytes.len() {
            fs::write(beside, packed).map_err(failed)?;
        } else if beside.exists() {
            fs::remove_file(beside).map_err(failed)?;
        }
        Ok(size)
    };
    names.into_iter().map(pack_one).collect()
}

fn packed(bytes: &[u8]) -> Result<Vec<u8>, String> {
    // The best that every browser unpacks.
    let parameters = BrotliEncoderParams {
        quality: 11,
        lgwin: 24,
        ..BrotliEncoderParams::default()
    };
    let mut packed = Vec::new();
    brotli::BrotliCompress(&mut &*bytes, &mut packed, &parameters)
        .map_err(|error| format!("brotli: {error}"))?;
    Ok(packed)
}
