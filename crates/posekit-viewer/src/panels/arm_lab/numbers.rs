//! The right side: where the tip is, what is asked of it, and how well it can move.

use egui::{Button, ComboBox, RichText, ScrollArea, Sense, Ui, vec2};
use glam::{DMat3, DQuat, DVec3};
use posekit::ik::IkOutcome;
use posekit::ik::robot::{WaysMethod, range_margins};
use posekit::skeleton::JointId;

use super::super::inspector::{line, part, values};
use super::super::{row, tip};
use crate::command::Command;
use crate::state::arm::bench::Miss;
use crate::state::arm::mobility::{Hardest, Mobility, Singularity};
use crate::state::arm::{ArmLab, Bench};
use crate::state::readout::fixed;
use crate::theme::{GAP, Palette};

/// A joint nearer to an end than this share of half its range is told of.
const NEAR_END: f64 = 0.08;

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut ArmLab) {
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, GAP);
            choose_tip(ui, lab);
            let Some(bench) = lab.bench() else { return };
            place(ui, bench);
            row::divider(ui);
            target(ui, lab);
            row::divider(ui);
            let Some(bench) = lab.bench() else { return };
            let mobility = bench.mobility();
            measure(ui, bench, &mobility);
            row::divider(ui);
            limits(ui, bench);
        });
}

fn choose_tip(ui: &mut Ui, lab: &mut ArmLab) {
    let Some(bench) = lab.bench() else { return };
    let robot = std::sync::Arc::clone(bench.robot());
    let mut chosen = bench.tip();
    row::heading(ui, "Tip", |ui| {
        let name = |joint: JointId| robot.link_name(joint).to_owned();
        ComboBox::from_id_salt("tip")
            .selected_text(name(chosen))
            .width(150.0)
            .show_ui(ui, |ui| {
                let inner = robot.mechanism.skeleton().joints();
                let others = inner.filter(|joint| !robot.tips.contains(joint));
                for joint in robot.tips.iter().copied().chain(others) {
                    ui.selectable_value(&mut chosen, joint, name(joint));
                }
            })
            .response
            .on_hover_text("The link whose frame is the tip");
    });
    if chosen != bench.tip() {
        lab.work(|bench| bench.set_tip(chosen));
    }
}

fn named(v: DVec3) -> [(String, f64); 3] {
    [("x", v.x), ("y", v.y), ("z", v.z)].map(|(name, value)| (name.to_owned(), value))
}

/// Where the tip is, in the world and as the file counts.
fn place(ui: &mut Ui, bench: &Bench) {
    let frame = bench.tip_frame();
    values(
        ui,
        "World",
        "Metres in the world, Y up",
        &named(frame.position),
        3,
    );
    let upright = bench.frames()[0];
    let in_file = upright.orientation.inverse() * (frame.position - upright.position);
    values(
        ui,
        "In file",
        "Metres in the robot's own base frame, Z up, as the file and ROS count",
        &named(in_file),
        3,
    );
    let turn = upright.orientation.inverse() * frame.orientation;
    let angles = roll_pitch_yaw(turn).map(f64::to_degrees);
    let letters = ["x", "y", "z"];
    let angles: Vec<_> = letters
        .iter()
        .zip(angles)
        .map(|(name, angle)| ((*name).to_owned(), angle))
        .collect();
    values(
        ui,
        "Roll..yaw",
        "Roll, pitch and yaw in the base frame, degrees: turns about its X, then Y, then Z",
        &angles,
        1,
    );
}

/// Turns about the fixed axes X, then Y, then Z, as URDF has them; where the pitch is a quarter turn the
/// yaw is zero.
fn roll_pitch_yaw(rotation: DQuat) -> [f64; 3] {
    let m = DMat3::from_quat(rotation);
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let across = libm::hypot(x.x, x.y);
    let pitch = libm::atan2(-x.z, across);
    if across < 1e-9 {
        return [libm::atan2(-z.y, y.y), pitch, 0.0];
    }
    [libm::atan2(y.z, z.z), pitch, libm::atan2(x.y, x.x)]
}

