//! Robots of our own, as files: to try things on without looking for a file first.
//!
//! Their dimensions come from published tables, which each file cites; their shapes are simple.

/// The files by name, and what each is.
const FILES: [(&str, &str, &str); 3] = [
    (
        "planar2",
        "a planar two-link arm",
        include_str!("planar2.urdf"),
    ),
    (
        "arm6",
        "a six-axis arm, the dimensions of a PUMA 560",
        include_str!("arm6.urdf"),
    ),
    (
        "arm7",
        "a seven-axis arm, the dimensions of an LBR iiwa 14",
        include_str!("arm7.urdf"),
    ),
];

/// The names that [`by_name`] knows, each with what it is.
pub fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.iter().map(|&(name, what, _)| (name, what))
}

/// The text of the robot's URDF file: `planar2`, `arm6` or `arm7`.
///
/// ```
/// use posekit_formats::urdf::{self, UpAxis};
///
/// let text = urdf::sample::by_name("arm6").unwrap();
/// let arm = urdf::read(text.as_bytes())?.document.to_robot(UpAxis::Y)?;
/// assert_eq!(arm.value_count(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn by_name(name: &str) -> Option<&'static str> {
    let found = FILES.iter().find(|&&(known, _, _)| known == name);
    found.map(|&(_, _, text)| text)
}
