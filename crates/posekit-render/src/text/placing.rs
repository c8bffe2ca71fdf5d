//! Where labels stand: beside their points, off each other, joined to them by a line when they had to
//! move away.

use crate::color::Color;

use super::{TextBitmap, byte, round, signed};

/// A label that wants a place.
#[derive(Debug)]
pub(super) struct Unplaced {
    pub(super) bitmap: TextBitmap,
    /// The labelled point in the picture, pixels.
    pub(super) at: (f32, f32),
    pub(super) color: Color,
}

/// Up to this many labels each is shown wherever it lands; in a crowd the later ones give way.
const FEW: usize = 8;

/// Distances of a label's edge from its point, for a picture of the reference height.
const DISTANCES: [f32; 5] = [8.0, 22.0, 44.0, 72.0, 104.0];
/// Lines up and down.
const LINES: [f32; 7] = [0.0, -1.0, 1.0, -2.0, 2.0, -3.0, 3.0];

/// Costs of a place: for every step away from the point, for the side towards the figure's middle,
/// for every other point that it hides.
const STEP_COST: f32 = 9.0;
const LINE_COST: f32 = 5.0;
const INWARD_COST: f32 = 14.0;
const POINT_COST: f32 = 22.0;
/// For any part outside the picture or over another text.
const BLOCKED_COST: f32 = 1e6;

/// Adds labels, the first ones first, and the lines to them.
pub(super) fn place(
    labels: Vec<Unplaced>,
    (width, height): (u32, u32),
    scale: f32,
    bitmaps: &mut Vec<TextBitmap>,
) {
    let points: Vec<(f32, f32)> = labels.iter().map(|label| label.at).collect();
    let middle = points.iter().map(|p| p.0).sum::<f32>() / points.len().max(1) as f32;
    let is_crowd = labels.len() > FEW;
    let first_label = bitmaps.len();
    let mut leaders = Vec::new();
    for mut label in labels {
        let size = (label.bitmap.width as f32, label.bitmap.height as f32);
        let cost = |(x, y): (f32, f32), own: f32| {
            let inside =
                x >= 0.0 && y >= 0.0 && x + size.0 <= width as f32 && y + size.1 <= height as f32;
            let hidden = points
                .iter()
                .filter(|p| p.0 > x && p.0 < x + size.0 && p.1 > y && p.1 < y + size.1)
                .count();
            let covered: f32 = bitmaps
                .iter()
                .map(|other| overlap((x, y), size, other))
                .sum();
            let blocked = if covered > 0.0 || !inside {
                BLOCKED_COST + covered
            } else {
                0.0
            };
            own + POINT_COST * hidden as f32 + blocked
        };
        let best = candidates(label.at, size, middle, scale)
            .map(|(place, own)| (place, cost(place, own)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, _)) = best.filter(|best| !is_crowd || best.1 < BLOCKED_COST) else {
            continue;
        };
        label.bitmap.x = round(place.0);
        label.bitmap.y = round(place.1);
        leaders.extend(leader(&label, scale));
        bitmaps.push(label.bitmap);
    }
    // Lines go under the labels.
    bitmaps.splice(first_label..first_label, leaders);
}

/// Places for a label of a size at a point, with their costs.
fn candidates(
    at: (f32, f32),
    size: (f32, f32),
    middle: f32,
    scale: f32,
) -> impl Iterator<Item = ((f32, f32), f32)> {
    let outward = if at.0 >= middle { 1.0 } else { -1.0 };
    let steps = DISTANCES.into_iter().enumerate();
    let spots = steps.flat_map(|(step, distance)| {
        let lines = LINES.into_iter().map(move |line| (step, distance, line));
        lines.filter(|&(step, _, line)| line.abs() <= 1.0 + step as f32)
    });
    spots.flat_map(move |(step, distance, line)| {
        [(outward, 0.0), (-outward, INWARD_COST)].map(|(side, inward)| {
            let distance = distance * scale;
            let x = if side > 0.0 {
                at.0 + distance
            } else {
                at.0 - distance - size.0
            };
            let y = at.1 + (line * 0.8 - 0.5) * size.1;
            let cost = STEP_COST * step as f32 + LINE_COST * line.abs() + inward;
            ((x, y), cost)
        })
    })
}

fn overlap(at: (f32, f32), size: (f32, f32), other: &TextBitmap) -> f32 {
    let shared = |a: f32, size_a: f32, b: i32, size_b: u32| {
        ((a + size_a).min(b as f32 + size_b as f32) - a.max(b as f32)).max(0.0)
    };
    shared(at.0, size.0, other.x, other.width) * shared(at.1, size.1, other.y, other.height)
}

