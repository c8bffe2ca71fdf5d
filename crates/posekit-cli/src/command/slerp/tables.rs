//! What the methods do over the way, as tables.

use std::io::Write;

use posekit::inbetween::{Ends, Method, PathStep, path};
use posekit::rotation::angle_between;
use posekit_formats::ways;

use crate::console::{self, HEADING, styled};
use crate::failure::Failure;
use crate::text::{Align, Table, fixed};

/// A number of each step.
type Column = fn(&PathStep) -> f64;

/// A table: its title, its decimals, which methods it has, and what of them.
type Part = (&'static str, usize, fn(&Method) -> bool, Column);

/// Prints one table for each thing there is to see.
pub(super) fn print(ends: &Ends, methods: &[Method], steps: usize) -> Result<(), Failure> {
    let mut out = console::stdout();
    let angle = angle_between(ends.start, ends.end).to_degrees();
    let [start, end] = [ends.start, ends.end].map(|q| {
        let parts: Vec<String> = q.to_array().iter().map(|part| fixed(*part, 4)).collect();
        parts.join(", ")
    });
    writeln!(
        out,
        "from {start} to {end} (x, y, z, w): {} degrees",
        fixed(angle, 2)
    )?;
    let paths: Vec<(Method, Vec<PathStep>)> = methods
        .iter()
        .map(|&method| (method, path(method, ends, steps)))
        .collect();
    let all = |_: &Method| true;
    let unlike = |method: &Method| !matches!(method, Method::Slerp);
    let no_rotation = |method: &Method| matches!(method, Method::Matrix | Method::RawLerp);
    let parts: [Part; 4] = [
        ("How far from slerp, in degrees", 2, unlike, |step| {
            step.deviation_deg
        }),
        (
            "How fast it turns, in degrees for the whole way",
            1,
            all,
            |step| step.speed_deg,
        ),
        ("Determinant: 1 for a rotation", 4, no_rotation, |step| {
            step.blend.determinant()
        }),
        (
            "Shear: how far axes are from right angles, in degrees",
            2,
            no_rotation,
            |step| step.blend.shear_deg(),
        ),
    ];
    for (title, decimals, shows, value) in parts {
        let shown: Vec<_> = paths.iter().filter(|(method, _)| shows(method)).collect();
        if shown.is_empty() {
            continue;
        }
        writeln!(out, "\n{}", styled(HEADING, title))?;
        let names: Vec<String> = shown.iter().map(|(method, _)| method.to_string()).collect();
        let mut columns = vec![("t", Align::Right)];
        columns.extend(names.iter().map(|name| (name.as_str(), Align::Right)));
        let mut table = Table::new(&columns);
        for step in 0..=steps {
            let cells = shown
                .iter()
                .map(|(_, path)| fixed(value(&path[step]), decimals));
            let t = fixed(shown[0].1[step].t, 2);
            table.row(std::iter::once(t).chain(cells).collect());
        }
        // What sinks is told by its least, what grows by its most.
        let (word, pick): (&str, fn(f64, f64) -> f64) = if title.starts_with("Determinant") {
            ("least", f64::min)
        } else {
            ("most", f64::max)
        };
        let extreme = shown.iter().map(|(_, path)| {
            let extreme = path.iter().map(value).reduce(pick);
            fixed(extreme.unwrap_or(f64::NAN), decimals)
        });
        table.row(std::iter::once(word.to_owned()).chain(extreme).collect());
        table.write(&mut out)?;
    }
    Ok(out.flush()?)
}

/// One row for each method and step.
pub(super) fn csv(ends: &Ends, methods: &[Method], steps: usize) -> Result<(), Failure> {
    let mut out = console::binary_stdout();
    write!(out, "{}", ways::csv(ends, methods, steps))?;
    Ok(out.flush()?)
}
