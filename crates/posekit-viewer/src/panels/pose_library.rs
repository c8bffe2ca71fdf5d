//! The pose library: poses are saved, put on, blended, renamed, taken out.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Button, Color32, Rect, RichText, ScrollArea, Slider, TextEdit, Ui, pos2, vec2};
use posekit::keyframe::edit::blend_poses;
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton};

use super::row;
use crate::icons::{Icon, icon_button};
use crate::picture::thumbnail::pose_thumbnail;
use crate::picture::{Texture, to_color_image};
use crate::state::animate::pose_library::{PoseId, PoseLibrary, Sides, applied, saved};
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// Height of a row with a preview picture.
const POSE_ROW: f32 = 52.0;

/// What is asked for that is about files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseRequest {
    /// A file of poses is opened.
    Open,
    /// The library is saved to a file.
    Save,
}

/// What the panel remembers.
#[derive(Debug, Default)]
pub struct PosePanel {
    selected: Option<PoseId>,
    mirrors: bool,
    blend: Option<Blend>,
    /// The name that is being typed, and of which pose.
    typed: Option<(PoseId, String)>,
    pictures: BTreeMap<PoseId, Picture>,
}

/// A blend that goes on while its slider is dragged.
#[derive(Clone, Debug)]
struct Blend {
    base: LocalPose,
    percent: f64,
    /// It was given up; the slider is still held.
    is_over: bool,
}

/// A pose's picture on a skeleton.
#[derive(Debug)]
struct Picture {
    of: Arc<Skeleton>,
    /// `None` where the skeleton has none of the pose's joints.
    texture: Option<Texture>,
}

impl PosePanel {
    /// Whether a pose is being blended in.
    #[must_use]
    pub fn is_blending(&self) -> bool {
        self.blend.as_ref().is_some_and(|blend| !blend.is_over)
    }

    /// Gives a blend up: the figure stands as before.
    pub fn cancel(&mut self, session: &mut Session) {
        if let Some(blend) = &mut self.blend {
            blend.is_over = true;
            session.drop_preview();
        }
    }

    /// The pose that is chosen.
    #[must_use]
    pub fn selected(&self) -> Option<PoseId> {
        self.selected
    }
}

/// Less height than this has no room for the list beside what is done with a pose.
const LOW: f32 = 330.0;

/// Shows the library.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    library: &mut PoseLibrary,
    panel: &mut PosePanel,
) -> Option<PoseRequest> {
    // In a low window all of it is scrolled; otherwise what is done with a pose stays in sight under the list.
    let is_low = ui.available_height() < LOW;
    if !is_low {
        return contents(ui, session, library, panel, is_low);
    }
    ScrollArea::vertical()
        .id_salt("all of the poses")
        .auto_shrink([false, false])
        .show(ui, |ui| contents(ui, session, library, panel, is_low))
        .inner
}

fn contents(
    ui: &mut Ui,
    session: &mut Session,
    library: &mut PoseLibrary,
    panel: &mut PosePanel,
    is_low: bool,
) -> Option<PoseRequest> {
    let mut asked = None;
    row::heading(ui, "Poses", |ui| {
        if icon_button(ui, Icon::File, "Open a file of poses").clicked() {
            asked = Some(PoseRequest::Open);
        }
        let has_some = !library.entries().is_empty();
        ui.add_enabled_ui(has_some, |ui| {
            if icon_button(ui, Icon::Export, "Save the poses to a file").clicked() {
                asked = Some(PoseRequest::Save);
            }
        });
    });
    save_button(ui, session, library, panel);
    ui.add_space(GAP);
    if library.entries().is_empty() {
        row::empty_note(ui, "No pose is saved yet.");
        return asked;
    }
    let chosen = panel.selected.filter(|id| library.get(*id).is_some());
    panel.selected = chosen;
    if is_low {
        ui.spacing_mut().item_spacing.y = 2.0;
        list(ui, session, library, panel);
    } else {
        let below = match chosen {
            Some(_) => 3.0 * ui.spacing().interact_size.y + 15.0 * GAP,
            None => 0.0,
        };
        let height = (ui.available_height() - below).max(POSE_ROW);
        ScrollArea::vertical()
            .id_salt("poses")
            .auto_shrink([false, false])
            .min_scrolled_height(POSE_ROW)
            .max_height(height)
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 2.0;
                list(ui, session, library, panel);
            });
    }
    if let Some(id) = chosen {
        row::divider(ui);
        chosen_pose(ui, session, library, panel, id);
    }
    asked
}

