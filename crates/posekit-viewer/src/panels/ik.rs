//! Inverse kinematics: the effector, the chain, the solver, what came of it, what is held, and the
//! solver's way step by step.

use std::cmp::Ordering;

use egui::{Button, DragValue, RichText, Slider, Ui};
use posekit::skeleton::Skeleton;

use super::inspector::number;
use super::{Asked, row, tip};
use crate::command::Command;
use crate::icons::{Icon, icon_button, sized_icon};
use crate::state::ik::{
    ITERATIONS, IkSettings, Solved, Start, TOLERANCES, auto_start, chain_joints, choices,
    outcome_text,
};
use crate::state::session::{Hold, Session};
use crate::theme::{GAP, Palette};

/// Shows the part of the inspector that is about limbs.
pub fn show(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    row::heading(ui, "Inverse kinematics", |_| {});
    let Some(clip) = session.active_clip().map(std::sync::Arc::clone) else {
        return;
    };
    let mut settings = session.ik().clone();
    chain(ui, session, clip.skeleton(), &mut settings);
    solver(ui, &mut settings, session.keeps_within_motion());
    session.set_ik(settings);
    target(ui, session);
    ui.add_space(GAP);
    result(ui, session);
    ui.add_space(GAP);
    actions(ui, session, asked);
    steps(ui, session, asked);
    pins(ui, session, clip.skeleton(), asked);
}

fn chain(ui: &mut Ui, session: &Session, skeleton: &Skeleton, settings: &mut IkSettings) {
    let effector = session.effector();
    row::line(ui, "Effector", |ui| {
        let name = effector.map_or("Click a joint", |joint| skeleton.unique_name(joint));
        let palette = Palette::in_ui(ui);
        let color = match effector {
            Some(_) => palette.text,
            None => palette.quiet,
        };
        ui.add(egui::Label::new(RichText::new(name).color(color)).truncate());
    });
    row::line(ui, "Start", |ui| {
        let limb = effector.and_then(|joint| auto_start(skeleton, joint));
        let is_whole = |joint| chain_joints(skeleton, joint, Start::Limb).is_empty();
        let limb = match (limb, effector) {
            (_, Some(joint)) if is_whole(joint) => "Limb: the whole figure".to_owned(),
            (Some(joint), _) => format!("Limb: {}", skeleton.unique_name(joint)),
            (None, _) => "Limb".to_owned(),
        };
        let shown = match settings.start {
            Start::Limb => limb.clone(),
            Start::Joint(joint) if joint.index() < skeleton.joint_count() => {
                skeleton.unique_name(joint).to_owned()
            }
            Start::Joint(_) => "–".to_owned(),
            Start::Body => "Whole figure".to_owned(),
        };
        egui::ComboBox::from_id_salt("ik start")
            .selected_text(shown)
            .width(ui.available_width() - 2.0)
            .truncate()
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut settings.start, Start::Limb, limb);
                ui.selectable_value(&mut settings.start, Start::Body, "Whole figure");
                ui.separator();
                for joint in skeleton.joints().filter(|&joint| Some(joint) != effector) {
                    let depth = skeleton.depth(joint).min(12);
                    let name = format!("{}{}", "  ".repeat(depth), skeleton.unique_name(joint));
                    ui.selectable_value(&mut settings.start, Start::Joint(joint), name);
                }
            })
            .response
            .on_hover_text("It keeps its place. From a foot to a hand the root moves with it");
    });
}

fn solver(ui: &mut Ui, settings: &mut IkSettings, within_motion: bool) {
    row::line(ui, "Solver", |ui| {
        egui::ComboBox::from_id_salt("ik solver")
            .selected_text(settings.solver.name())
            .width(ui.available_width() - 2.0)
            .show_ui(ui, |ui| {
                for choice in choices() {
                    let name = choice.name();
                    ui.selectable_value(&mut settings.solver, choice, name);
                }
            });
    });
    row::line(ui, "Iterations", |ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 60.0).max(60.0);
        ui.add(Slider::new(&mut settings.iterations, ITERATIONS).logarithmic(true))
            .on_hover_text("The most iterations of one solve");
    });
    row::line(ui, "Tolerance", |ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 60.0).max(60.0);
        let slider = Slider::new(&mut settings.tolerance, TOLERANCES).logarithmic(true);
        ui.add(slider.custom_formatter(|value, _| format!("{value:.0e}")))
            .on_hover_text("A target this near counts as reached; a share of the chain's length");
    });
    row::line(ui, "Limits", |ui| {
        let mut on = within_motion;
        ui.checkbox(&mut on, "Within this motion").on_hover_text(
            "Joints turn no farther than in the clip, and somewhat more; knees and elbows do not bend backwards",
        );
        if on != within_motion {
            settings.within_motion = Some(on);
        }
    });
    row::line(ui, "Follows", |ui| {
        ui.checkbox(&mut settings.is_live, "While dragging")
            .on_hover_text("Without it the target is set, and the solver waits: solve, or step");
    });
}

