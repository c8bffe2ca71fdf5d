//! What the URDF reader refuses, with which kind of error, and where it says it is.

use crate::bvh_text::place;
use posekit_formats::report::{ReadError, ReadErrorKind};
use posekit_formats::urdf::{self, MAX_ATTRIBUTES, MAX_DEPTH};

fn refused(text: &str) -> ReadError {
    match urdf::read(text.as_bytes()) {
        Err(error) => error,
        Ok(_) => panic!("this was read: {text}"),
    }
}

/// The error, which must be of this kind and begin like this.
fn check(text: &str, kind: ReadErrorKind, message: &str) {
    let error = refused(text);
    assert_eq!(error.kind, kind, "{error}");
    assert_eq!(error.to_string(), message);
}

const TWO_LINKS: &str = "<link name='a'/>\n<link name='b'/>\n";

fn joint(name: &str, parent: &str, child: &str, inside: &str) -> String {
    format!(
        "<joint name='{name}' type='continuous'><parent link='{parent}'/>\
         <child link='{child}'/>{inside}</joint>\n"
    )
}

fn robot(body: &str) -> String {
    format!("<robot>\n{body}</robot>")
}

#[test]
fn what_is_no_urdf_at_all() {
    use ReadErrorKind::{Empty, NotText, Unexpected};
    check(
        "",
        Empty,
        "line 1, column 1: expected an element `<robot>`, found nothing but blanks",
    );
    check(
        " \n ",
        Empty,
        "line 1, column 1: expected an element `<robot>`, found nothing but blanks",
    );
    check(
        "a\0",
        NotText,
        "line 1, column 2: expected text, found a NUL byte: the file is binary",
    );
    assert_eq!(urdf::read(b"\xff\xfe<\0").unwrap_err().kind, NotText);
    assert_eq!(
        urdf::read(b"<robot name='\xff'/>").unwrap_err().kind,
        NotText
    );
    check(
        "hello",
        Unexpected,
        "line 1, column 1: expected an element `<robot>`, found `hello`",
    );
    check(
        "<!-- -->",
        Unexpected,
        "line 1, column 9: expected an element `<robot>`, found no element at all",
    );
    check(
        "<sdf/>",
        Unexpected,
        "line 1, column 1: expected an element `<robot>`, found `sdf`",
    );
    check(
        "\n <robot/>",
        Unexpected,
        "line 2, column 2: expected an element `<link>`, found a robot without links",
    );
    check(
        "<robot><link name='a'/></robot><robot/>",
        Unexpected,
        "line 1, column 32: expected one outermost element, found `robot`",
    );
}

#[test]
fn broken_xml() {
    use ReadErrorKind::{UnclosedBrace, Unexpected};
    check(
        "<robot>\n<link name='a'>",
        UnclosedBrace,
        "line 2, column 1: expected `</link>`, found the end of the file, with 2 elements open",
    );
    for text in [
        "<robot>\n</link></robot>",
        "<robot>\n<link name='a'",
        "<robot>\n<link name=a/></robot>",
        "<robot>\n<link name='a' name='b'/></robot>",
        "<robot>\n<link name='&bomb;'/></robot>",
        "<robot>\n<link name='a'/><!-- </robot>",
    ] {
        let error = refused(text);
        assert_eq!(
            (error.kind, place(&error).0),
            (Unexpected, 2),
            "{text}: {error}"
        );
    }
    let entities = "<!DOCTYPE r [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;'>]><robot name='&b;'/>";
    check(
        entities,
        Unexpected,
        "line 1, column 1: expected a URDF file without a document type, found `<!DOCTYPE`",
    );
}

#[test]
fn limits() {
    let deep = format!("<robot>{}", "<a>".repeat(MAX_DEPTH));
    assert_eq!(refused(&deep).kind, ReadErrorKind::LimitExceeded);
    let attributes: String = (0..=MAX_ATTRIBUTES).map(|i| format!(" a{i}=''")).collect();
    let wide = format!("<robot{attributes}/>");
    assert_eq!(refused(&wide).kind, ReadErrorKind::LimitExceeded);
    let many = robot(&"<a/>".repeat(urdf::MAX_ELEMENTS));
    assert_eq!(refused(&many).kind, ReadErrorKind::LimitExceeded);
}