fn target(ui: &mut Ui, lab: &mut ArmLab) {
    let palette = Palette::in_ui(ui);
    let Some(bench) = lab.bench() else { return };
    let miss = bench.miss();
    row::heading(ui, "Target", |ui| {
        if let Some(miss) = miss {
            let (text, color) = if bench.is_reached(miss) {
                ("reached", palette.good)
            } else {
                ("not reached", palette.warning)
            };
            ui.label(RichText::new(text).small().strong().color(color));
        }
    });
    // Above what changes with them: they stay under the pointer that presses them again.
    target_buttons(ui, lab, miss.is_some());
    let Some(bench) = lab.bench() else { return };
    match miss {
        None => {
            let says = "Drag the arrows and rings at the tip; the joints follow.";
            ui.label(RichText::new(says).small().color(palette.quiet));
        }
        Some(miss) => {
            single(
                ui,
                "Misses by",
                "The distance left, by forward kinematics",
                &missing(miss),
            );
            if let Some(report) = bench.report() {
                let text = format!("{}, {}", outcome(report.outcome), times(report.iterations));
                single(
                    ui,
                    "Solver",
                    "Levenberg-Marquardt from where the joints stood, within their ranges",
                    &text,
                );
            }
        }
    }
    ways(ui, lab);
}

fn target_buttons(ui: &mut Ui, lab: &mut ArmLab, has_target: bool) {
    ui.horizontal(|ui| {
        let says = "The same place by other joint angles: the next of all ways";
        if ui
            .add(Button::new("Another way"))
            .on_hover_text(tip(says, Command::Solve))
            .clicked()
        {
            lab.work(Bench::take_next_way);
        }
        ui.add_enabled_ui(has_target, |ui| {
            let says = "There is nothing to reach any more";
            if ui.button("Let go").on_hover_text(says).clicked() {
                lab.work(Bench::forget_target);
            }
        });
    });
}

/// The ways to the target, once they were looked for, each a button.
fn ways(ui: &mut Ui, lab: &mut ArmLab) {
    let palette = Palette::in_ui(ui);
    let Some(bench) = lab.bench() else { return };
    let Some(found) = bench.ways() else { return };
    let (count, taken) = (found.ways.len(), bench.way_taken());
    let text = match (count, found.is_endless) {
        (0, _) => "No way gets there.".to_owned(),
        (1, false) => "This is the only way.".to_owned(),
        (_, true) => "Some of endlessly many ways:".to_owned(),
        (_, false) => match found.method {
            WaysMethod::Search => format!("{count} ways were found:"),
            _ => format!("There are {count} ways:"),
        },
    };
    let says = match found.method {
        WaysMethod::SphericalWrist => {
            "In closed form, for the last three axes meet in a point (Pieper 1968)"
        }
        WaysMethod::ThreeParallelAxes => {
            "In closed form, for three axes are parallel (Hawkins 2013)"
        }
        _ => "From 400 random places; there may be more",
    };
    ui.label(RichText::new(text).small().color(palette.quiet))
        .on_hover_text(says);
    if count < 2 {
        return;
    }
    let degrees: Vec<String> = found
        .ways
        .iter()
        .map(|way| in_degrees(bench, way))
        .collect();
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for (index, degrees) in degrees.iter().enumerate() {
            let button = Button::selectable(taken == Some(index), format!("Way {}", index + 1));
            if ui.add(button).on_hover_text(degrees).clicked() {
                chosen = Some(index);
            }
        }
    });
    if let Some(index) = chosen {
        lab.work(|bench| bench.take_way(index));
    }
}

/// The values of a way, as the sliders have them.
fn in_degrees(bench: &Bench, way: &[f64]) -> String {
    let shown = way
        .iter()
        .zip(&bench.robot().values)
        .map(|(value, kind)| match kind.is_angle {
            true => format!("{}\u{b0}", fixed(value.to_degrees(), 1)),
            false => format!("{} m", fixed(*value, 3)),
        });
    shown.collect::<Vec<_>>().join("  ")
}

