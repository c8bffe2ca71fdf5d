//! Where to put a camera so that everything is in the picture.

use glam::Vec3;

use crate::camera::{Orbit, Projection};

/// How to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// Turn about Y, radians, as in [`Orbit`].
    pub yaw_rad: f32,
    /// Height over the horizon, radians.
    pub pitch_rad: f32,
    /// The lens; an orthographic height is replaced by the one that fits.
    pub projection: Projection,
    /// Width over height of the picture.
    pub aspect: f32,
    /// Share of the picture's half width and half height that is left free around, 0..1.
    pub margin: f32,
    /// World distance by which points are thicker than points: half a limb.
    pub padding: f32,
}

/// The nearest camera that sees all `points`, each in the middle as well as can be; `None` when
/// there are no finite points.
///
/// For a lens this is the exact smallest distance: in each direction of the picture, the two
/// extreme rays through the points determine where the camera must stand.
#[must_use]
pub fn frame_points(points: impl IntoIterator<Item = Vec3>, framing: &Framing) -> Option<Orbit> {
    let orbit = Orbit {
        target: Vec3::ZERO,
        yaw_rad: framing.yaw_rad,
        pitch_rad: framing.pitch_rad,
        distance: 1.0,
        projection: framing.projection,
    };
    let (right, up, back) = orbit.camera().axes();
    let inside = (1.0 - framing.margin).clamp(0.05, 1.0);
    let slope = match framing.projection {
        Projection::Perspective { vertical_fov_rad } => libm::tanf(vertical_fov_rad * 0.5) * inside,
        Projection::Orthographic { .. } => 0.0,
    };
    let mut reach = Reach::new(slope * framing.aspect, slope);
    for point in points.into_iter().filter(|p| p.is_finite()) {
        let local = Vec3::new(right.dot(point), up.dot(point), back.dot(point));
        reach.include(local, framing.padding);
    }
    let (x, half_width) = reach.across.middle()?;
    let (y, half_height) = reach.along.middle()?;
    let (near, far) = (reach.front, reach.rear);
    let z = (near + far) * 0.5;
    let target = right * x + up * y + back * z;
    let tiny = f32::MIN_POSITIVE.max(framing.padding);
    Some(match framing.projection {
        Projection::Perspective { .. } => {
            let distance = (half_width / reach.slope_x).max(half_height / reach.slope_y) - z;
            Orbit {
                target,
                distance: distance.max(tiny),
                ..orbit
            }
        }
        Projection::Orthographic { .. } => {
            let height = 2.0 * half_height.max(half_width / framing.aspect) / inside;
            let height = height.max(tiny);
            let distance = (near - far) * 0.5 + height * 2.0;
            Orbit {
                target,
                distance,
                projection: Projection::Orthographic { height },
                ..orbit
            }
        }
    })
}

/// The extreme rays in one direction of the picture.
#[derive(Clone, Copy, Debug)]
struct Extent {
    plus: f32,
    minus: f32,
}

impl Extent {
    /// The position of the axis and half the (for a lens: tilted) width; `None` without points.
    fn middle(&self) -> Option<(f32, f32)> {
        (self.plus.is_finite() && self.minus.is_finite()).then_some((
            (self.plus - self.minus) * 0.5,
            (self.plus + self.minus) * 0.5,
        ))
    }
}

struct Reach {
    slope_x: f32,
    slope_y: f32,
    across: Extent,
    along: Extent,
    front: f32,
    rear: f32,
}

impl Reach {
    fn new(slope_x: f32, slope_y: f32) -> Self {
        let none = Extent {
            plus: f32::NEG_INFINITY,
            minus: f32::NEG_INFINITY,
        };
        Self {
            slope_x,
            slope_y,
            across: none,
            along: none,
            front: f32::NEG_INFINITY,
            rear: f32::INFINITY,
        }
    }

