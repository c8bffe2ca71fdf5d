//! The application: state, panels and work brought together.

mod act;
mod animate;
#[cfg(not(target_arch = "wasm32"))]
mod dialogs;
mod events;
mod interpolation;
mod lab;
mod layout;
mod poses;
mod saving;
mod shot;
mod status;

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use eframe::egui_wgpu::RenderState;
use egui::Ui;
use posekit_render::render::RendererChoice;

use crate::load::{Input, JobId, Listing, Loader, Purpose};
use crate::panels::Asked;
use crate::panels::arm_lab::LabPanel;
use crate::panels::curves::CurvePanel;
use crate::panels::export::ExportWindow;
use crate::panels::interpolation::InterpolationPanel;
use crate::panels::joints::JointTree;
use crate::panels::library::Preview;
use crate::panels::pose_library::PosePanel;
use crate::panels::sides::Sides;
use crate::panels::text::TextPanel;
use crate::panels::timeline::Timeline;

use crate::picture::painter::Painter;
use crate::picture::thumbnail::thumbnail;
use crate::picture::{Texture, to_color_image};
use crate::state::animate::pose_library::PoseLibrary;
use crate::state::arm::ArmLab;
use crate::state::clip::{Clip, ReadingSaid};
use crate::state::interpolation::InterpolationLab;
use crate::state::library::Library;
use crate::state::notices::{NoticeKind, Notices};
use crate::state::session::{ClipId, Session};
use crate::state::settings::{Settings, WindowLayout};
use crate::theme;
use crate::work::autosave::Autosave;
use crate::work::export::ExportOptions;
use status::Places;

pub use status::Status;

/// Under this name the settings are kept.
const SETTINGS_KEY: &str = "posekit";

/// Time that passes without the window being drawn counts at most this much: after a pause of the
/// machine the figure goes on where it was.
const LONGEST_STEP_SECS: f64 = 0.25;

/// What the viewer is started with.
#[derive(Clone, Debug, Default)]
pub struct ViewerOptions {
    /// Files and folders to open. With none, a sample clip is shown.
    pub paths: Vec<PathBuf>,
    /// Clips that are in memory already.
    pub inputs: Vec<Input>,
    /// How the numbers of files are read, where that was said.
    pub reading: ReadingSaid,
    /// What draws the view.
    pub renderer: RendererChoice,
    /// Clips that a server offers, to be listed.
    pub listing: Option<Listing>,
    /// The folder in which scenes are kept that are not saved; with none, they are not.
    pub kept_in: Option<PathBuf>,
    /// What asks for files.
    #[cfg(not(target_arch = "wasm32"))]
    pub dialogs: crate::work::dialog::SystemDialogs,
}

/// The viewer.
#[derive(Debug)]
pub struct Viewer {
    session: Session,
    lab: ArmLab,
    lab_panel: LabPanel,
    interpolation: InterpolationLab,
    interpolation_panel: InterpolationPanel,
    loader: Loader,
    reading: ReadingSaid,
    painter: Painter,
    library: Library<Preview>,
    pictures: BTreeMap<ClipId, Texture>,
    checking: BTreeSet<ClipId>,
    /// Clips of which only the first frames are here yet.
    beginnings: BTreeMap<JobId, ClipId>,
    /// Clips that were edited while they were checked.
    to_check: BTreeSet<ClipId>,
    tree: JointTree,
    curves: CurvePanel,
    text: TextPanel,
    timeline: Timeline,
    poses: PoseLibrary,
    pose_panel: PosePanel,
    /// Kept poses that could not be read.
    unreadable_poses: Option<String>,
    saving: saving::Saving,
    notices: Notices,
    layout: WindowLayout,
    /// The sides that the window shows, as it was drawn last.
    sides: Sides,
    /// Whether there is room for something below the view.
    has_room_below: bool,
    /// At the left the joints, where there is no room for them beside the clips.
    shows_joints: bool,
    /// Whether something was typed into when the window was drawn last.
    was_typing: bool,
    help_open: bool,
    help_search: String,
    messages_open: bool,
    export: ExportWindow,
    /// Options of the last export, and of one that waits for its file name.
    export_options: ExportOptions,
    /// The clips that came with others: their group, and their place in it.
    grouped: BTreeMap<ClipId, (u32, usize)>,
    next_group: u32,
    /// The group of the robot that was put on the bench last, and its place in it.
    benched: Option<(u32, usize)>,
    /// The window's clock when the clip's clock was moved last.
    last_tick_secs: Option<f64>,
    places: Places,
    /// How often the window was drawn.
    picture_count: u64,
    /// Whether the window, when it was drawn last, showed what is now.
    is_current: bool,
    /// How many files were saved.
    saved_count: u64,
    #[cfg(not(target_arch = "wasm32"))]
    watch: crate::work::watch::Watch,
    #[cfg(not(target_arch = "wasm32"))]
    dialogs: dialogs::Dialogs,
}

