//! Curves as SVG: panels side by side on common axes. Colours come from the page's style sheet.

use std::fmt::Write;

use super::html::escaped;

/// A drawing of curves.
#[derive(Debug)]
pub(super) struct Chart {
    /// What it shows, for those who do not see it.
    pub(super) alt: String,
    /// The horizontal axis.
    pub(super) x: Axis,
    /// The vertical axis.
    pub(super) y: Axis,
    /// The panels.
    pub(super) panels: Vec<Panel>,
    /// How many panels stand side by side.
    pub(super) columns: usize,
    /// A height that is marked in every panel, with its name.
    pub(super) bound: Option<(f64, String)>,
}

/// An axis.
#[derive(Debug)]
pub(super) struct Axis {
    /// What is on it.
    pub(super) title: String,
    /// Whether it is logarithmic.
    pub(super) is_log: bool,
    /// Its ends.
    pub(super) range: [f64; 2],
    /// What is marked on it.
    pub(super) ticks: Vec<(f64, String)>,
}

/// A panel.
#[derive(Debug, Default)]
pub(super) struct Panel {
    /// Its title; empty for none.
    pub(super) title: String,
    /// What is drawn in it.
    pub(super) series: Vec<Series>,
}

/// A curve.
#[derive(Debug, Default)]
pub(super) struct Series {
    /// Its name, written at its end; empty for none.
    pub(super) name: String,
    /// Which colour and mark.
    pub(super) style: usize,
    /// Whether it is dashed.
    pub(super) is_dashed: bool,
    /// Whether its points are marked.
    pub(super) has_marks: bool,
    /// Its points.
    pub(super) points: Vec<[f64; 2]>,
    /// A band around it: x, low, high.
    pub(super) band: Vec<[f64; 3]>,
}

impl Axis {
    /// A logarithmic axis that holds all values, marked at powers of ten. Values below `floor` do not count.
    pub(super) fn powers_of_ten(
        title: &str,
        values: impl IntoIterator<Item = f64>,
        floor: f64,
    ) -> Self {
        let (mut low, mut high) = (f64::INFINITY, floor);
        for value in values.into_iter().filter(|value| value.is_finite()) {
            low = low.min(value.max(floor));
            high = high.max(value);
        }
        let low = libm::floor(libm::log10(low.min(high)) + 1e-9);
        let high = libm::ceil(libm::log10(high) - 1e-9).max(low + 1.0);
        let every = libm::ceil((high - low) / 7.0).max(1.0);
        let mut ticks = Vec::new();
        let mut power = low;
        while power <= high + 0.5 {
            ticks.push((libm::pow(10.0, power), power_of_ten(power)));
            power += every;
        }
        Self {
            title: title.to_owned(),
            is_log: true,
            range: [libm::pow(10.0, low), libm::pow(10.0, high)],
            ticks,
        }
    }

    /// A logarithmic axis that is marked at some values, from the first to the last.
    pub(super) fn log_of(title: &str, values: &[u32]) -> Self {
        let first = values.first().map_or(1.0, |&value| f64::from(value));
        let last = values.last().map_or(1.0, |&value| f64::from(value));
        Self {
            title: title.to_owned(),
            is_log: true,
            range: [first, if last > first { last } else { first * 2.0 }],
            ticks: values
                .iter()
                .map(|&value| (f64::from(value), value.to_string()))
                .collect(),
        }
    }

    /// An even axis with marks.
    pub(super) fn even(title: &str, range: [f64; 2], marks: &[(f64, &str)]) -> Self {
        Self {
            title: title.to_owned(),
            is_log: false,
            range,
            ticks: marks
                .iter()
                .map(|&(value, text)| (value, text.to_owned()))
                .collect(),
        }
    }

    /// Where a value lies between the ends: 0 to 1, and no farther.
    fn share(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let share = if self.is_log {
            libm::log10(value.max(low) / low) / libm::log10(high / low)
        } else {
            (value - low) / (high - low)
        };
        share.clamp(0.0, 1.0)
    }
}

/// `10⁻³`.
fn power_of_ten(power: f64) -> String {
    let digits = format!("{power:.0}");
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c
            .to_digit(10)
            .and_then(|digit| char::from_u32(0x2070 + digit))
            .unwrap_or(c),
    });
    format!("10{}", raised.collect::<String>())
}

/// The width of the drawing, in its own unit; it grows with the page.
const WIDTH: f64 = 960.0;
const LEFT: f64 = 58.0;
const BOTTOM: f64 = 44.0;
const TOP: f64 = 26.0;
const GAP: f64 = 22.0;
const NAMES: f64 = 84.0;