/// Where the effector should be, as numbers: typed, or dragged sideways, which is one step when it is let go.
fn target(ui: &mut Ui, session: &mut Session) {
    let Some(target) = session.target().filter(|_| session.can_edit()) else {
        return;
    };
    let speed = f64::from(session.stage().stature()) / 400.0;
    let before = target.position.to_array();
    let mut numbers = before;
    let mut is_held = false;
    let mut is_let_go = false;
    row::line(ui, "Target", |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let width = ((ui.available_width() - 2.0 * 2.0) / 3.0).max(40.0);
        for (axis, number) in ["x", "y", "z"].into_iter().zip(&mut numbers) {
            let field = DragValue::new(number)
                .speed(speed)
                .max_decimals(4)
                .update_while_editing(false);
            let response = ui.add_sized([width, ui.spacing().interact_size.y], field);
            let name = format!("Target {axis}");
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, &name));
            is_held |= response.dragged();
            is_let_go |= response.drag_stopped();
            response.on_hover_text(
                "Where the effector should be, in the file's unit: drag sideways, or click and type",
            );
        }
    });
    if numbers != before || is_let_go {
        session.set_target_position(numbers.into(), is_held);
    }
}

/// What came of the last problem.
fn result(ui: &mut Ui, session: &Session) {
    let palette = Palette::in_ui(ui);
    let Some(solved) = session.solved() else {
        let says = "Drag the arrows at the joint, or type a place: the chain follows.";
        ui.label(RichText::new(says).small().color(palette.quiet));
        return;
    };
    let report = &solved.report;
    let color = if report.outcome.is_reached() {
        palette.good
    } else {
        palette.warning
    };
    let text = outcome_text(report.outcome, number);
    ui.add(egui::Label::new(RichText::new(text).color(color)).wrap());
    row::line(ui, "Residual", |ui| {
        ui.label(RichText::new(residual_text(solved)).monospace())
            .on_hover_text("From the effector to its target, and as a share of the chain's length");
    });
    let angle = report.largest_angle_rad();
    if session.is_oriented() || angle > 0.0 {
        row::line(ui, "Angle off", |ui| {
            let text = format!("{:.2}\u{b0}", angle.to_degrees());
            ui.label(RichText::new(text).monospace());
        });
    }
    row::line(ui, "Took", |ui| {
        let text = format!("{} it., {}", report.iterations, time_text(solved.secs));
        let says = format!("Iterations of {}, and the time they took", solved.solver);
        ui.label(RichText::new(text).monospace())
            .on_hover_text(says);
    });
}

fn residual_text(solved: &Solved) -> String {
    let distance = solved
        .report
        .residuals
        .first()
        .map_or(0.0, |residual| residual.distance);
    let share = 100.0 * distance / f64::from(solved.reach).max(f64::MIN_POSITIVE);
    if share < 0.01 {
        format!("{distance:.1e}  <0.01 %")
    } else {
        format!("{}  {share:.2} %", number(distance))
    }
}

fn time_text(secs: f64) -> String {
    if secs < 1e-3 {
        format!("{:.0} \u{b5}s", secs * 1e6)
    } else {
        format!("{:.1} ms", secs * 1e3)
    }
}

fn actions(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let is_ready = session.effector().is_some() && session.can_edit();
    ui.horizontal(|ui| {
        ui.add_enabled_ui(is_ready, |ui| {
            for (name, says, command) in [
                ("Solve", "Go on from here to the target", Command::Solve),
                (
                    "Target here",
                    "Bring the target back to the effector",
                    Command::ForgetTarget,
                ),
            ] {
                if ui
                    .add(Button::new(name))
                    .on_hover_text(tip(says, command))
                    .clicked()
                {
                    asked.command(command);
                }
            }
        });
    });
}