fn save_button(ui: &mut Ui, session: &Session, library: &mut PoseLibrary, panel: &mut PosePanel) {
    // End Sites do not turn: with nothing else selected the whole figure is meant.
    let skeleton = session.active_clip().map(|clip| clip.skeleton());
    let turns = |joint: &JointId| skeleton.is_some_and(|it| !it.is_end_site(*joint));
    let joints: Vec<JointId> = session.selection().iter().copied().filter(turns).collect();
    let text = match joints.len() {
        0 => "Save pose".to_owned(),
        1 => "Save pose of 1 joint".to_owned(),
        count => format!("Save pose of {count} joints"),
    };
    let size = vec2(ui.available_width(), 26.0);
    let says = "Keep the pose shown under a name: of the selected joints, or of the whole figure \
                when none is selected";
    let button = ui.add_sized(size, Button::new(text));
    if !button.on_hover_text(says).clicked() {
        return;
    }
    let pose = session
        .rest_pose_shown()
        .or_else(|| session.shown_local_pose());
    let (Some(pose), Some(clip)) = (pose, session.active_clip()) else {
        return;
    };
    let name = match joints.as_slice() {
        [joint] => clip.skeleton().unique_name(*joint).to_owned(),
        _ => "Pose".to_owned(),
    };
    if let Some(pose) = saved(&name, clip.skeleton(), &pose, &joints) {
        panel.selected = Some(library.add(pose));
    }
}

fn list(ui: &mut Ui, session: &mut Session, library: &PoseLibrary, panel: &mut PosePanel) {
    let skeleton = session
        .active_clip()
        .map(|clip| Arc::clone(clip.skeleton()));
    let mut has_drawn = false;
    for entry in library.entries() {
        let palette = Palette::in_ui(ui);
        let pose = &entry.pose;
        let (rect, response) = row::row(ui, POSE_ROW, panel.selected == Some(entry.id), &pose.name);
        if !ui.is_rect_visible(rect) {
            continue;
        }
        let picture = Rect::from_min_size(rect.min + vec2(GAP, GAP), vec2(44.0, 44.0));
        let texture = skeleton.as_ref().and_then(|skeleton| {
            // One picture at a time, so that the window does not wait for many.
            let is_new = panel.picture(entry.id, skeleton).is_none();
            if is_new && !has_drawn {
                has_drawn = true;
                panel.draw(ui, library, entry.id, skeleton);
            }
            panel.picture(entry.id, skeleton)
        });
        if let Some(Picture {
            texture: Some(texture),
            ..
        }) = texture
        {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let painter = ui.painter();
            painter.image(texture.id(), picture, whole, Color32::WHITE);
        }
        let left = picture.right() + 2.0 * GAP;
        let name = Rect::from_min_max(pos2(left, rect.top() + 7.0), rect.right_center());
        row::text_in(ui, name, RichText::new(&pose.name), palette.text);
        let says = match (texture.map(|it| it.texture.is_some()), pose.joints.len()) {
            (Some(false), _) => "No joint of this skeleton".to_owned(),
            (_, 1) => "1 joint".to_owned(),
            (_, count) => format!("{count} joints"),
        };
        let line = Rect::from_min_max(
            pos2(left, rect.center().y),
            pos2(rect.right() - GAP, rect.bottom() - 6.0),
        );
        row::text_in(ui, line, RichText::new(says).size(11.5), palette.quiet);
        if response.clicked() {
            panel.selected = Some(entry.id);
        }
        if response
            .on_hover_text("Click to choose it, double click to put it on")
            .double_clicked()
        {
            apply(session, library, panel, entry.id);
        }
    }
    if has_drawn {
        ui.ctx().request_repaint();
    }
}

impl PosePanel {
    fn picture(&self, id: PoseId, skeleton: &Arc<Skeleton>) -> Option<&Picture> {
        let picture = self.pictures.get(&id)?;
        // An edit may make the same skeleton anew.
        let same = Arc::ptr_eq(&picture.of, skeleton) || picture.of == *skeleton;
        same.then_some(picture)
    }

    fn draw(&mut self, ui: &Ui, library: &PoseLibrary, id: PoseId, skeleton: &Arc<Skeleton>) {
        let rest = LocalPose::rest(skeleton);
        let pose = library.get(id);
        let pose = pose.and_then(|pose| applied(skeleton, &rest, pose, Sides::AsSaved));
        let image = pose.and_then(|applied| pose_thumbnail(skeleton, &applied.pose));
        let texture = image.map(|image| Texture::new(ui.ctx(), to_color_image(&image)));
        let of = Arc::clone(skeleton);
        self.pictures.insert(id, Picture { of, texture });
    }

