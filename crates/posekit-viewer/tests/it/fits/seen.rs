//! What a picture of the window is made of: the texts and grounds that were painted, layer by layer, and the
//! widgets.

use std::cell::RefCell;
use std::rc::Rc;

use egui::epaint::{ClippedShape, RectShape, Shape, TextShape};
use egui::{Context, LayerId, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;
use posekit_viewer::state::display::Look;
use posekit_viewer::state::settings::Settings;
use posekit_viewer::work::dialog::{Answer, SystemDialogs};
use posekit_viewer::{Viewer, ViewerOptions};

use super::super::window::{Window, until};
use posekit_viewer::load::Input;

/// What is painted with less than this of its colour lets through what lies under it.
const COVERS: u8 = 200;

/// A line of text.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) text: String,
    /// Where its letters are.
    pub(super) ink: Rect,
    /// What is seen of the window where it was painted.
    pub(super) clip: Rect,
    /// It ends in an ellipsis where its room ends.
    pub(super) is_elided: bool,
}

impl Line {
    /// What is seen of it.
    pub(super) fn visible(&self) -> Rect {
        self.ink.intersect(self.clip)
    }
}

/// What was painted, in order.
#[derive(Clone, Debug)]
pub(super) enum Painted {
    Line(Line),
    /// A ground that hides what was painted before it.
    Ground(Rect),
}

/// A layer of the window.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) id: LayerId,
    pub(super) painted: Vec<Painted>,
}

/// A place that a widget has, and what is seen of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) id: u64,
    pub(super) layer: LayerId,
    pub(super) rect: Rect,
    pub(super) seen: Rect,
}

/// A widget as a screen reader is told of it.
#[derive(Clone, Debug)]
pub(super) struct Widget {
    pub(super) role: egui::Role,
    pub(super) name: String,
    pub(super) spot: Spot,
}

/// What a picture of the window is made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    pub(super) window: Option<Rect>,
    pub(super) layers: Vec<Layer>,
    spots: Vec<Spot>,
}

impl Seen {
    fn take(ctx: &Context) -> Self {
        let mut order = vec![LayerId::background()];
        order.extend(ctx.memory(|memory| memory.layer_ids().collect::<Vec<_>>()));
        order.dedup();
        let layers = order.iter().filter_map(|&id| {
            let painted = ctx.graphics(|graphics| {
                let list = graphics.get(id)?;
                let mut painted = Vec::new();
                for shape in list.all_entries() {
                    take_shape(shape, &shape.shape, &mut painted);
                }
                Some(painted)
            })?;
            Some(Layer { id, painted })
        });
        let layers = layers.collect();
        let spots = ctx.viewport(|viewport| {
            let layers = viewport.this_pass.widgets.layers();
            let spots = layers.flat_map(|(&layer, widgets)| {
                widgets.iter().map(move |widget| Spot {
                    id: widget.id.value(),
                    layer,
                    rect: widget.rect,
                    seen: widget.interact_rect,
                })
            });
            spots.collect()
        });
        Self {
            window: Some(ctx.content_rect()),
            layers,
            spots,
        }
    }

    /// The widgets that a screen reader is told of, with where they are.
    pub(super) fn widgets(&self, window: &Window) -> Vec<Widget> {
        let nodes = window.root().children_recursive();
        let widgets = nodes.filter_map(|node| {
            let node = node.accesskit_node();
            let id = node.locate().0.0;
            let spot = self.spots.iter().find(|spot| spot.id == id)?;
            let name = node.label().or_else(|| node.value()).unwrap_or_default();
            Some(Widget {
                role: node.role(),
                name,
                spot: *spot,
            })
        });
        widgets.collect()
    }
}

fn take_shape(clipped: &ClippedShape, shape: &Shape, painted: &mut Vec<Painted>) {
    match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                take_shape(clipped, shape, painted);
            }
        }
        Shape::Text(text) => take_text(text, clipped.clip_rect, painted),
        Shape::Rect(RectShape {
            rect,
            fill,
            blur_width,
            ..
        }) if fill.a() >= COVERS && *blur_width < 0.5 => {
            painted.push(Painted::Ground(rect.intersect(clipped.clip_rect)));
        }
        _ => {}
    }
}

fn take_text(text: &TextShape, clip: Rect, painted: &mut Vec<Painted>) {
    // Text that stands on end is measured as it stands.
    let turned = text.angle.abs() > 1e-3;
    for row in &text.galley.rows {
        let words = row.text();
        if words.trim().is_empty() {
            continue;
        }
        let ink = if turned {
            text.visual_bounding_rect()
        } else {
            let bounds = row.visuals.mesh_bounds;
            bounds.translate(row.pos.to_vec2() + text.pos.to_vec2())
        };
        painted.push(Painted::Line(Line {
            text: words,
            ink,
            clip,
            is_elided: text.galley.elided,
        }));
    }
}

fn no_dialog(_: &posekit_viewer::work::dialog::Wanted, _: Option<&std::path::Path>) -> Answer {
    Answer::NoDialog
}

/// A window that is watched.
pub(super) struct Watched {
    pub(super) window: Window,
    seen: Rc<RefCell<Seen>>,
}

impl Watched {
    /// A window of some size, in points, and so many pixels a point.
    pub(super) fn new(inputs: Vec<Input>, size: Vec2, scale: f32, look: Look) -> Self {
        let mut options = Some(ViewerOptions {
            inputs,
            dialogs: SystemDialogs::of(no_dialog),
            ..ViewerOptions::default()
        });
        let settings = Settings {
            look,
            ..Settings::default()
        };
        let seen = Rc::new(RefCell::new(Seen::default()));
        let sees = Rc::clone(&seen);
        let show = move |ui: &mut egui::Ui, viewer: &mut Option<Viewer>| {
            let viewer = viewer.get_or_insert_with(|| {
                let options = options.take().unwrap_or_default();
                Viewer::new(ui.ctx(), None, &settings, options)
            });
            viewer.show(ui);
            *sees.borrow_mut() = Seen::take(ui.ctx());
        };
        let builder = Harness::builder()
            .with_size(size)
            .with_pixels_per_point(scale);
        let builder = if super::is_drawn() {
            builder.wgpu()
        } else {
            builder
        };
        let mut window = builder.build_ui_state(show, None);
        until(&mut window, |viewer| !viewer.is_working());
        Self { window, seen }
    }

    /// What the last picture was made of.
    pub(super) fn seen(&self) -> Seen {
        self.seen.borrow().clone()
    }
}