/// Where a panel lies.
#[derive(Clone, Copy)]
struct Area {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Area {
    fn at(&self, chart: &Chart, x: f64, y: f64) -> (f64, f64) {
        (
            self.x + chart.x.share(x) * self.width,
            self.y + (1.0 - chart.y.share(y)) * self.height,
        )
    }
}

/// Draws.
pub(super) fn draw(chart: &Chart) -> String {
    let columns = chart.columns.max(1);
    let rows = chart.panels.len().div_ceil(columns);
    let has_names = chart
        .panels
        .iter()
        .any(|panel| panel.series.iter().any(|series| !series.name.is_empty()));
    let right = if has_names { NAMES } else { 18.0 };
    let gap = if has_names { NAMES + 4.0 } else { GAP };
    let across = (WIDTH - LEFT - right - gap * (columns - 1) as f64) / columns as f64;
    let down = if columns == 1 {
        340.0
    } else {
        (across * 0.92).min(300.0)
    };
    let row_height = TOP + down + 20.0;
    let height = row_height * rows as f64 + BOTTOM - 14.0;
    let mut out = String::new();
    let alt = escaped(&chart.alt);
    push(
        &mut out,
        format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH:.0} {height:.0}\" role=\"img\" \
             aria-label=\"{alt}\">\n"
        ),
    );
    for (index, panel) in chart.panels.iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let area = Area {
            x: LEFT + column as f64 * (across + gap),
            y: TOP + row as f64 * row_height,
            width: across,
            height: down,
        };
        draw_axes(&mut out, chart, panel, area, column == 0);
        for series in &panel.series {
            draw_series(&mut out, chart, series, area);
        }
        draw_names(&mut out, chart, panel, area);
    }
    let (middle, foot) = (LEFT + (WIDTH - LEFT - right) / 2.0, height - 8.0);
    let title = escaped(&chart.x.title);
    push(
        &mut out,
        format_args!(
            "<text x=\"{middle:.0}\" y=\"{foot:.0}\" text-anchor=\"middle\">{title}</text>\n"
        ),
    );
    let (title, half) = (escaped(&chart.y.title), (height - BOTTOM + TOP) / 2.0);
    push(
        &mut out,
        format_args!(
            "<text transform=\"translate(12 {half:.0}) rotate(-90)\" text-anchor=\"middle\">{title}</text>\n</svg>"
        ),
    );
    out
}

fn push(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = out.write_fmt(text);
}

fn draw_axes(out: &mut String, chart: &Chart, panel: &Panel, area: Area, is_first: bool) {
    let Area {
        x,
        y,
        width,
        height,
    } = area;
    let (right, bottom) = (x + width, y + height);
    for (value, text) in &chart.y.ticks {
        let (_, at) = area.at(chart, chart.x.range[0], *value);
        push(
            out,
            format_args!(
                "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{at:.1}\" x2=\"{right:.1}\" y2=\"{at:.1}\"/>\n"
            ),
        );
        if is_first {
            let (left, text, at) = (x - 7.0, escaped(text), at + 4.0);
            push(
                out,
                format_args!(
                    "<text x=\"{left:.1}\" y=\"{at:.1}\" text-anchor=\"end\">{text}</text>\n"
                ),
            );
        }
    }
    for (value, text) in &chart.x.ticks {
        let (at, _) = area.at(chart, *value, chart.y.range[0]);
        let (foot, text) = (bottom + 15.0, escaped(text));
        push(
            out,
            format_args!(
                "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{y:.1}\" x2=\"{at:.1}\" y2=\"{bottom:.1}\"/>\
                 <text x=\"{at:.1}\" y=\"{foot:.1}\" text-anchor=\"middle\">{text}</text>\n"
            ),
        );
    }
    push(
        out,
        format_args!(
            "<rect class=\"frame\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>\n"
        ),
    );
    if let Some((bound, name)) = &chart.bound {
        let (_, at) = area.at(chart, chart.x.range[0], *bound);
        push(
            out,
            format_args!(
                "<line class=\"bound\" x1=\"{x:.1}\" y1=\"{at:.1}\" x2=\"{right:.1}\" y2=\"{at:.1}\"/>\n"
            ),
        );
        if is_first {
            let (end, over, name) = (right - 6.0, at - 5.0, escaped(name));
            push(
                out,
                format_args!(
                    "<text x=\"{end:.1}\" y=\"{over:.1}\" text-anchor=\"end\">{name}</text>\n"
                ),
            );
        }
    }
    let (over, title) = (y - 8.0, escaped(&panel.title));
    push(
        out,
        format_args!("<text class=\"title\" x=\"{x:.1}\" y=\"{over:.1}\">{title}</text>\n"),
    );
}