    fn include(&mut self, p: Vec3, padding: f32) {
        let widen = |extent: &mut Extent, value: f32, slope: f32| {
            extent.plus = extent.plus.max(value + padding + (p.z + padding) * slope);
            extent.minus = extent.minus.max(-value + padding + (p.z + padding) * slope);
        };
        widen(&mut self.across, p.x, self.slope_x);
        widen(&mut self.along, p.y, self.slope_y);
        self.front = self.front.max(p.z + padding);
        self.rear = self.rear.min(p.z - padding);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Vec<Vec3> {
        // A fixed, irregular set of points.
        (0..60u32)
            .map(|i| {
                let f = |k: u32| ((i * 7919 + k * 104_729) % 1000) as f32 / 1000.0;
                Vec3::new(f(1) * 3.0 + 5.0, f(2) * 1.8, f(3) * 2.0 - 7.0)
            })
            .collect()
    }

    fn spread(points: &[Vec3], orbit: &Orbit, size: (u32, u32)) -> (f32, f32, f32, f32) {
        let camera = orbit.camera();
        points
            .iter()
            .map(|&p| camera.project(p, size).unwrap())
            .fold(
                (f32::MAX, f32::MIN, f32::MAX, f32::MIN),
                |(l, r, t, b), p| (l.min(p.x), r.max(p.x), t.min(p.y), b.max(p.y)),
            )
    }

    #[test]
    fn the_tightest_camera_touches_two_opposite_edges_and_centres_the_rest() {
        let points = cloud();
        for projection in [
            Projection::Perspective {
                vertical_fov_rad: 0.7,
            },
            Projection::Orthographic { height: 1.0 },
        ] {
            for (width, height) in [(1600, 900), (300, 900)] {
                let framing = Framing {
                    yaw_rad: 0.6,
                    pitch_rad: 0.3,
                    projection,
                    aspect: width as f32 / height as f32,
                    margin: 0.0,
                    padding: 0.0,
                };
                let orbit = frame_points(points.iter().copied(), &framing).unwrap();
                let (l, r, t, b) = spread(&points, &orbit, (width, height));
                let (w, h) = (width as f32, height as f32);
                let (free_x, free_y) = (l + (w - r), t + (h - b));
                assert!(l > -0.5 && r < w + 0.5 && t > -0.5 && b < h + 0.5);
                assert!(free_x.min(free_y) < 1.0, "{free_x} {free_y}");
                if free_x < 1.0 {
                    assert!((l - (w - r)).abs() < 1.0);
                } else {
                    assert!((t - (h - b)).abs() < 1.0);
                }
            }
        }
    }

    #[test]
    fn the_margin_stays_free() {
        let points = cloud();
        let framing = Framing {
            yaw_rad: 0.0,
            pitch_rad: 0.0,
            projection: Projection::Perspective {
                vertical_fov_rad: 0.5,
            },
            aspect: 1.0,
            margin: 0.2,
            padding: 0.0,
        };
        let orbit = frame_points(points.iter().copied(), &framing).unwrap();
        let (l, r, t, b) = spread(&points, &orbit, (1000, 1000));
        assert!(
            l > 99.0 && r < 901.0 && t > 99.0 && b < 901.0,
            "{l} {r} {t} {b}"
        );
    }

    #[test]
    fn a_single_point_is_framed_and_nothing_is_not() {
        let framing = Framing {
            yaw_rad: 0.0,
            pitch_rad: 0.0,
            projection: Projection::Perspective {
                vertical_fov_rad: 0.5,
            },
            aspect: 1.5,
            margin: 0.1,
            padding: 0.1,
        };
        let orbit = frame_points([Vec3::ONE], &framing).unwrap();
        assert!(orbit.target.distance(Vec3::ONE) < 0.2 && orbit.distance > 0.1);
        assert_eq!(frame_points([Vec3::NAN], &framing), None);
        assert_eq!(frame_points([], &framing), None);
    }
}