impl Viewer {
    /// A viewer in a window of egui. `graphics` is the window's device, if it has one.
    #[must_use]
    pub fn new(
        ctx: &egui::Context,
        graphics: Option<&RenderState>,
        settings: &Settings,
        options: ViewerOptions,
    ) -> Self {
        theme::install(ctx, settings.look);
        let loader = Loader::new(ctx);
        #[cfg(not(target_arch = "wasm32"))]
        let watch = crate::work::watch::Watch::new(loader.outbox().clone());
        #[cfg(not(target_arch = "wasm32"))]
        let autosave = match &options.kept_in {
            Some(folder) => Autosave::in_folder(folder),
            None => Autosave::none(),
        };
        #[cfg(target_arch = "wasm32")]
        let autosave = Autosave::in_storage();
        let mut session = Session::new(settings.display.clone(), settings.look);
        session.transport.at_end = settings.at_end;
        let mut viewer = Self {
            session,
            lab: ArmLab::default(),
            lab_panel: LabPanel::default(),
            interpolation: InterpolationLab::default(),
            interpolation_panel: InterpolationPanel::default(),
            loader,
            reading: options.reading,
            painter: Painter::new(ctx, graphics, options.renderer),
            library: Library::default(),
            pictures: BTreeMap::new(),
            checking: BTreeSet::new(),
            beginnings: BTreeMap::new(),
            to_check: BTreeSet::new(),
            tree: JointTree::default(),
            curves: CurvePanel::default(),
            text: TextPanel::default(),
            timeline: Timeline::default(),
            poses: PoseLibrary::default(),
            pose_panel: PosePanel::default(),
            unreadable_poses: None,
            saving: saving::Saving::new(autosave),
            notices: Notices::default(),
            layout: settings.layout,
            sides: Sides::default(),
            has_room_below: true,
            shows_joints: false,
            was_typing: false,
            help_open: false,
            help_search: String::new(),
            messages_open: false,
            export: ExportWindow::Closed,
            export_options: ExportOptions::default(),
            grouped: BTreeMap::new(),
            next_group: 0,
            benched: None,
            last_tick_secs: None,
            places: Places::default(),
            picture_count: 0,
            is_current: false,
            saved_count: 0,
            #[cfg(not(target_arch = "wasm32"))]
            watch,
            #[cfg(not(target_arch = "wasm32"))]
            dialogs: dialogs::Dialogs::new(
                options.dialogs,
                settings.asks_in_window,
                settings.files_in.clone(),
            ),
        };
        viewer.start(ctx, options);
        #[cfg(not(target_arch = "wasm32"))]
        if let (None, Some(folder)) = (&viewer.library.folder, &settings.folder)
            && folder.is_dir()
        {
            viewer.list_folder(ctx, folder.clone());
        }
        viewer
    }