fn draw_series(out: &mut String, chart: &Chart, series: &Series, area: Area) {
    let style = series.style;
    if !series.band.is_empty() {
        let upper = series.band.iter().map(|&[x, _, high]| [x, high]);
        let lower = series.band.iter().rev().map(|&[x, low, _]| [x, low]);
        let points = joined(chart, area, upper.chain(lower));
        push(
            out,
            format_args!("<polygon class=\"band fill s{style}\" points=\"{points}\"/>\n"),
        );
    }
    let points = joined(chart, area, series.points.iter().copied());
    let dashed = if series.is_dashed { " dashed" } else { "" };
    push(
        out,
        format_args!("<polyline class=\"line s{style}{dashed}\" points=\"{points}\"/>\n"),
    );
    if series.has_marks {
        for &[x, y] in &series.points {
            let (x, y) = area.at(chart, x, y);
            draw_mark(out, style, x, y);
        }
    }
}

fn joined(chart: &Chart, area: Area, points: impl Iterator<Item = [f64; 2]>) -> String {
    let pairs = points.map(|[x, y]| {
        let (x, y) = area.at(chart, x, y);
        format!("{x:.1},{y:.1}")
    });
    pairs.collect::<Vec<_>>().join(" ")
}

/// A mark that tells curves apart without colour, too.
fn draw_mark(out: &mut String, style: usize, x: f64, y: f64) {
    let class = format!("class=\"fill s{style}\"");
    let path = |points: &[[f64; 2]]| {
        let points = points
            .iter()
            .map(|[dx, dy]| format!("{:.1},{:.1}", x + dx, y + dy));
        points.collect::<Vec<_>>().join(" ")
    };
    match style % 7 {
        0 => push(
            out,
            format_args!("<circle {class} cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\"/>\n"),
        ),
        1 => polygon(
            out,
            &class,
            &path(&[[-3.3, -3.3], [3.3, -3.3], [3.3, 3.3], [-3.3, 3.3]]),
        ),
        2 => polygon(out, &class, &path(&[[0.0, -4.4], [4.2, 3.2], [-4.2, 3.2]])),
        3 => polygon(out, &class, &path(&[[0.0, 4.4], [4.2, -3.2], [-4.2, -3.2]])),
        4 => polygon(
            out,
            &class,
            &path(&[[0.0, -4.8], [4.8, 0.0], [0.0, 4.8], [-4.8, 0.0]]),
        ),
        5 => polygon(
            out,
            &class,
            &path(&[[-4.6, -1.4], [4.6, -1.4], [4.6, 1.4], [-4.6, 1.4]]),
        ),
        _ => polygon(
            out,
            &class,
            &path(&[[-1.4, -4.6], [1.4, -4.6], [1.4, 4.6], [-1.4, 4.6]]),
        ),
    }
}

fn polygon(out: &mut String, class: &str, points: &str) {
    push(
        out,
        format_args!("<polygon {class} points=\"{points}\"/>\n"),
    );
}

/// Names at the ends of curves, moved apart where they would lie over each other.
fn draw_names(out: &mut String, chart: &Chart, panel: &Panel, area: Area) {
    const APART: f64 = 14.0;
    let mut names: Vec<(f64, &Series)> = panel
        .series
        .iter()
        .filter(|series| !series.name.is_empty())
        .filter_map(|series| {
            let &[x, y] = series.points.last()?;
            Some((area.at(chart, x, y).1, series))
        })
        .collect();
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    for index in 1..names.len() {
        names[index].0 = names[index].0.max(names[index - 1].0 + APART);
    }
    // What was pushed out below comes back up, and what is above makes room.
    let mut lowest = area.y + area.height + 4.0;
    for name in names.iter_mut().rev() {
        name.0 = name.0.min(lowest);
        lowest = name.0 - APART;
    }
    for (y, series) in names {
        let (x, y, style) = (area.x + area.width + 9.0, y + 4.0, series.style);
        let name = escaped(&series.name);
        push(
            out,
            format_args!(
                "<text class=\"name\" x=\"{x:.1}\" y=\"{y:.1}\" style=\"fill:var(--s{style})\">{name}</text>\n"
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_and_mark_powers_of_ten() {
        let axis = Axis::powers_of_ten("", [0.5, 3e-4, 0.0, f64::INFINITY], 1e-8);
        assert!(axis.range[0] <= 1e-8 && axis.range[1] >= 0.5);
        assert!((axis.share(axis.range[1]) - 1.0).abs() < 1e-12 && axis.share(0.0) == 0.0);
        assert_eq!(power_of_ten(-12.0), "10⁻¹²");
        let nothing = Axis::powers_of_ten("", [], 1e-8);
        assert!(nothing.range[0] < nothing.range[1]);
        assert!((Axis::log_of("", &[1, 10, 100]).share(10.0) - 0.5).abs() < 1e-12);
    }
}