    fn sides(&self) -> Sides {
        if self.mirrors {
            Sides::Mirrored
        } else {
            Sides::AsSaved
        }
    }
}

/// The name, the blend and the buttons of the pose that is chosen.
fn chosen_pose(
    ui: &mut Ui,
    session: &mut Session,
    library: &mut PoseLibrary,
    panel: &mut PosePanel,
    id: PoseId,
) {
    name_field(ui, library, panel, id);
    let can = session.can_pose();
    ui.add_enabled_ui(can, |ui| blend(ui, session, library, panel, id));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let says = "Put it on the figure at the time shown";
        let button = ui.add_enabled(can, Button::new("Apply"));
        if button.on_hover_text(says).clicked() {
            apply(session, library, panel, id);
        }
        let mirrored = Button::selectable(panel.mirrors, "Mirrored");
        if ui
            .add(mirrored)
            .on_hover_text("Left and right change places")
            .clicked()
        {
            panel.mirrors = !panel.mirrors;
        }
        let rest = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(rest, |ui| {
            if ui
                .button("Delete")
                .on_hover_text("Take it out of the library")
                .clicked()
            {
                library.remove(id);
                panel.pictures.remove(&id);
                panel.selected = None;
            }
        });
    });
}

fn name_field(ui: &mut Ui, library: &mut PoseLibrary, panel: &mut PosePanel, id: PoseId) {
    let Some(pose) = library.get(id) else {
        return;
    };
    let mut text = match &panel.typed {
        Some((of, text)) if *of == id => text.clone(),
        _ => pose.name.clone(),
    };
    let response = row::line(ui, "Name", |ui| {
        ui.add(TextEdit::singleline(&mut text).desired_width(f32::INFINITY))
    });
    if response.changed() {
        panel.typed = Some((id, text));
    }
    if response.lost_focus()
        && let Some((of, text)) = panel.typed.take()
        && !ui.input(|i| i.key_pressed(egui::Key::Escape))
    {
        library.rename(of, &text);
    }
}

/// The slider from the pose shown to the saved one. All of a drag is one step.
fn blend(
    ui: &mut Ui,
    session: &mut Session,
    library: &PoseLibrary,
    panel: &mut PosePanel,
    id: PoseId,
) {
    let mut percent = panel.blend.as_ref().map_or(0.0, |blend| blend.percent);
    let response = row::line(ui, "Blend", |ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 58.0).max(60.0);
        let slider = Slider::new(&mut percent, 0.0..=100.0)
            .suffix(" %")
            .fixed_decimals(0)
            .update_while_editing(false);
        ui.add(slider)
            .on_hover_text("How far from the pose shown to this one; letting go puts it on")
    });
    let is_held = response.dragged();
    if response.changed()
        && let Some(base) = panel
            .blend
            .as_ref()
            .map(|blend| blend.base.clone())
            .or_else(|| session.shown_local_pose())
    {
        let is_over = panel.blend.as_ref().is_some_and(|blend| blend.is_over);
        if !is_over && let Some(pose) = blended(session, library, panel, id, &base, percent) {
            session.preview_pose(pose);
        }
        panel.blend = Some(Blend {
            base,
            percent,
            is_over,
        });
    }
    if !is_held
        && let Some(done) = panel.blend.take()
        && !done.is_over
    {
        let pose = blended(session, library, panel, id, &done.base, done.percent);
        match pose.filter(|_| done.percent > 0.0) {
            Some(pose) => session.apply_pose(&step_name("Blend", library, id), pose),
            None => session.drop_preview(),
        }
    }
}

fn blended(
    session: &Session,
    library: &PoseLibrary,
    panel: &PosePanel,
    id: PoseId,
    base: &LocalPose,
    percent: f64,
) -> Option<LocalPose> {
    let clip = session.active_clip()?;
    let pose = library.get(id)?;
    let target = applied(clip.skeleton(), base, pose, panel.sides())?;
    let joints = target.joints.iter().copied();
    Some(blend_poses(base, &target.pose, joints, percent / 100.0))
}

fn apply(session: &mut Session, library: &PoseLibrary, panel: &PosePanel, id: PoseId) {
    let Some(base) = session.shown_local_pose() else {
        return;
    };
    if let Some(pose) = blended(session, library, panel, id, &base, 100.0) {
        session.apply_pose(&step_name("Apply", library, id), pose);
    }
}

fn step_name(verb: &str, library: &PoseLibrary, id: PoseId) -> String {
    let name = library.get(id).map_or("pose", |pose| pose.name.as_str());
    format!("{verb} {name}")
}