    /// The viewer of an eframe window, with what it remembers.
    #[must_use]
    pub fn of_window(context: &eframe::CreationContext<'_>, mut options: ViewerOptions) -> Self {
        #[cfg(not(target_arch = "wasm32"))]
        {
            let data = eframe::storage_dir("posekit");
            options.kept_in = options.kept_in.or(data.map(|data| data.join("unsaved")));
        }
        #[cfg(target_arch = "wasm32")]
        let _no_folder = &mut options;
        let kept = context
            .storage
            .and_then(|storage| eframe::get_value(storage, SETTINGS_KEY));
        #[cfg(not(target_arch = "wasm32"))]
        let settings: Settings = kept.unwrap_or_default();
        #[cfg(target_arch = "wasm32")]
        let settings: Settings = kept.unwrap_or_else(crate::web::first_settings);
        let graphics = context.wgpu_render_state.as_ref();
        let mut viewer = Self::new(&context.egui_ctx, graphics, &settings, options);
        if let Some(storage) = context.storage {
            viewer.take_kept_poses(storage);
        }
        viewer
    }

    fn start(&mut self, ctx: &egui::Context, options: ViewerOptions) {
        let mut inputs = options.inputs;
        if let Some(listing) = options.listing {
            self.take_listing(listing);
        }
        for path in options.paths {
            if path.is_dir() {
                self.list_folder(ctx, path);
            } else {
                // One file has one path, also where the folder lists it.
                inputs.push(Input::Path(crate::state::animate::place::absolute(&path)));
            }
        }
        if inputs.is_empty() {
            let first = self.library.entries.first().map(|entry| entry.path.clone());
            match first {
                Some(path) => inputs.push(Input::Path(path)),
                None => self.open_sample(ctx),
            }
        }
        self.open_inputs(inputs);
    }

    fn open_sample(&mut self, ctx: &egui::Context) {
        if let Some(clip) = Clip::of_sample("Sample walk", "walk") {
            let picture = to_color_image(&thumbnail(&clip));
            let id = self.session.open(clip);
            self.opened(ctx, id, picture);
        }
    }

    /// Starts reading clips: the first that is read is opened, the others join it in the order given.
    pub fn open_inputs(&mut self, inputs: Vec<Input>) {
        let group = self.new_group();
        for (rank, input) in crate::load::together(inputs).into_iter().enumerate() {
            self.loader.read(input, Purpose::Group { group, rank });
        }
    }

    fn new_group(&mut self) -> u32 {
        self.next_group += 1;
        self.next_group - 1
    }

    /// The session, to look at.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The session, to change.
    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    /// The timeline, to look at.
    #[must_use]
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// The timeline, to change.
    pub fn timeline_mut(&mut self) -> &mut Timeline {
        &mut self.timeline
    }

    /// The arm lab, to look at.
    #[must_use]
    pub fn lab(&self) -> &ArmLab {
        &self.lab
    }

    /// The arm lab, to change.
    pub fn lab_mut(&mut self) -> &mut ArmLab {
        &mut self.lab
    }

    /// The interpolation lab, to look at.
    #[must_use]
    pub fn interpolation(&self) -> &InterpolationLab {
        &self.interpolation
    }

    /// The interpolation lab, to change.
    pub fn interpolation_mut(&mut self) -> &mut InterpolationLab {
        &mut self.interpolation
    }

    /// Whether something is being read, checked or looked at.
    #[must_use]
    pub fn is_working(&self) -> bool {
        !self.loader.jobs().is_empty()
            || !self.checking.is_empty()
            || self.loader.is_looking()
            || self.timeline.is_waiting()
            || self.text.is_waiting()
    }