/// The solver's way.
fn steps(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    part(ui, "Step by step");
    let is_ready = session.effector().is_some() && session.can_edit();
    let Some(stepper) = session.stepper() else {
        ui.add_enabled_ui(is_ready, |ui| {
            let says = "Show each joint's update of the solver before it is made";
            if ui
                .add(Button::new("Show the solver's way"))
                .on_hover_text(tip(says, Command::StepSolver))
                .clicked()
            {
                asked.command(Command::StepSolver);
            }
        });
        return;
    };
    let (made, count) = stepper.progress();
    let (iteration, iterations) = stepper.iteration();
    let text = step_text(session, (iteration, iterations), (made, count));
    let mut place = made;
    ui.label(RichText::new(text).small());
    if count > 0 {
        ui.spacing_mut().slider_width = ui.available_width() - 8.0;
        ui.add(Slider::new(&mut place, 0..=count).show_value(false));
    }
    if place != made {
        session.step_solver(|stepper| stepper.go_to(place));
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        if icon_button(ui, Icon::ToStart, "An iteration back").clicked() {
            session.step_solver(|stepper| stepper.step_iteration(Ordering::Less));
        }
        let back = tip("An update back", Command::StepSolverBack);
        if icon_button(ui, Icon::PreviousFrame, &back).clicked() {
            asked.command(Command::StepSolverBack);
        }
        let next = tip("The next update", Command::StepSolver);
        if icon_button(ui, Icon::NextFrame, &next).clicked() {
            asked.command(Command::StepSolver);
        }
        if icon_button(ui, Icon::ToEnd, "An iteration on").clicked() {
            session.step_solver(|stepper| stepper.step_iteration(Ordering::Greater));
        }
        ui.add_space(GAP);
        if ui
            .button("Keep the solver's pose")
            .on_hover_text("The figure stays as it is at this step")
            .clicked()
        {
            session.keep_step();
        }
        if ui
            .button("End")
            .on_hover_text("The figure goes back  (Esc)")
            .clicked()
        {
            session.stop_stepping();
        }
    });
}

fn step_text(
    session: &Session,
    (iteration, iterations): (usize, usize),
    (made, count): (usize, usize),
) -> String {
    let (Some(stepper), Some(clip)) = (session.stepper(), session.active_clip()) else {
        return String::new();
    };
    if count == 0 {
        return "There is nothing to do: the effector is at its target".to_owned();
    }
    let distance = stepper.distance().map_or_else(String::new, |distance| {
        format!("{} from the target", number(distance))
    });
    match stepper.next() {
        Some(next) => {
            let name = clip.skeleton().unique_name(next.joint);
            let angle = next.amount.to_degrees();
            format!(
                "Iteration {} of {iterations}, update {} of {count}\n\
                 {name} turns by {angle:.2}\u{b0}\n{distance}",
                iteration + 1,
                made + 1,
            )
        }
        None => format!("All {iterations} iterations are made\n{distance}\n"),
    }
}

/// What is held.
fn pins(ui: &mut Ui, session: &mut Session, skeleton: &Skeleton, asked: &mut Asked) {
    part(ui, "Pins");
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for (name, says, what) in [
            (
                "This joint",
                "Hold it where it is, or no longer",
                Hold::Effector,
            ),
            ("Feet", "Hold both feet, or no longer", Hold::Feet),
            ("Hands", "Hold both hands, or no longer", Hold::Hands),
        ] {
            let joints = session.joints_to_hold(what);
            let goals = session.goals();
            let is_held = !joints.is_empty() && joints.iter().all(|&joint| goals.is_pinned(joint));
            let command = Command::TogglePin(what);
            ui.add_enabled_ui(!joints.is_empty() && session.can_edit(), |ui| {
                if ui
                    .add(Button::selectable(is_held, name))
                    .on_hover_text(tip(says, command))
                    .clicked()
                {
                    asked.command(command);
                }
            });
        }
    });
    let palette = Palette::in_ui(ui);
    for pin in session.goals().pins {
        if pin.joint.index() >= skeleton.joint_count() {
            continue;
        }
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            let size = egui::vec2(20.0, 20.0);
            if sized_icon(ui, Icon::Close, "Unpin", false, size).clicked() {
                session.unpin(pin.joint);
            }
            let name = skeleton.unique_name(pin.joint);
            let size = egui::vec2(112.0, 20.0);
            let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
            row::text_in(ui, rect, RichText::new(name), palette.text);
            let mut turned = pin.orientation.is_some();
            ui.checkbox(&mut turned, "turned so")
                .on_hover_text("How it is turned is held, too");
            if turned != pin.orientation.is_some() {
                session.hold_orientation(pin.joint, turned);
            }
        });
    }
    if session.goals().pins.is_empty() {
        let says =
            "What is pinned stays, as far as its limb lets it. Pin the feet and drag the root.";
        ui.add(egui::Label::new(RichText::new(says).small().color(palette.quiet)).wrap());
    }
}

fn part(ui: &mut Ui, title: &str) {
    ui.add_space(GAP);
    let quiet = Palette::in_ui(ui).quiet;
    ui.label(RichText::new(title).small().strong().color(quiet));
}
