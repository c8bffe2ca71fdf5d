//! The curves of the report: the mean angle of all joints over the frames, one line for each method.

use std::fmt::Write;

use super::compare::Comparison;
use super::html::escaped;
use crate::text::trimmed;

/// The picture's size; the page scales it.
const SIZE: (f64, f64) = (1000.0, 360.0);
/// Left, top, right and bottom of the curves.
const BOX: (f64, f64, f64, f64) = (56.0, 12.0, 990.0, 300.0);
/// Colours that people who mix up red and green tell apart (Okabe and Ito 2008).
const COLORS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999",
];
/// Lines on the scale, about.
const LINES: f64 = 5.0;

/// An SVG element.
pub(super) fn over_time(comparison: &Comparison) -> String {
    let (left, top, right, bottom) = BOX;
    let last = comparison.frame_count.saturating_sub(1).max(1) as f64;
    let most = comparison
        .methods
        .iter()
        .flat_map(|(_, error)| error.by_frame_deg.iter().copied())
        .fold(0.0, f64::max);
    let step = round_step(most / LINES);
    let high = (most / step).ceil().max(1.0) * step;
    let x = |frame: usize| left + (right - left) * frame as f64 / last;
    let y = |deg: f64| bottom - (bottom - top) * deg / high;
    let mut svg = format!(
        "<figure><svg viewBox=\"0 0 {} {}\" role=\"img\" \
         aria-label=\"mean angle to the truth over the frames, a line for each method\">\n",
        SIZE.0, SIZE.1
    );
    let mut deg = 0.0;
    while deg <= high + 0.5 * step {
        let at = y(deg);
        // Writing to a string does not fail.
        let _ = writeln!(
            svg,
            "<path d=\"M{left} {at:.1}H{right}\" stroke=\"currentColor\" stroke-opacity=\".15\"/>\
             <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{}&deg;</text>",
            left - 6.0,
            at + 4.0,
            trimmed(deg, 3)
        );
        deg += step;
    }
    for (number, (_, error)) in comparison.methods.iter().enumerate() {
        let path = path(comparison, &error.by_frame_deg, &x, &y);
        let color = COLORS[number % COLORS.len()];
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.6\"/>"
        );
    }
    for (number, (method, _)) in comparison.methods.iter().enumerate() {
        let at = left + 110.0 * number as f64;
        let color = COLORS[number % COLORS.len()];
        let _ = writeln!(
            svg,
            "<path d=\"M{at:.0} 338h22\" stroke=\"{color}\" stroke-width=\"3\"/>\
             <text x=\"{:.0}\" y=\"342\">{}</text>",
            at + 28.0,
            escaped(&method.to_string())
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"318\">frame 0</text>\
         <text x=\"{right}\" y=\"318\" text-anchor=\"end\">{}</text>",
        comparison.frame_count.saturating_sub(1)
    );
    svg.push_str("</svg><figcaption>Mean angle of all joints to the truth; 0 at the kept frames.</figcaption></figure>\n");
    svg
}

/// The errors of the filled-in frames, and 0 at the kept ones between them.
fn path(
    comparison: &Comparison,
    by_frame_deg: &[f64],
    x: &impl Fn(usize) -> f64,
    y: &impl Fn(f64) -> f64,
) -> String {
    let kept = comparison.kept.iter().map(|&frame| (frame, 0.0));
    let filled = comparison
        .filled
        .iter()
        .copied()
        .zip(by_frame_deg.iter().copied());
    let mut points: Vec<(usize, f64)> = kept.chain(filled).collect();
    points.sort_by_key(|(frame, _)| *frame);
    let mut path = String::new();
    for (index, (frame, deg)) in points.into_iter().enumerate() {
        let word = if index == 0 { 'M' } else { 'L' };
        let _ = write!(path, "{word}{:.1} {:.1}", x(frame), y(deg));
    }
    path
}

/// The next of 1, 2, 5, 10, ... at or over a length.
fn round_step(least: f64) -> f64 {
    if !(least > 0.0 && least.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|factor| factor * power >= least * 0.999);
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_round_steps() {
        for (least, step) in [(0.3, 0.5), (1.0, 1.0), (1.1, 2.0), (7.0, 10.0), (0.0, 1.0)] {
            assert!((round_step(least) - step).abs() < 1e-12, "{least}");
        }
    }
}