    /// Whether the window shows what is now, nothing being drawn and nothing asked for since.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.is_current && !self.painter.is_busy()
    }

    /// The messages that are shown.
    #[must_use]
    pub fn notices(&self) -> &Notices {
        &self.notices
    }

    /// The parts of the window that are open.
    #[must_use]
    pub fn layout(&self) -> WindowLayout {
        self.layout
    }

    /// What is to be remembered.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings {
            look: self.session.look(),
            display: self.session.display().clone(),
            at_end: self.session.transport.at_end,
            layout: self.layout,
            folder: self.library.folder.clone(),
            #[cfg(not(target_arch = "wasm32"))]
            files_in: self.dialogs.folder.clone(),
            #[cfg(not(target_arch = "wasm32"))]
            asks_in_window: self.dialogs.asks_in_window,
            #[cfg(target_arch = "wasm32")]
            files_in: None,
            #[cfg(target_arch = "wasm32")]
            asks_in_window: false,
        }
    }

    /// Shows everything, in all of `ui`, and does what is asked.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.take_events(&ctx);
        self.take_dropped(&ctx);
        self.watch_closing(&ctx);
        self.tick(&ctx);
        self.session.follow_changes();
        let mut asked = Asked {
            curves_open: self.layout.curves,
            #[cfg(not(target_arch = "wasm32"))]
            asks_in_window: self.dialogs.asks_in_window,
            ..Asked::default()
        };
        self.take_keys(ui, &mut asked);
        self.show_panels(ui, &mut asked);
        let answered = self.show_windows(&ctx, &mut asked);
        self.was_typing = ctx.text_edit_focused();
        self.picture_count += 1;
        self.is_current = !answered && asked.is_empty() && self.is_view_current();
        for request in std::mem::take(&mut asked.requests) {
            self.serve(&ctx, request);
        }
        for command in std::mem::take(&mut asked.commands) {
            self.run(&ctx, command);
            // What it has done is seen in the next picture, whatever else happens.
            ctx.request_repaint();
        }
        // What is dragged is checked when it is let go.
        if !ctx.input(|i| i.pointer.any_down()) {
            self.check_edited();
        }
        self.keep_scenes(&ctx);
        self.plan_repaint(&ctx);
    }

    /// Whether the view's picture is of the stage as it is now. The bench is never changed after it
    /// was drawn.
    fn is_view_current(&self) -> bool {
        self.session.mode().is_lab() || self.painter.shows_now(&self.session)
    }

    /// Checks the clips again that were edited.
    fn check_edited(&mut self) {
        self.to_check.extend(self.session.take_changed());
        if self.session.is_dragging() {
            return;
        }
        let free = |id: &ClipId| !self.checking.contains(id);
        for id in self
            .to_check
            .clone()
            .into_iter()
            .filter(free)
            .collect::<Vec<_>>()
        {
            self.to_check.remove(&id);
            let open = self.session.clips().iter().find(|open| open.id == id);
            if let Some(clip) = open.map(|open| open.clip.clone()) {
                self.checking.insert(id);
                self.loader.check(id, clip);
            }
        }
    }

    /// Moves the clip's clock by what passed since the last time.
    fn tick(&mut self, ctx: &egui::Context) {
        let now = ctx.input(|i| i.time);
        if self.session.transport.is_playing() || self.plays_in_interpolation() {
            let passed = self.last_tick_secs.map_or(0.0, |before| now - before);
            let passed = passed.min(LONGEST_STEP_SECS);
            self.session.transport.advance(passed);
            if self.plays_in_interpolation() {
                self.tick_interpolation(passed);
            }
            self.last_tick_secs = Some(now);
        } else {
            self.last_tick_secs = None;
        }
    }

    /// The window is drawn again only when there is something new to see.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "seconds until a notice goes; a fraction of them is enough"
    )]
    fn plan_repaint(&mut self, ctx: &egui::Context) {
        let now = ctx.input(|i| i.time);
        for text in self.session.take_told() {
            self.notices.add(NoticeKind::Done, text, now);
            ctx.request_repaint();
        }
        let plays = self.session.transport.is_playing() || self.plays_in_interpolation();
        if plays && !self.painter.is_busy() {
            ctx.request_repaint();
        }
        if let Some(secs) = self.notices.tick(ctx.input(|i| i.time)) {
            ctx.request_repaint_after_secs(secs.max(0.01) as f32);
        }
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        layout::clear_color(visuals)
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, SETTINGS_KEY, &self.settings());
        self.keep_poses(storage);
    }
}
