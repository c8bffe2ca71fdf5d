//! Build tasks: `cargo xtask web` makes the web page.

mod toolchain;
mod web;
mod wire;

use std::path::PathBuf;
use std::process::ExitCode;

use toolchain::Wish;

const USAGE: &str = "usage: cargo xtask web [--out FOLDER] [--with ordinary|debian]

  web   build the viewer as a web page: a folder of static files that any host can serve
        (default: target/page), with the compiler that is there: the ordinary one, if it
        has the target, or Debian's";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if matches!(arguments.first().map(String::as_str), Some("--help" | "-h")) {
        println!("{USAGE}");
        return ExitCode::SUCCESS;
    }
    let Some((out, wish)) = read_arguments(&arguments) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    match web::build(&out, wish) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

fn read_arguments(arguments: &[String]) -> Option<(PathBuf, Wish)> {
    let mut words = arguments.iter().map(String::as_str);
    if words.next() != Some("web") {
        return None;
    }
    let (mut out, mut wish) = (PathBuf::from("target/page"), Wish::Any);
    while let Some(word) = words.next() {
        match (word, words.next()?) {
            ("--out", folder) => out = folder.into(),
            ("--with", "ordinary") => wish = Wish::Ordinary,
            ("--with", "debian") => wish = Wish::Debian,
            _ => return None,
        }
    }
    Some((out, wish))
}