/// The line from a point to its label, with a dot at the point; none where they are close.
fn leader(label: &Unplaced, scale: f32) -> Option<TextBitmap> {
    let bitmap = &label.bitmap;
    let (x, y) = label.at;
    let (left, right) = (bitmap.x as f32, (bitmap.x + signed(bitmap.width)) as f32);
    let end_x = if x < left { left } else { right };
    let (top, low) = (bitmap.y as f32, (bitmap.y + signed(bitmap.height)) as f32);
    let end_y = (top + low) * 0.5;
    if (end_x - x).abs().max((end_y - y).abs()) < 12.0 * scale {
        return None;
    }
    let (half_width, dot) = ((0.55 * scale).max(0.5), (2.2 * scale).max(1.4));
    let margin = dot + 1.5;
    let (x0, y0) = (round(x.min(end_x) - margin), round(y.min(end_y) - margin));
    let span = |a: f32, b: f32| round((a - b).abs() + 2.0 * margin) + 1;
    let (width, height) = (span(x, end_x), span(y, end_y));
    let ink = label.color.to_srgb_bytes();
    let mut rgba = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let p = ((x0 + column) as f32 + 0.5, (y0 + row) as f32 + 0.5);
            let line = half_width + 0.5 - distance_to_segment(p, (x, y), (end_x, end_y));
            let dx = p.0 - x;
            let dy = p.1 - y;
            let disc = dot + 0.5 - (dx * dx + dy * dy).sqrt();
            let coverage = (line.clamp(0.0, 1.0) * 0.6).max(disc.clamp(0.0, 1.0) * 0.85);
            rgba.extend(ink.map(|c| byte(f32::from(c) * coverage)));
            rgba.push(byte(255.0 * coverage));
        }
    }
    Some(TextBitmap {
        x: x0,
        y: y0,
        width: u32::try_from(width).ok()?,
        height: u32::try_from(height).ok()?,
        rgba,
    })
}

fn distance_to_segment(p: (f32, f32), a: (f32, f32), b: (f32, f32)) -> f32 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length_squared = (dx * dx + dy * dy).max(1e-12);
    let t = (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length_squared).clamp(0.0, 1.0);
    let (ex, ey) = (p.0 - a.0 - t * dx, p.1 - a.1 - t * dy);
    (ex * ex + ey * ey).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(points: &[(f32, f32)]) -> Vec<Unplaced> {
        let unplaced = |&at: &(f32, f32)| Unplaced {
            bitmap: TextBitmap {
                x: 0,
                y: 0,
                width: 60,
                height: 16,
                rgba: vec![255; 60 * 16 * 4],
            },
            at,
            color: Color::from_hex(0x20_20_20),
        };
        points.iter().map(unplaced).collect()
    }

    fn texts(bitmaps: &[TextBitmap]) -> Vec<&TextBitmap> {
        bitmaps
            .iter()
            .filter(|b| b.width == 60 && b.height == 16)
            .collect()
    }

    #[test]
    fn a_crowd_of_labels_never_overlaps() {
        // Twelve points within a few pixels, and a hundred in a grid that has no room for them.
        let knot: Vec<_> = (0..12)
            .map(|i| (300.0 + (i % 4) as f32 * 6.0, 200.0 + (i / 4) as f32 * 9.0))
            .collect();
        let grid: Vec<_> = (0..100)
            .map(|i| (250.0 + (i % 10) as f32 * 8.0, 150.0 + (i / 10) as f32 * 8.0))
            .collect();
        for (points, least) in [(knot, 12), (grid, 15)] {
            let mut bitmaps = Vec::new();
            place(labels(&points), (600, 400), 1.0, &mut bitmaps);
            let placed = texts(&bitmaps);
            assert!(placed.len() >= least, "{}", placed.len());
            for (i, a) in placed.iter().enumerate() {
                for b in &placed[..i] {
                    let at = (a.x as f32, a.y as f32);
                    assert!(overlap(at, (60.0, 16.0), b) <= 60.0, "{at:?}");
                }
            }
        }
    }

    #[test]
    fn a_lone_label_stands_beside_its_point_without_a_line() {
        let mut bitmaps = Vec::new();
        place(labels(&[(100.0, 50.0)]), (600, 400), 1.0, &mut bitmaps);
        assert_eq!(bitmaps.len(), 1);
        assert_eq!((bitmaps[0].x, bitmaps[0].y), (108, 42));
    }

    #[test]
    fn few_labels_are_shown_even_where_there_is_no_room() {
        let mut bitmaps = Vec::new();
        place(labels(&[(10.0, 5.0); 3]), (40, 10), 1.0, &mut bitmaps);
        assert_eq!(texts(&bitmaps).len(), 3);
    }
}
