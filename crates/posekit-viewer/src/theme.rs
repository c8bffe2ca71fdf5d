//! The window's look: colours, type and spacing, light and dark, in one place.

use egui::{
    Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Vec2,
};

use crate::state::display::Look;

/// Space between things that belong together, points. All other spaces are multiples of it.
pub const GAP: f32 = 4.0;

/// Height of rows and buttons.
pub const ROW: f32 = 24.0;

/// Height of what a finger presses.
pub const FINGER: f32 = 36.0;

/// The colours of a look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Panels.
    pub panel: Color32,
    /// What lies on panels: cards, fields.
    pub raised: Color32,
    /// Wells: text fields, tracks of sliders, plots.
    pub sunken: Color32,
    /// Lines between panels.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Text of less weight.
    pub quiet: Color32,
    /// What is selected, what acts.
    pub accent: Color32,
    /// The ground under what is selected.
    pub accent_soft: Color32,
    /// Something to look at.
    pub warning: Color32,
    /// Something is wrong.
    pub error: Color32,
    /// Something went well.
    pub good: Color32,
    /// A pointer over a row.
    pub hover: Color32,
}

/// Colours of curves, apart from each other in both looks: X, Y, Z and three more.
pub const CURVES: [Color32; 6] = [
    Color32::from_rgb(0xD9, 0x58, 0x4F),
    Color32::from_rgb(0x4E, 0xA2, 0x5A),
    Color32::from_rgb(0x4B, 0x86, 0xDB),
    Color32::from_rgb(0xD6, 0x9A, 0x2D),
    Color32::from_rgb(0x9A, 0x6F, 0xC9),
    Color32::from_rgb(0x2F, 0xA3, 0xA0),
];

const LIGHT: Palette = Palette {
    panel: Color32::from_rgb(0xF7, 0xF8, 0xFA),
    raised: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    sunken: Color32::from_rgb(0xEB, 0xEE, 0xF2),
    line: Color32::from_rgb(0xDC, 0xE1, 0xE7),
    text: Color32::from_rgb(0x23, 0x2A, 0x34),
    quiet: Color32::from_rgb(0x66, 0x70, 0x7E),
    accent: Color32::from_rgb(0x25, 0x67, 0xC9),
    accent_soft: Color32::from_rgb(0xDC, 0xE8, 0xF9),
    warning: Color32::from_rgb(0xB3, 0x72, 0x0B),
    error: Color32::from_rgb(0xC6, 0x3A, 0x32),
    good: Color32::from_rgb(0x2E, 0x86, 0x4C),
    hover: Color32::from_rgb(0xE7, 0xEB, 0xF0),
};

const DARK: Palette = Palette {
    panel: Color32::from_rgb(0x1B, 0x1E, 0x24),
    raised: Color32::from_rgb(0x26, 0x2A, 0x32),
    sunken: Color32::from_rgb(0x14, 0x16, 0x1B),
    line: Color32::from_rgb(0x2E, 0x33, 0x3C),
    text: Color32::from_rgb(0xDD, 0xE2, 0xE9),
    quiet: Color32::from_rgb(0x90, 0x99, 0xA7),
    accent: Color32::from_rgb(0x6B, 0xA4, 0xF2),
    accent_soft: Color32::from_rgb(0x2A, 0x3C, 0x57),
    warning: Color32::from_rgb(0xE0, 0xA5, 0x45),
    error: Color32::from_rgb(0xEC, 0x74, 0x6A),
    good: Color32::from_rgb(0x6C, 0xBE, 0x82),
    hover: Color32::from_rgb(0x2A, 0x2F, 0x38),
};

impl Palette {
    /// The colours of a look.
    #[must_use]
    pub const fn of(look: Look) -> Self {
        match look {
            Look::Light => LIGHT,
            Look::Dark => DARK,
        }
    }

    /// The colours that a piece of the window is drawn in.
    #[must_use]
    pub fn in_ui(ui: &egui::Ui) -> Self {
        Self::of(if ui.visuals().dark_mode {
            Look::Dark
        } else {
            Look::Light
        })
    }
}

/// Gives a window its look. Both are set, so that no system setting shines through.
pub fn install(ctx: &egui::Context, look: Look) {
    ctx.set_style_of(egui::Theme::Light, style(Look::Light));
    ctx.set_style_of(egui::Theme::Dark, style(Look::Dark));
    choose(ctx, look);
}

