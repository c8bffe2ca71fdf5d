//! Walking.

use super::SampleError;
use super::foot::FootStyle;
use super::gait::{self, ArmStyle, FRAMES_PER_SEC, GaitStyle, Swing};
use crate::motion::Motion;

/// What a walk is like. The defaults are an adult's unhurried walk.
///
/// Speed and cadence together must make a stride (two steps) of 0.75 to 1.75 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkConfig {
    /// Mean speed in metres a second, 0.6 to 2.0.
    pub speed_m_per_s: f64,
    /// Steps a minute, 70 to 140. The cycle is rounded to whole frames of 1/60 s so that it loops,
    /// which changes this by 1 % at most; the speed is kept.
    pub steps_per_minute: f64,
    /// Whole gait cycles (two steps each), 1 to 1000.
    pub cycles: u32,
}

impl Default for WalkConfig {
    fn default() -> Self {
        Self {
            speed_m_per_s: 1.3,
            steps_per_minute: 110.0,
            cycles: 4,
        }
    }
}

/// A walk of [`humanoid`](super::humanoid) along +Z at 60 frames a second, starting at a left heel
/// strike. The last frame is the first one, moved forward by the way walked.
///
/// # Errors
/// [`SampleError::OutOfRange`] when a value lies outside the range that its field states.
pub fn walk(config: &WalkConfig) -> Result<Motion, SampleError> {
    let speed = super::in_range("speed_m_per_s", config.speed_m_per_s, 0.6, 2.0)?;
    let cadence = super::in_range("steps_per_minute", config.steps_per_minute, 70.0, 140.0)?;
    let cycles = super::whole_in_range("cycles", config.cycles, 1, 1000)?;
    let frames_per_cycle = super::frames_per_cycle(cadence);
    let stride = speed * f64::from(frames_per_cycle) / FRAMES_PER_SEC;
    super::in_range("stride in metres", stride, 0.75, 1.75)?;
    Ok(gait::motion(&style(stride, frames_per_cycle, cycles)))
}

/// Phases and angles follow the curves of normal walking in Winter, "The Biomechanics and Motor
/// Control of Human Gait" (2nd ed. 1991), and Perry, "Gait Analysis" (1992); the pelvis and the
/// trunk Inman, Ralston and Todd, "Human Walking" (1981); the arms Murray, Sepic and Barnard,
/// "Patterns of sagittal rotation of the upper limbs in walking" (1967).
fn style(stride: f64, frames_per_cycle: u32, cycles: u32) -> GaitStyle {
    // Against the stride of a walk at 1.3 m/s: excursions grow with the length of the steps.
    let size = stride / 1.43;
    // Long steps are made by rising on the ball of the foot behind.
    let rise = (size * size * size).max(0.5);
    // The faster the walk, the shorter the stance.
    let toe_off = 0.62 - 0.15 * (size - 1.0).clamp(-0.1, 0.25);
    GaitStyle {
        stride,
        frames_per_cycle,
        cycles,
        foot: FootStyle {
            flat_from: 0.085,
            flat_to: 0.30,
            toes_flat_to: 0.52,
            toe_off,
            pitch: vec![
                (0.40, -1.8 * rise * rise),
                (0.50, -16.6 * rise),
                (0.56, -38.0 * (0.6 + 0.4 * rise)),
                (toe_off, -67.0),
                (0.68, -72.5),
                (0.76, -47.0),
                (0.84, -12.0),
                (0.92, 18.0),
                (1.00, 16.0),
            ],
            toe_pitch: vec![
                (toe_off, -23.5),
                (0.70, -56.0),
                (0.80, -15.0),
                (0.90, 10.0),
                (1.00, 28.0),
            ],
            swing_forward: vec![(0.20, 0.126), (0.45, 0.409), (0.70, 0.806), (0.88, 0.971)],
            swing_height: vec![
                (0.20, 0.257),
                (0.45, 0.180 + 0.07 * (size - 1.0).max(0.0)),
                (0.70, 0.105),
                (0.88, 0.100),
            ],
            toe_out_deg: 7.0,
        },
        heel_side: 0.045,
        heel_ahead: 0.195 * stride,
        // Long steps straighten the legs more than once a cycle; a knee that comes too near to its
        // limit snaps.
        least_knee_deg: 5.5 + 25.0 * (size - 1.0).max(0.0),
        pelvis_rise: Swing::new(0.0, 0.018 * size * size, 0.259),
        pelvis_sway: Swing::new(0.0, 0.020, 0.30),
        pelvis_surge: Swing::new(0.0, 0.010, 0.0),
        pelvis_yaw: Swing::new(0.0, 4.0 * size, 0.0),
        pelvis_list: Swing::new(0.0, 3.5, 0.17),
        pelvis_tilt: Swing::new(3.0, 1.0, 0.05),
        chest_yaw: Swing::new(0.0, 4.0 * size, 0.52),
        chest_list: Swing::new(0.0, 1.5, 0.70),
        chest_lean: Swing::new(3.0, 1.0, 0.10),
        head_nod: Swing::new(2.0, 0.7, 0.35),
        arm: ArmStyle {
            shoulder: Swing::new(-4.0, 19.0 * size, 0.51),
            abduction: Swing::new(8.0, 1.5, 0.0),
            inward: Swing::new(22.0, 6.0, 0.52),
            elbow: Swing::new(25.0, 13.0 * size, 0.56),
            wrist: Swing::new(6.0, 3.0, 0.6),
            girdle: Swing::new(0.0, 3.0, 0.52),
        },
    }
}