#[test]
fn names_that_are_missing_or_twice() {
    use ReadErrorKind::{DuplicateName, Unexpected, UnknownName};
    check(
        &robot("<link/>"),
        Unexpected,
        "line 2, column 1: expected an attribute `name`, found `link` without it",
    );
    check(
        &robot("<link name=' '/>"),
        Unexpected,
        "line 2, column 13: expected a value of `name`, found nothing",
    );
    check(
        &robot("<link name='a'/>\n<link name='a'/>"),
        DuplicateName,
        "line 3, column 13: expected a name that no other link has, found `a` again",
    );
    let twice = joint("j", "a", "b", "") + &joint("j", "a", "b", "");
    check(
        &robot(&format!("{TWO_LINKS}{twice}")),
        DuplicateName,
        "line 5, column 14: expected a name that no other joint has, found `j` again",
    );
    check(
        &robot(&format!("{TWO_LINKS}{}", joint("j", "a", "x", ""))),
        UnknownName,
        "line 4, column 66: expected a link of this file, found `x`, which is no link of it",
    );
    check(
        &robot(&format!(
            "{TWO_LINKS}<joint name='j' type='fixed'>\n<parent link='a'/></joint>"
        )),
        Unexpected,
        "line 4, column 1: expected an element `<child>`, found `joint` without it",
    );
}

#[test]
fn numbers_that_are_none() {
    use ReadErrorKind::{NotFinite, Unexpected};
    let with = |inside: &str| {
        robot(&format!(
            "{TWO_LINKS}{}",
            joint("j", "a", "b", &format!("\n{inside}"))
        ))
    };
    let cases = [
        (
            "<origin xyz='1 2'/>",
            Unexpected,
            "14: expected 3 numbers in `xyz`, found `1 2`",
        ),
        (
            "<origin xyz='1 2 3 4'/>",
            Unexpected,
            "14: expected 3 numbers in `xyz`, found `1 2 3 4`",
        ),
        (
            "<origin rpy='0 x 0'/>",
            Unexpected,
            "14: expected a number in `rpy`, found `x`",
        ),
        (
            "<origin xyz='0 nan 0'/>",
            NotFinite,
            "14: expected a finite number in `xyz`, found `nan`",
        ),
        (
            "<origin xyz='0 1e999 0'/>",
            NotFinite,
            "14: expected a finite number in `xyz`, found `1e999`",
        ),
        (
            "<limit upper='${pi}'/>",
            Unexpected,
            "15: expected a number in `upper`, found `${pi}`, a xacro macro: run xacro first",
        ),
        (
            "<axis xyz='0 0 0'/>",
            Unexpected,
            "1: expected an axis with a direction, found one without a length",
        ),
    ];
    for (inside, kind, rest) in cases {
        check(
            &with(inside).replace("continuous", "revolute"),
            kind,
            &format!("line 5, column {rest}"),
        );
    }
    check(
        &robot(
            "<link name='a'><visual><geometry>\n<sphere radius='-1'/></geometry></visual></link>",
        ),
        Unexpected,
        "line 3, column 17: expected a `radius` that is not negative, found `-1`",
    );
    check(
        &robot("<xacro:macro name='m'/><link name='a'/>"),
        Unexpected,
        "line 2, column 1: expected plain URDF, found `xacro:macro`, a xacro macro: run xacro first",
    );
}

#[test]
fn joints_of_no_kind() {
    use ReadErrorKind::Unexpected;
    let text =
        robot(&format!("{TWO_LINKS}{}", joint("j", "a", "b", ""))).replace("continuous", "ball");
    check(
        &text,
        Unexpected,
        "line 4, column 23: expected revolute, continuous, prismatic, fixed, floating or planar, found `ball`",
    );
}

#[test]
fn joints_that_make_no_tree() {
    use ReadErrorKind::NotATree;
    check(
        &robot(TWO_LINKS),
        NotATree,
        "line 3, column 1: expected one root link, which no joint carries, found `b` beside `a`",
    );
    check(
        &robot(&format!(
            "{TWO_LINKS}{}{}",
            joint("j", "a", "b", ""),
            joint("k", "a", "b", "")
        )),
        NotATree,
        "line 5, column 1: expected one joint to carry link `b`, found `k` beside `j`",
    );
    let loops = [joint("j", "a", "b", ""), joint("k", "b", "a", "")].concat();
    check(
        &robot(&format!("{TWO_LINKS}{loops}")),
        NotATree,
        "line 4, column 1: expected joints that make a tree, found joint `j`, which carries the link that it is mounted on",
    );
    check(
        &robot(&format!("{TWO_LINKS}<link name='root'/>\n{loops}")),
        NotATree,
        "line 5, column 1: expected joints that make a tree, found joint `j`, which carries the link that it is mounted on",
    );
    check(
        &robot(&format!("<link name='a'/>\n{}", joint("j", "a", "a", ""))),
        NotATree,
        "line 3, column 1: expected joints that make a tree, found joint `j`, which carries the link that it is mounted on",
    );
}

#[test]
fn numbers_beyond_single_precision_make_no_robot() {
    let text = robot(&format!(
        "{TWO_LINKS}{}",
        joint("j", "a", "b", "<origin xyz='1e60 0 0'/>")
    ));
    let document = urdf::read(text.as_bytes()).unwrap().document;
    assert!(document.to_robot(urdf::UpAxis::Y).is_err());
}
