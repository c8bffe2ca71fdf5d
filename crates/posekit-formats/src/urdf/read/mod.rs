//! The reader: elements, then links and joints, then the tree that they must make.

mod joint;
mod link;
mod tree;
mod value;
mod xml;

use std::collections::HashMap;

use super::{Urdf, UrdfJoint, UrdfLink};
use crate::report::{Import, ReadError, ReadErrorKind, Reporter, WarningCode, quote};
use link::Materials;
use tree::Places;
use value::required;
use xml::{Document, Element};

/// How deep elements may be nested. The format itself needs six levels.
pub const MAX_DEPTH: usize = 64;

/// How many elements a file may have: a hundred times those of a large humanoid robot.
pub const MAX_ELEMENTS: usize = 400_000;

/// How many attributes an element may have. The format itself has five at most.
pub const MAX_ATTRIBUTES: usize = 64;

/// Reads a URDF file from its bytes, which are UTF-8.
///
/// # Errors
///
/// When the bytes make no sense as URDF, with the place, what was expected and what was found. Anything
/// that still makes sense is read, and noted in the report.
pub fn read(bytes: &[u8]) -> Result<Import<Urdf>, ReadError> {
    let mut reporter = Reporter::new(bytes);
    let text = text(bytes, &mut reporter)?;
    let elements = Document::read(text, &mut reporter)?;
    let document = read_robot(elements.root(), &mut reporter)?;
    Ok(Import {
        document,
        report: reporter.finish(),
    })
}

/// The bytes as text; refuses what is not text at all before XML gives a puzzling message about it.
fn text<'a>(bytes: &'a [u8], reporter: &mut Reporter<'_>) -> Result<&'a str, ReadError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        let found = "nothing but blanks";
        return Err(reporter.error(ReadErrorKind::Empty, 0, "an element `<robot>`", found));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let found = "UTF-16 text";
        return Err(reporter.error(ReadErrorKind::NotText, 0, "UTF-8 text", found));
    }
    if let Some(at) = memchr::memchr(0, bytes) {
        let found = "a NUL byte: the file is binary";
        return Err(reporter.error(ReadErrorKind::NotText, at, "text", found));
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        reporter.warn(WarningCode::ByteOrderMark, 0, || {
            "a UTF-8 byte order mark, which was skipped".into()
        });
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let found = "a byte that is not";
        reporter.error(ReadErrorKind::NotText, at, "UTF-8 text", found)
    })
}

fn read_robot(robot: Element<'_, '_>, reporter: &mut Reporter<'_>) -> Result<Urdf, ReadError> {
    if robot.name() != "robot" {
        let found = quote(robot.name().as_bytes());
        return Err(reporter.unexpected(robot.at(), "an element `<robot>`", found));
    }
    if let Some(macro_element) = robot
        .children()
        .find(|child| child.name().starts_with("xacro:"))
    {
        let name = quote(macro_element.name().as_bytes());
        let found = format!("{name}, a xacro macro: run xacro first");
        return Err(reporter.unexpected(macro_element.at(), "plain URDF", found));
    }
    let name = robot.attribute("name", reporter)?;
    let materials = Materials::read(robot, reporter)?;
    let mut places = Places {
        links: Vec::new(),
        joints: Vec::new(),
    };
    let mut links: Vec<UrdfLink> = Vec::new();
    let mut link_names = Names::of("link");
    for element in robot.children().filter(|child| child.name() == "link") {
        let link = link::read(element, &materials, reporter)?;
        link_names.insert(&link.name, element, reporter)?;
        links.push(link);
        places.links.push(element.at());
    }
    if links.is_empty() {
        let found = "a robot without links";
        return Err(reporter.unexpected(robot.at(), "an element `<link>`", found));
    }
    let (mut joints, joint_places) = read_joints(robot, &link_names, reporter)?;
    places.joints = joint_places;
    tree::free_circling_mimics(&mut joints, &places, reporter);
    let root = tree::root(&links, &joints, &places, reporter)?;
    Ok(Urdf {
        name: name.map(|(name, _)| name.into_owned()).unwrap_or_default(),
        links,
        joints,
        root,
    })
}

/// The joints and where they begin.
fn read_joints(
    robot: Element<'_, '_>,
    link_names: &Names,
    reporter: &mut Reporter<'_>,
) -> Result<(Vec<UrdfJoint>, Vec<usize>), ReadError> {
    // A `<joint>` of a transmission or an extension has other parents and is not seen here.
    let elements: Vec<Element<'_, '_>> = robot
        .children()
        .filter(|child| child.name() == "joint")
        .collect();
    let mut joints: Vec<UrdfJoint> = Vec::new();
    let mut names = Names::of("joint");
    for &element in &elements {
        let joint = joint::read(element, link_names, reporter)?;
        names.insert(&joint.name, element, reporter)?;
        joints.push(joint);
    }
    for (index, &element) in elements.iter().enumerate() {
        let mimic = joint::read_mimic(element, &joints[index], &joints, &names, reporter);
        joints[index].mimic = mimic;
    }
    let places = elements.iter().map(|element| element.at()).collect();
    Ok((joints, places))
}

/// Names that tell links or joints apart, with their indices.
struct Names {
    what: &'static str,
    indices: HashMap<String, usize>,
}

impl Names {
    fn of(what: &'static str) -> Self {
        Self {
            what,
            indices: HashMap::new(),
        }
    }

    fn get(&self, name: &str) -> Option<usize> {
        self.indices.get(name).copied()
    }

    /// Takes the next name; refuses one that was there before.
    fn insert(
        &mut self,
        name: &str,
        element: Element<'_, '_>,
        reporter: &mut Reporter<'_>,
    ) -> Result<(), ReadError> {
        let index = self.indices.len();
        if self.indices.insert(name.to_owned(), index).is_some() {
            let at = required(element, "name", reporter)?.1;
            let expected = format!("a name that no other {} has", self.what);
            let found = format!("{} again", quote(name.as_bytes()));
            return Err(reporter.error(ReadErrorKind::DuplicateName, at, expected, found));
        }
        Ok(())
    }
}