/// Changes between light and dark.
pub fn choose(ctx: &egui::Context, look: Look) {
    ctx.set_theme(match look {
        Look::Light => egui::ThemePreference::Light,
        Look::Dark => egui::ThemePreference::Dark,
    });
}

/// The whole style of a look.
#[must_use]
pub fn style(look: Look) -> Style {
    let palette = Palette::of(look);
    let mut style = Style {
        visuals: match look {
            Look::Light => egui::Visuals::light(),
            Look::Dark => egui::Visuals::dark(),
        },
        ..Style::default()
    };
    let proportional = |size| FontId::new(size, FontFamily::Proportional);
    style.text_styles = [
        (TextStyle::Small, proportional(11.5)),
        (TextStyle::Body, proportional(13.5)),
        (TextStyle::Button, proportional(13.5)),
        (TextStyle::Heading, proportional(16.0)),
        (
            TextStyle::Monospace,
            FontId::new(12.5, FontFamily::Monospace),
        ),
    ]
    .into();
    set_spacing(&mut style);
    set_visuals(&mut style.visuals, &palette);
    style.interaction.tooltip_delay = 0.45;
    style.interaction.selectable_labels = false;
    style
}

fn set_spacing(style: &mut Style) {
    let spacing = &mut style.spacing;
    spacing.item_spacing = Vec2::new(2.0 * GAP, 1.5 * GAP);
    spacing.button_padding = Vec2::new(2.0 * GAP, GAP);
    spacing.interact_size = Vec2::new(ROW, ROW);
    spacing.menu_margin = Margin::same(8);
    spacing.window_margin = Margin::same(16);
    spacing.slider_rail_height = 4.0;
    spacing.slider_width = 120.0;
    spacing.indent = 14.0;
    spacing.icon_width = 16.0;
    spacing.icon_width_inner = 9.0;
    spacing.scroll = egui::style::ScrollStyle::thin();
    spacing.tooltip_width = 340.0;
    // A list of a dozen lines is seen whole where the window has the room.
    spacing.combo_height = 360.0;
}

/// Gives what is pressed a height.
pub fn set_row(style: &mut Style, row: f32) {
    style.spacing.interact_size = Vec2::splat(row);
    // As much as the text leaves of it.
    style.spacing.button_padding.y = GAP + (row - ROW) / 2.0;
}

fn set_visuals(visuals: &mut egui::Visuals, palette: &Palette) {
    let radius = CornerRadius::same(5);
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.raised;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(8);
    let shade = if visuals.dark_mode { 120 } else { 38 };
    let shadow = Shadow {
        offset: [0, 6],
        blur: 22,
        spread: 0,
        color: Color32::from_black_alpha(shade),
    };
    visuals.window_shadow = shadow;
    visuals.popup_shadow = shadow;
    visuals.extreme_bg_color = palette.sunken;
    visuals.text_edit_bg_color = Some(palette.sunken);
    visuals.faint_bg_color = palette.hover;
    visuals.code_bg_color = palette.sunken;
    visuals.hyperlink_color = palette.accent;
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.error;
    visuals.weak_text_color = Some(palette.quiet);
    visuals.selection.bg_fill = palette.accent_soft;
    visuals.selection.stroke = Stroke::new(1.0, palette.accent);
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = egui::style::HandleShape::Circle;
    visuals.indent_has_left_vline = false;
    visuals.striped = false;
    let widgets = &mut visuals.widgets;
    for (widget, fill, edge) in [
        (&mut widgets.noninteractive, palette.panel, palette.line),
        (&mut widgets.inactive, palette.sunken, Color32::TRANSPARENT),
        (&mut widgets.hovered, palette.hover, palette.line),
        (&mut widgets.active, palette.accent_soft, palette.accent),
        (&mut widgets.open, palette.hover, palette.line),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.bg_stroke = Stroke::new(1.0, edge);
        widget.fg_stroke = Stroke::new(1.2, palette.text);
        widget.corner_radius = radius;
        widget.expansion = 0.0;
    }
    widgets.inactive.bg_fill = if visuals.dark_mode {
        palette.line
    } else {
        palette.sunken
    };
    widgets.noninteractive.fg_stroke.color = palette.text;
}
