//! Running.

use super::SampleError;
use super::foot::FootStyle;
use super::gait::{self, ArmStyle, FRAMES_PER_SEC, GaitStyle, Swing};
use crate::motion::Motion;

/// What a run is like. The defaults are an adult's steady jog.
///
/// Speed and cadence together must make a stride (two steps) of 1.6 to 2.6 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunConfig {
    /// Mean speed in metres a second, 2.2 to 4.
    pub speed_m_per_s: f64,
    /// Steps a minute, 150 to 190. The cycle is rounded to whole frames of 1/60 s so that it
    /// loops, which changes this by 2 % at most; the speed is kept.
    pub steps_per_minute: f64,
    /// Whole gait cycles (two steps each), 1 to 1000.
    pub cycles: u32,
}

impl Default for RunConfig {
    fn default() -> Self {
        Self {
            speed_m_per_s: 3.0,
            steps_per_minute: 168.0,
            cycles: 6,
        }
    }
}

/// A run of [`humanoid`](super::humanoid) along +Z at 60 frames a second, starting at a left heel
/// strike. The last frame is the first one, moved forward by the way run.
///
/// # Errors
/// [`SampleError::OutOfRange`] when a value lies outside the range that its field states.
pub fn run(config: &RunConfig) -> Result<Motion, SampleError> {
    let speed = super::in_range("speed_m_per_s", config.speed_m_per_s, 2.2, 4.0)?;
    let cadence = super::in_range("steps_per_minute", config.steps_per_minute, 150.0, 190.0)?;
    let cycles = super::whole_in_range("cycles", config.cycles, 1, 1000)?;
    let frames_per_cycle = super::frames_per_cycle(cadence);
    let stride = speed * f64::from(frames_per_cycle) / FRAMES_PER_SEC;
    super::in_range("stride in metres", stride, 1.6, 2.6)?;
    Ok(gait::motion(&style(stride, frames_per_cycle, cycles)))
}

/// Standard gravity.
const GRAVITY_M_PER_S2: f64 = 9.806_65;

/// Phases and angles follow the curves of running in Novacheck, "The biomechanics of running"
/// (Gait and Posture 7, 1998). The pelvis rises and falls twice a cycle as a harmonic whose
/// acceleration at the top is that of free fall, since the body is in flight there.
fn style(stride: f64, frames_per_cycle: u32, cycles: u32) -> GaitStyle {
    let cycle_secs = f64::from(frames_per_cycle) / FRAMES_PER_SEC;
    let rate = 4.0 * std::f64::consts::PI / cycle_secs;
    GaitStyle {
        stride,
        frames_per_cycle,
        cycles,
        foot: FootStyle {
            flat_from: 0.05,
            flat_to: 0.15,
            toes_flat_to: 0.26,
            toe_off: 0.36,
            pitch: vec![
                (0.22, -4.6),
                (0.29, -24.6),
                (0.36, -57.0),
                (0.46, -76.3),
                (0.62, -80.0),
                (0.82, -18.5),
                (1.00, 8.4),
            ],
            toe_pitch: vec![
                (0.36, -15.3),
                (0.46, -50.0),
                (0.62, -72.0),
                (0.82, -8.0),
                (1.00, 10.0),
            ],
            swing_forward: vec![(0.18, 0.071), (0.38, 0.308), (0.60, 0.591), (0.80, 0.861)],
            swing_height: vec![(0.18, 0.308), (0.38, 0.333), (0.60, 0.261), (0.80, 0.157)],
            toe_out_deg: 5.0,
        },
        heel_side: 0.022,
        heel_ahead: 0.20 + 0.18 * (stride - 2.15),
        least_knee_deg: 12.0,
        pelvis_rise: Swing::new(0.0, GRAVITY_M_PER_S2 / (rate * rate), 0.39),
        pelvis_sway: Swing::new(0.0, 0.010, 0.20),
        pelvis_surge: Swing::new(0.0, 0.008, 0.45),
        pelvis_yaw: Swing::new(0.0, 6.0, 0.0),
        pelvis_list: Swing::new(0.0, 3.5, 0.17),
        pelvis_tilt: Swing::new(8.0, 1.5, 0.40),
        chest_yaw: Swing::new(0.0, 9.0, 0.45),
        chest_list: Swing::new(0.0, 2.0, 0.65),
        chest_lean: Swing::new(9.0, 1.5, 0.30),
        head_nod: Swing::new(4.0, 1.0, 0.20),
        arm: ArmStyle {
            shoulder: Swing::new(-14.0, 30.0, 0.46),
            abduction: Swing::new(14.0, 3.0, 0.95),
            inward: Swing::new(30.0, 8.0, 0.46),
            elbow: Swing::new(92.0, 12.0, 0.50),
            wrist: Swing::new(8.0, 4.0, 0.55),
            girdle: Swing::new(0.0, 6.0, 0.46),
        },
    }
}
