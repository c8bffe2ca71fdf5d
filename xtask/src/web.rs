//! The web page: the viewer as WebAssembly, its glue, and the page that starts it.

use std::fs;
use std::path::Path;
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

use crate::toolchain::{TARGET, Toolchain, Wish};
use crate::wire;

/// Where this build keeps its objects: they share nothing with those of other builds.
const OBJECTS: &str = "target/web";

/// The files that lie ready.
const PAGE: &str = "crates/posekit-viewer/web";

/// The module, as the page asks for it.
const MODULE: &str = "posekit_viewer_bg.wasm";

/// More than this is too much to wait for.
const MOST_WIRE_BYTES: usize = 3_000_000;

/// Builds the page into a folder.
pub fn build(out: &Path, wish: Wish) -> Result<(), String> {
    if !Path::new(PAGE).is_dir() {
        return Err("run this from the root of the repository".to_owned());
    }
    let toolchain = Toolchain::find(wish)?;
    eprintln!("building the page with {}", toolchain.describe());
    compile(&toolchain)?;
    let built = Path::new(OBJECTS)
        .join(TARGET)
        .join("web/posekit_viewer.wasm");
    fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    wire::unpack(out)?;
    Bindgen::new()
        .input_path(&built)
        .web(true)
        .and_then(|bindgen| {
            bindgen
                .typescript(false)
                .remove_name_section(true)
                .remove_producers_section(true)
                .generate(out)
        })
        .map_err(|error| format!("wasm-bindgen: {error:#}"))?;
    let module = read(&out.join(MODULE))?;
    copy_page(out, &module)?;
    let sizes = wire::pack(out)?;
    for file in &sizes {
        println!(
            "{:>10} bytes, {:>9} by brotli  {}",
            file.bytes, file.packed, file.name
        );
    }
    let whole: usize = sizes.iter().map(|file| file.packed).sum();
    println!("{:>10} {whole:>16} by brotli  in all", "");
    println!(
        "serve it with: posekit serve FOLDER --page {}",
        out.display()
    );
    println!(
        "or with any web server, such as: python3 -m http.server -d {}",
        out.display()
    );
    if whole > MOST_WIRE_BYTES {
        return Err(format!(
            "the page is larger than {MOST_WIRE_BYTES} bytes by brotli"
        ));
    }
    Ok(())
}

fn compile(toolchain: &Toolchain) -> Result<(), String> {
    let mut cargo = Command::new("cargo");
    cargo
        .args([
            "build",
            "--profile",
            "web",
            "--package",
            "posekit-viewer",
            "--lib",
            "--locked",
        ])
        .args([
            "--no-default-features",
            "--target",
            TARGET,
            "--target-dir",
            OBJECTS,
        ]);
    toolchain.apply(&mut cargo);
    let status = cargo
        .status()
        .map_err(|error| format!("cargo could not be started: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err("the viewer did not build".to_owned())
    }
}

/// Copies the page's own files. Where they name the module they get its size and a mark of this build,
/// so that a browser never runs one build's glue with another's module.
fn copy_page(out: &Path, module: &[u8]) -> Result<(), String> {
    let version = format!("{:016x}", fingerprint(module));
    let listing = fs::read_dir(PAGE).map_err(|error| format!("{PAGE}: {error}"))?;
    for file in listing.flatten() {
        let to = out.join(file.file_name());
        let text = fs::read_to_string(file.path())
            .map_err(|error| format!("{}: {error}", file.path().display()))?
            .replace("__VERSION__", &version)
            .replace("__MODULE_BYTES__", &module.len().to_string());
        fs::write(&to, text).map_err(|error| format!("{}: {error}", to.display()))?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// FNV-1a, 64 bits: tells builds apart, protects from nobody.
fn fingerprint(bytes: &[u8]) -> u64 {
    let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}