fn missing(miss: Miss) -> String {
    let distance = if miss.distance < 1e-3 {
        format!("{} mm", fixed(1e3 * miss.distance, 4))
    } else {
        format!("{} m", fixed(miss.distance, 4))
    };
    format!(
        "{distance}, {}\u{b0}",
        fixed(miss.angle_rad.to_degrees(), 2)
    )
}

fn outcome(outcome: IkOutcome) -> &'static str {
    match outcome {
        IkOutcome::Reached => "reached",
        IkOutcome::LimitsInTheWay => "limits in the way",
        IkOutcome::IterationLimit => "iteration limit",
        _ => "as near as it gets",
    }
}

fn times(iterations: u32) -> String {
    match iterations {
        1 => "1 step".to_owned(),
        count => format!("{count} steps"),
    }
}

fn single(ui: &mut Ui, name: &str, says: &str, text: &str) {
    line(ui, name, says, |ui| {
        let text = RichText::new(text).monospace().size(11.5);
        ui.add(egui::Label::new(text).truncate());
    });
}

/// Manipulability, singular values, and what is lost at a singularity.
fn measure(ui: &mut Ui, bench: &Bench, mobility: &Mobility) {
    let palette = Palette::in_ui(ui);
    let (word, color) = match mobility.singularity {
        Singularity::Far => ("regular", palette.good),
        Singularity::Near => ("near singular", palette.warning),
        Singularity::At => ("singular", palette.error),
    };
    row::heading(ui, "Manipulability", |ui| {
        if !mobility.singular_values.is_empty() {
            ui.label(RichText::new(word).small().strong().color(color));
        }
    });
    if mobility.singular_values.is_empty() {
        row::empty_note(ui, "Nothing moves this tip.");
        return;
    }
    single(
        ui,
        "w",
        "sqrt(det J Jt), the product of the singular values (Yoshikawa 1985)",
        &exact(mobility.manipulability),
    );
    gauge(ui, mobility, color);
    let says = match mobility.radian_length {
        Some(length) => format!(
            "Half axes of the ellipsoid of velocities for joints of unit speed, largest first; a radian \
             counts as {} m",
            fixed(length, 3)
        ),
        None => "Half axes of the ellipsoid of velocities for joints of unit speed, largest first"
            .to_owned(),
    };
    part(ui, "Singular values");
    bars(ui, mobility, &says);
    if let Some(hardest) = mobility.hardest {
        let verb = match mobility.singularity {
            Singularity::At => "Lost",
            _ => "Hardest",
        };
        let (text, says) = match hardest {
            Hardest::Move(d) => (
                format!("move {}", direction(d)),
                "To move along this direction of the world",
            ),
            Hardest::Turn(d) => (
                format!("turn {}", direction(d)),
                "To turn about this axis of the world",
            ),
        };
        single(ui, verb, says, &text);
    }
    if let Some([first, second]) = mobility.in_line {
        let robot = bench.robot();
        let text = format!(
            "The axes of {} and {} are in line: one undoes what the other does.",
            robot.joint_name(first),
            robot.joint_name(second)
        );
        ui.add(egui::Label::new(RichText::new(text).small().color(palette.warning)).wrap());
    }
}

/// A direction in three short numbers, its first large one positive: it goes both ways.
fn direction(d: DVec3) -> String {
    let first = d.to_array().into_iter().find(|x| x.abs() > 1e-3);
    let d = if first.is_some_and(|x| x < 0.0) {
        -d
    } else {
        d
    };
    format!("{} {} {}", fixed(d.x, 2), fixed(d.y, 2), fixed(d.z, 2))
}

/// What is less than this is nothing that rounding did not make.
const ROUNDING: f64 = 1e-12;

/// Three digits that matter, however small.
fn exact(value: f64) -> String {
    if value.abs() < ROUNDING {
        "0".to_owned()
    } else if value.abs() >= 1e-3 {
        fixed(value, 4)
    } else {
        format!("{value:.2e}")
    }
}

