//! Which compiler builds for the web here.
//!
//! Ordinarily `rustup target add wasm32-unknown-unknown`. Debian ships no such target but a second
//! compiler with the sources of the standard library, which is then built along.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The target of web pages.
pub const TARGET: &str = "wasm32-unknown-unknown";

const NOTHING_FOUND: &str = "no compiler for wasm32-unknown-unknown was found
  with rustup:  rustup target add wasm32-unknown-unknown
  on Debian:    apt-get install rustc-web rust-web-src lld-19";

/// A compiler that builds for the web.
#[derive(Debug)]
pub enum Toolchain {
    /// The one cargo uses anyway has the target.
    Ordinary,
    /// Debian's, with the standard library's sources.
    Debian {
        /// The linker.
        linker: PathBuf,
    },
}

/// Which compiler is wished for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// The ordinary one where it has the target, or else Debian's.
    Any,
    /// The ordinary one.
    Ordinary,
    /// Debian's.
    Debian,
}

impl Toolchain {
    /// Finds out what there is.
    pub fn find(wish: Wish) -> Result<Self, String> {
        if wish != Wish::Debian && ordinary_has_target() {
            return Ok(Self::Ordinary);
        }
        let debian = debian().filter(|_| wish != Wish::Ordinary);
        debian.ok_or_else(|| NOTHING_FOUND.to_owned())
    }

    /// In one line, for people.
    pub fn describe(&self) -> String {
        match self {
            Self::Ordinary => format!("the installed target {TARGET}"),
            Self::Debian { linker } => {
                format!(
                    "Debian's /usr/bin/rustc, building std, linking with {}",
                    linker.display()
                )
            }
        }
    }

    /// Makes a cargo command build with it.
    pub fn apply(&self, cargo: &mut Command) {
        // Four lanes at a time: every browser that draws at all has had them for years.
        cargo.env(
            "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS",
            "-Ctarget-feature=+simd128",
        );
        if let Self::Debian { linker } = self {
            cargo
                .env("RUSTC", "/usr/bin/rustc")
                // Building std is a feature of nightly compilers; this one has just the sources.
                .env("RUSTC_BOOTSTRAP", "1")
                .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker)
                .arg("-Zbuild-std=std,panic_abort");
        }
    }
}

fn debian() -> Option<Toolchain> {
    let has_sources = Path::new("/usr/lib/rustlib/src/rust/library/std/Cargo.toml").is_file();
    let has_compiler = Path::new("/usr/bin/rustc").is_file();
    let linker = newest_linker().filter(|_| has_sources && has_compiler)?;
    Some(Toolchain::Debian { linker })
}

fn ordinary_has_target() -> bool {
    let sysroot = Command::new("rustc").args(["--print", "sysroot"]).output();
    sysroot.is_ok_and(|output| {
        let root = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        Path::new(&root)
            .join("lib/rustlib")
            .join(TARGET)
            .join("lib")
            .is_dir()
    })
}

/// `wasm-ld` without a version, or the newest of those with one.
fn newest_linker() -> Option<PathBuf> {
    let plain = PathBuf::from("/usr/bin/wasm-ld");
    if plain.exists() {
        return Some(plain);
    }
    let versioned = (14..40)
        .rev()
        .map(|version| PathBuf::from(format!("/usr/bin/wasm-ld-{version}")));
    versioned.into_iter().find(|linker| linker.exists())
}
