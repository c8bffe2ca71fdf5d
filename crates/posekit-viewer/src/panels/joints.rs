//! The joint tree.

use egui::{Rect, RichText, ScrollArea, Sense, Stroke, Ui, pos2, vec2};
use posekit::skeleton::{JointId, Skeleton};

use super::{library::search, row};
use crate::state::library::matches;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// Height of a joint's row.
const JOINT_ROW: f32 = 22.0;

/// On a screen that is touched rows are higher.
fn row_height(ui: &Ui) -> f32 {
    JOINT_ROW.max(ui.spacing().interact_size.y - 4.0)
}

/// Shift of a level of the tree.
const LEVEL: f32 = 12.0;

/// What the tree remembers: the filter and which joints are folded.
#[derive(Clone, Debug, Default)]
pub struct JointTree {
    filter: String,
    folded: std::collections::BTreeSet<JointId>,
    /// The joint that was in the tree's view last, so that a new selection is scrolled to once.
    scrolled_to: Option<JointId>,
}

/// Shows the tree of the active clip's joints. Returns the joint that is hovered.
pub fn show(ui: &mut Ui, session: &mut Session, tree: &mut JointTree) -> Option<JointId> {
    let Some(clip) = session.active_clip().cloned() else {
        row::heading(ui, "Joints", |_| {});
        row::empty_note(ui, "No clip is open.");
        return None;
    };
    let skeleton = clip.skeleton();
    let count = skeleton.joint_count();
    row::heading(ui, "Joints", |ui| {
        ui.label(
            RichText::new(count.to_string())
                .small()
                .color(Palette::in_ui(ui).quiet),
        );
    });
    search(ui, &mut tree.filter, "Filter joints");
    ui.add_space(GAP);
    let rows = visible_rows(skeleton, tree);
    let mut hovered = None;
    let target = session
        .selected()
        .filter(|joint| tree.scrolled_to != Some(*joint));
    tree.scrolled_to = session.selected();
    ui.spacing_mut().item_spacing.y = 0.0;
    let area = ScrollArea::vertical()
        .id_salt("joints")
        .min_scrolled_height(JOINT_ROW)
        .auto_shrink([false, false]);
    area.show(ui, |ui| {
        for (joint, depth) in rows {
            let size = vec2(ui.available_width(), row_height(ui));
            let place = Rect::from_min_size(ui.next_widget_position(), size);
            if target == Some(joint) {
                ui.scroll_to_rect(place, None);
            }
            if !ui.is_rect_visible(place) {
                ui.allocate_exact_size(size, Sense::hover());
                continue;
            }
            if joint_row(ui, session, skeleton, tree, joint, depth) {
                hovered = Some(joint);
            }
        }
    });
    hovered
}

/// The joints that are not folded away, each with its depth; with a filter those that pass it.
fn visible_rows(skeleton: &Skeleton, tree: &JointTree) -> Vec<(JointId, usize)> {
    let mut depths = vec![0usize; skeleton.joint_count()];
    let mut hidden = vec![false; skeleton.joint_count()];
    for joint in skeleton.joints() {
        if let Some(parent) = skeleton.parent(joint) {
            depths[joint.index()] = depths[parent.index()] + 1;
            hidden[joint.index()] = hidden[parent.index()] || tree.folded.contains(&parent);
        }
    }
    let filtered = !tree.filter.trim().is_empty();
    let order: Vec<JointId> = skeleton
        .roots()
        .flat_map(|root| skeleton.subtree(root))
        .collect();
    order
        .into_iter()
        .filter(|joint| {
            if filtered {
                matches(&tree.filter, skeleton.unique_name(*joint))
            } else {
                !hidden[joint.index()]
            }
        })
        .map(|joint| (joint, if filtered { 0 } else { depths[joint.index()] }))
        .collect()
}

/// One row. True when the pointer is over it.
fn joint_row(
    ui: &mut Ui,
    session: &mut Session,
    skeleton: &Skeleton,
    tree: &mut JointTree,
    joint: JointId,
    depth: usize,
) -> bool {
    let palette = Palette::in_ui(ui);
    let chosen = session.selection().contains(&joint);
    let name = skeleton.unique_name(joint);
    let (rect, response) = row::row(ui, row_height(ui), chosen, name);
    let depth = depth.min(16);
    let indent = (0..depth).fold(0.0, |indent, _| indent + LEVEL);
    let left = rect.left() + GAP + indent;
    let has_children = !skeleton.children(joint).is_empty() && tree.filter.trim().is_empty();
    let arrow =
        Rect::from_center_size(pos2(left + 6.0, rect.center().y), vec2(16.0, rect.height()));
    let on_arrow = has_children
        && response
            .hover_pos()
            .is_some_and(|pointer| arrow.contains(pointer));
    if has_children {
        let color = if on_arrow {
            palette.text
        } else {
            palette.quiet
        };
        paint_arrow(ui, arrow, tree.folded.contains(&joint), color);
    } else {
        ui.painter()
            .circle_filled(arrow.center(), 1.6, palette.quiet);
    }
    let text = Rect::from_min_max(pos2(left + 16.0, rect.top()), rect.right_bottom());
    let color = if skeleton.is_end_site(joint) {
        palette.quiet
    } else {
        palette.text
    };
    row::text_in(ui, text, RichText::new(name), color);
    if response.clicked() {
        if on_arrow {
            if !tree.folded.remove(&joint) {
                tree.folded.insert(joint);
            }
        } else if ui.input(|i| i.modifiers.shift || i.modifiers.command) {
            session.toggle_selected(joint);
        } else {
            session.select(Some(joint));
        }
        // It is where the pointer is: there is nothing to scroll to.
        tree.scrolled_to = session.selected();
    }
    if response.double_clicked() {
        session.frame_selected();
    }
    response.hovered()
}

fn paint_arrow(ui: &Ui, rect: Rect, folded: bool, color: egui::Color32) {
    let c = rect.center();
    let points = if folded {
        [
            c + vec2(-2.0, -4.0),
            c + vec2(2.0, 0.0),
            c + vec2(-2.0, 4.0),
        ]
    } else {
        [
            c + vec2(-4.0, -2.0),
            c + vec2(0.0, 2.0),
            c + vec2(4.0, -2.0),
        ]
    };
    ui.painter()
        .add(egui::Shape::line(points.to_vec(), Stroke::new(1.4, color)));
}