/// How round the ellipsoid is: from a singularity at the left to a ball at the right.
fn gauge(ui: &mut Ui, mobility: &Mobility, color: egui::Color32) {
    let says = "The least singular value over the largest: 0 at a singularity, 1 where every way of moving \
                is as easy as any other";
    line(ui, "Isotropy", says, |ui| {
        let text = exact(mobility.isotropy);
        bar(
            ui,
            crate::state::arm::single(mobility.isotropy),
            color,
            &text,
        );
    });
}

fn bars(ui: &mut Ui, mobility: &Mobility, says: &str) {
    let palette = Palette::in_ui(ui);
    let largest = mobility.singular_values[0].max(f64::MIN_POSITIVE);
    for (index, &value) in mobility.singular_values.iter().enumerate() {
        line(ui, &format!("\u{3c3}{}", index + 1), says, |ui| {
            let share = crate::state::arm::single(value / largest);
            let is_last = index + 1 == mobility.singular_values.len();
            let color = match mobility.singularity {
                Singularity::At if is_last => palette.error,
                Singularity::Near if is_last => palette.warning,
                _ => palette.accent,
            };
            bar(ui, share, color, &exact(value));
        });
    }
}

/// A bar with a number at its right.
fn bar(ui: &mut Ui, share: f32, color: egui::Color32, text: &str) {
    const NUMBER: f32 = 72.0;
    let palette = Palette::in_ui(ui);
    let width = (ui.available_width() - NUMBER).max(20.0);
    let (rect, _) = ui.allocate_exact_size(vec2(width, 18.0), Sense::hover());
    let track = egui::Rect::from_center_size(rect.center(), vec2(width, 7.0));
    ui.painter().rect_filled(track, 3.5, palette.sunken);
    let full = vec2((width * share.clamp(0.0, 1.0)).max(2.0), 7.0);
    let fill = egui::Rect::from_min_size(track.min, full);
    ui.painter().rect_filled(fill, 3.5, color);
    ui.label(RichText::new(text).monospace().size(11.5));
}

/// The joints that are near an end of their ranges.
fn limits(ui: &mut Ui, bench: &Bench) {
    let palette = Palette::in_ui(ui);
    let robot = bench.robot();
    row::heading(ui, "Limits", |_| {});
    let margins = range_margins(&robot.mechanism, bench.values());
    let near: Vec<_> = margins
        .iter()
        .filter(|margin| margin.share < NEAR_END)
        .collect();
    if near.is_empty() {
        let says = "No joint is near an end of its range.";
        ui.label(RichText::new(says).small().color(palette.quiet));
    }
    for margin in near {
        let left = margin.to_lower.min(margin.to_upper);
        let amount = if robot.values[margin.value].is_angle {
            format!("{}\u{b0}", fixed(left.to_degrees(), 1))
        } else {
            format!("{} m", fixed(left, 3))
        };
        let name = robot.joint_name(margin.joint);
        let text = if left <= crate::state::arm::bench::AT_END {
            format!("{name} is at its limit")
        } else {
            format!("{name}: {amount} left")
        };
        ui.label(RichText::new(text).small().color(palette.warning));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roll_pitch_and_yaw_make_the_rotation_again() {
        use glam::EulerRot;
        for [roll, pitch, yaw] in [
            [0.3, -0.8, 2.0],
            [-2.0, 1.2, 0.1],
            [0.7, std::f64::consts::FRAC_PI_2, 0.4],
            [0.0, -std::f64::consts::FRAC_PI_2, 1.0],
        ] {
            let turn = DQuat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
            let [r, p, y] = roll_pitch_yaw(turn);
            let again = DQuat::from_euler(EulerRot::ZYX, y, p, r);
            assert!(turn.dot(again).abs() > 1.0 - 1e-9, "{roll} {pitch} {yaw}");
        }
    }

    #[test]
    fn directions_go_both_ways() {
        assert_eq!(direction(DVec3::new(0.0, -1.0, 0.0)), "0.00 1.00 0.00");
    }
}
