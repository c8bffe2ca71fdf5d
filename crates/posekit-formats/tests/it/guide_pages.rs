//! Every code that a check can report has a page in the guide, and every page has a code.

use std::collections::BTreeSet;
use std::path::Path;

use posekit::check::FindingCode;
use posekit_formats::report::WarningCode;

#[test]
fn every_code_has_a_page_and_every_page_a_code() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/check");
    let findings = FindingCode::ALL.iter().map(|code| code.code());
    let warnings = WarningCode::ALL.iter().map(|code| code.code());
    let codes: BTreeSet<String> = findings.chain(warnings).map(str::to_owned).collect();
    assert_eq!(
        codes.len(),
        FindingCode::ALL.len() + WarningCode::ALL.len(),
        "codes are unique"
    );
    let pages: BTreeSet<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .filter(|name| name != "README")
        .collect();
    assert_eq!(codes, pages);
    let index = std::fs::read_to_string(folder.join("README.md")).unwrap();
    for code in &codes {
        let page = std::fs::read_to_string(folder.join(format!("{code}.md"))).unwrap();
        assert!(page.contains(&format!("Code `{code}`")), "{code}");
        for part in [
            "What it means",
            "How it is measured",
            "What to do",
            "Example",
        ] {
            assert!(
                page.contains(&format!("## {part}")),
                "{code} has no `{part}`"
            );
        }
        assert!(
            index.contains(&format!("[{code}]({code}.md)")),
            "{code} is not in the index"
        );
    }
}
