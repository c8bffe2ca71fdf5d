use crate::harness::Folder;

#[test]
fn every_command_has_help_with_examples() {
    let folder = Folder::with_arm();
    for command in [
        "info",
        "check",
        "fix",
        "fk",
        "ik-study",
        "convert",
        "render",
        #[cfg(feature = "window")]
        "view",
        "serve",
        "sample",
        "completions",
        "man",
    ] {
        let help = folder.succeed(&[command, "--help"]);
        assert!(
            help.contains("Examples:") && help.contains("posekit "),
            "{command}: {help}"
        );
    }
    assert!(folder.succeed(&["--help"]).contains("Exit codes"));
    folder.fail(2, &["fly"]);
}

#[test]
fn shells_can_complete() {
    let folder = Folder::with_arm();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = folder.succeed(&["completions", shell]);
        assert!(
            script.contains("convert") && script.contains("positions"),
            "{shell}"
        );
    }
}

#[test]
fn there_is_a_page_for_every_command() {
    let folder = Folder::with_arm();
    assert!(folder.succeed(&["man"]).contains(".TH posekit 1"));
    folder.succeed(&["man", "--out-dir", "man1"]);
    for name in ["posekit", "posekit-fk", "posekit-info", "posekit-convert"] {
        let page = folder.read(&format!("man1/{name}.1"));
        assert!(page.contains(&format!(".TH {name} 1")), "{name}: {page}");
    }
}
