//! Below the view: which of the tables is shown, and it.

use egui::{Frame, Margin, Panel, Ui};

use super::super::row;
use super::{LabPanel, Table, formula, jacobian, matrices};
use crate::icons::{Icon, sized_icon};
use crate::state::arm::ArmLab;
use crate::state::arm::factors::Detail;
use crate::theme::{GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut ArmLab, panel: &mut LabPanel) {
    let ground = Frame::NONE.fill(ui.visuals().panel_fill);
    let is_planar = lab.bench().is_some_and(|bench| bench.planar().is_some());
    let table = shown(panel.table, is_planar);
    let below = Panel::bottom(egui::Id::unique(("lab table", table == Table::Closed)))
        .frame(ground.inner_margin(Margin::symmetric(10, 5)));
    let below = if table == Table::Closed {
        let height = ui.spacing().interact_size.y + 12.0;
        below.resizable(false).exact_size(height)
    } else {
        below
            .resizable(true)
            .default_size(246.0)
            .size_range(130.0..=460.0)
    };
    below.show(ui, |ui| {
        choice(ui, panel, table, is_planar);
        ui.add_space(GAP);
        match table {
            Table::Formula => formula::show(ui, lab),
            Table::Matrices => matrices::show(ui, lab, panel.detail),
            Table::Jacobian => jacobian::show(ui, lab),
            Table::Closed => {}
        }
    });
}

/// What is shown where only planar arms have a formula.
fn shown(table: Table, is_planar: bool) -> Table {
    match table {
        Table::Formula if !is_planar => Table::Matrices,
        table => table,
    }
}

fn choice(ui: &mut Ui, panel: &mut LabPanel, table: Table, is_planar: bool) {
    let groups: [row::Group<(&mut LabPanel, Table, bool)>; 2] = [
        |ui, room, (panel, table, is_planar)| {
            // The eye closes the table, and has its place beside what it closes.
            ui.spacing_mut().item_spacing.x = 2.0 * GAP;
            eye(ui, panel, *table);
            tables(ui, room - 40.0, panel, (*table, *is_planar));
        },
        |ui, room, (panel, table, _)| about(ui, room, panel, *table),
    ];
    row::lines(ui, &mut (panel, table, is_planar), &groups);
}

fn eye(ui: &mut Ui, panel: &mut LabPanel, table: Table) {
    let is_closed = table == Table::Closed;
    let (icon, tip) = if is_closed {
        (Icon::EyeOff, "Show the numbers")
    } else {
        (Icon::Eye, "Hide the numbers: more room for the view")
    };
    if sized_icon(ui, icon, tip, false, egui::vec2(24.0, 24.0)).clicked() {
        panel.table = if is_closed {
            Table::Formula
        } else {
            Table::Closed
        };
    }
}

fn tables(ui: &mut Ui, room: f32, panel: &mut LabPanel, (table, is_planar): (Table, bool)) {
    let offered: Vec<(Table, &str, &str)> = [
        (
            Table::Formula,
            "Formula",
            "Where the tip is, and how its angles are found, with the numbers filled in",
        ),
        (
            Table::Matrices,
            "Matrices",
            "The map from the tip to the world, factor by factor",
        ),
        (
            Table::Jacobian,
            "Jacobian",
            "How the tip moves and turns for each joint",
        ),
    ]
    .into_iter()
    .filter(|(option, ..)| *option != Table::Formula || is_planar)
    .collect();
    let options: Vec<(&str, &str)> = offered
        .iter()
        .map(|(_, name, says)| (*name, *says))
        .collect();
    let now = offered.iter().position(|(option, ..)| *option == table);
    if let Some(index) = row::one_of(ui, "table", room, now, &options) {
        panel.table = offered[index].0;
    }
}

/// What is set of a table, and what its numbers are.
fn about(ui: &mut Ui, room: f32, panel: &mut LabPanel, table: Table) {
    if table == Table::Matrices {
        let mut steps = panel.detail == Detail::Steps;
        ui.checkbox(&mut steps, "every step")
            .on_hover_text("One matrix for each translation and each turn, not for each joint");
        panel.detail = if steps { Detail::Steps } else { Detail::Joints };
    }
    let says = match table {
        Table::Formula => "Metres in the arm's plane, from its first axis",
        Table::Matrices => {
            "Homogeneous 4 x 4, metres; the last product is the tip's frame in the world"
        }
        Table::Jacobian => "World axes; metres or radians for one unit of each value",
        Table::Closed => "",
    };
    // It is read where it fits into the line.
    const OTHERS: f32 = 350.0;
    let palette = Palette::in_ui(ui);
    let font = egui::TextStyle::Small.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(says.to_owned(), font, palette.quiet);
    if !says.is_empty() && galley.size().x + OTHERS <= room {
        ui.label(galley);
    }
}
