//! Scenes and their files: saved, asked about before they are closed, recovered after a fall.

use std::path::PathBuf;

use egui::ViewportCommand;
use posekit_formats::scene;

use super::Viewer;
use crate::load::{Input, Purpose};
use crate::panels::unsaved::{Answer, ask_to_recover, ask_to_save};
#[cfg(not(target_arch = "wasm32"))]
use crate::state::animate::place;
#[cfg(not(target_arch = "wasm32"))]
use crate::state::chooser::with_ending;
use crate::state::clip::Source;
#[cfg(not(target_arch = "wasm32"))]
use crate::state::notices::NoticeKind;
use crate::state::session::ClipId;
use crate::work::autosave::Kept;
#[cfg(not(target_arch = "wasm32"))]
use crate::work::dialog::Wanted;
use crate::work::files;

/// What is about to be closed and not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Closing {
    /// A clip.
    Clip(ClipId),
    /// The window.
    Window,
}

/// All of the window that is about files of scenes.
#[derive(Debug)]
pub(super) struct Saving {
    pub(super) autosave: crate::work::autosave::Autosave,
    /// What an earlier run has left, while it is asked about.
    left: Vec<Kept>,
    /// What an earlier run has left, while it is opened again.
    opening: Vec<Kept>,
    /// What is asked about.
    closing: Option<Closing>,
    /// What is closed as soon as it is saved.
    after_saving: Option<Closing>,
    /// The window's title as it was told last.
    title: String,
}

impl Saving {
    pub(super) fn new(autosave: crate::work::autosave::Autosave) -> Self {
        Self {
            left: autosave.left(),
            opening: Vec::new(),
            autosave,
            closing: None,
            after_saving: None,
            title: String::new(),
        }
    }

    /// Whether a question is over everything.
    pub(super) fn is_asking(&self) -> bool {
        self.closing.is_some() || !self.left.is_empty()
    }
}

impl Viewer {
    /// Whether a question about unsaved scenes is over everything.
    #[must_use]
    pub fn is_asking(&self) -> bool {
        self.saving.is_asking()
    }

    /// Saves the active clip's scene: into its file, or, `elsewhere` and where it has none, into one
    /// that is asked for.
    pub(super) fn save_scene(&mut self, ctx: &egui::Context, elsewhere: bool) {
        if let Some(id) = self.session.active_id() {
            self.save_scene_of(ctx, id, elsewhere);
        }
    }

    fn save_scene_of(&mut self, ctx: &egui::Context, id: ClipId, elsewhere: bool) {
        let Some(authored) = self.session.authored_of(id) else {
            return;
        };
        match authored.path().filter(|_| !elsewhere) {
            Some(path) => {
                let path = path.to_owned();
                self.save_scene_to(ctx, id, path);
            }
            None => self.ask_where_to_save(ctx, id),
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn ask_where_to_save(&mut self, _ctx: &egui::Context, clip: ClipId) {
        let name = self.scene_name(clip);
        self.ask_for(Wanted::Scene { clip, name });
    }

    /// A page's browser knows where files go.
    #[cfg(target_arch = "wasm32")]
    fn ask_where_to_save(&mut self, ctx: &egui::Context, id: ClipId) {
        let name = self.scene_name(id);
        let Some(authored) = self.session.authored_of(id) else {
            return;
        };
        let bytes = match scene::write(authored.scene()) {
            Ok(bytes) => bytes,
            Err(error) => return self.hand_over(ctx, Err(format!("not saved: {error}"))),
        };
        let parcel = files::Parcel {
            name: name.clone(),
            kind: "posekit scene",
            extension: "toml",
            bytes: bytes.into(),
        };
        self.hand_over(ctx, Ok(parcel));
        self.session
            .author_clip(id, |authored| authored.set_saved(None));
        self.session.rename(id, name, Source::Scene(None));
    }

    /// What the file of a clip's scene would be called.
    pub(super) fn scene_name(&self, id: ClipId) -> String {
        let open = self.session.clips().iter().find(|open| open.id == id);
        let name = open.map_or("scene", |open| open.clip.name.as_str());
        let ending = format!(".{}", scene::EXTENSION);
        let stem = name.strip_suffix(&ending).unwrap_or(name);
        format!("{}{ending}", files::stem_of(stem))
    }

    /// Saves a clip's scene into a file. What is there stays whole where that fails.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn save_scene_to(&mut self, ctx: &egui::Context, id: ClipId, path: PathBuf) {
        let now = ctx.input(|i| i.time);
        let path = place::absolute(&with_ending(path, &[scene::EXTENSION]));
        match self.write_scene(id, &path) {
            Ok(()) => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let source = Source::Scene(Some(path.clone()));
                self.session.rename(id, name.into_owned(), source);
                let saved = Some(path.clone());
                self.session
                    .author_clip(id, |authored| authored.set_saved(saved));
                let text = format!("Saved {}", path.display());
                self.notices.add(NoticeKind::Done, text, now);
                self.close_what_is_saved(ctx);
            }
            Err(why) => {
                self.saving.after_saving = None;
                let text = format!("{}: {why}", path.display());
                self.notices.add(NoticeKind::Failure, text, now);
            }
        }
    }

    #[cfg(target_arch = "wasm32")]
    fn save_scene_to(&mut self, _ctx: &egui::Context, _id: ClipId, _path: PathBuf) {
        // A page's scenes have no path.
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn write_scene(&self, id: ClipId, path: &std::path::Path) -> Result<(), String> {
        use std::io::Write as _;
        let authored = self.session.authored_of(id).ok_or("it is closed")?;
        let folder = path.parent().unwrap_or(std::path::Path::new("/"));
        let bytes = scene::write(&place::written(authored.scene(), folder))
            .map_err(|error| format!("not saved: {error}"))?;
        // Nothing takes the place of a good file that could not be opened again.
        scene::read(&bytes).map_err(|error| format!("not saved: {error}"))?;
        let written: std::io::Result<()> = files::write_beside(path, |file| file.write_all(&bytes));
        written.map_err(|error| format!("not saved: {}", posekit_formats::system::in_words(&error)))
    }

    /// A scene was read: one that was left by an earlier run is kept as this one's from now on.
    pub(super) fn adopt_kept(&mut self, id: ClipId) {
        let open = self.session.clips().iter().find(|open| open.id == id);
        let (Some(open), Some(authored)) = (open, self.session.authored_of(id)) else {
            return;
        };
        let opening = &mut self.saving.opening;
        let is_it =
            |kept: &Kept| kept.name == open.clip.name && kept.path.as_deref() == authored.path();
        if authored.is_dirty()
            && let Some(index) = opening.iter().position(is_it)
        {
            let kept = opening.remove(index);
            self.saving.autosave.adopt(&kept, &self.session, id);
        }
    }

    /// No place for a scene was chosen: what was to be closed after it was saved stays open.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn give_up_saving(&mut self) {
        self.saving.after_saving = None;
    }

    /// Whether something is closed as soon as it is saved.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn closes_after_saving(&self) -> bool {
        self.saving.after_saving.is_some()
    }

    /// Closes a clip, or asks first where something of it is in no file.
    pub(super) fn close_or_ask(&mut self, id: ClipId) {
        let authored = self.session.authored_of(id);
        if authored.is_some_and(|authored| authored.is_dirty()) {
            self.saving.closing = Some(Closing::Clip(id));
        } else {
            self.close(id);
        }
    }

    fn dirty(&self, closing: Closing) -> Vec<(ClipId, String)> {
        let clips = self.session.clips().iter();
        let meant = clips.filter(|open| match closing {
            Closing::Clip(id) => open.id == id,
            Closing::Window => true,
        });
        let is_dirty = |id| self.session.authored_of(id).is_some_and(|a| a.is_dirty());
        meant
            .filter(|open| is_dirty(open.id))
            .map(|open| (open.id, open.clip.name.clone()))
            .collect()
    }

    /// The window is about to be closed: where something is in no file that is asked about first.
    pub(super) fn watch_closing(&mut self, ctx: &egui::Context) {
        if !ctx.input(|i| i.viewport().close_requested()) || self.dirty(Closing::Window).is_empty()
        {
            return;
        }
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        // What else was asked for is forgotten: one question at a time.
        #[cfg(not(target_arch = "wasm32"))]
        self.dialogs.close();
        self.saving.after_saving = None;
        self.saving.closing = Some(Closing::Window);
    }

    /// Shows the questions, and does what is answered.
    pub(super) fn show_questions(&mut self, ctx: &egui::Context) {
        if let Some(closing) = self.saving.closing {
            let dirty = self.dirty(closing);
            let names: Vec<String> = dirty.iter().map(|(_, name)| name.clone()).collect();
            match ask_to_save(ctx, &names) {
                Answer::None => {}
                Answer::Later => self.saving.closing = None,
                Answer::No => {
                    self.saving.closing = None;
                    self.let_go(ctx, closing);
                }
                Answer::Yes => {
                    self.saving.closing = None;
                    self.saving.after_saving = Some(closing);
                    for (id, _) in dirty {
                        self.save_scene_of(ctx, id, false);
                    }
                    self.close_what_is_saved(ctx);
                }
            }
        } else if !self.saving.left.is_empty() {
            let left = &self.saving.left;
            let names: Vec<String> = left.iter().map(|kept| kept.name.clone()).collect();
            match ask_to_recover(ctx, &names) {
                Answer::None => {}
                Answer::Later => self.saving.left.clear(),
                Answer::No => {
                    for kept in std::mem::take(&mut self.saving.left) {
                        self.saving.autosave.discard(&kept);
                    }
                }
                Answer::Yes => {
                    for kept in std::mem::take(&mut self.saving.left) {
                        #[cfg(target_arch = "wasm32")]
                        let kept = self.with_addresses(kept);
                        let input = Input::Kept(Box::new(kept.clone()));
                        self.saving.opening.push(kept);
                        let group = self.new_group();
                        self.loader.read(input, Purpose::Group { group, rank: 0 });
                    }
                }
            }
        }
    }

    /// With where the server has the files that it names, which are known by their names alone.
    #[cfg(target_arch = "wasm32")]
    fn with_addresses(&self, mut kept: Kept) -> Kept {
        let entries = &self.library.entries;
        let address_of = |file: &String| {
            let found = entries.iter().find(|entry| entry.name == *file);
            found.map(|entry| entry.path.clone())
        };
        kept.addresses = kept.files().iter().filter_map(address_of).collect();
        kept
    }

    /// Closes without saving.
    fn let_go(&mut self, ctx: &egui::Context, closing: Closing) {
        match closing {
            Closing::Clip(id) => self.close(id),
            Closing::Window => {
                for (id, _) in self.dirty(closing) {
                    self.close(id);
                }
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// What was to be closed after it is saved, once that is so.
    fn close_what_is_saved(&mut self, ctx: &egui::Context) {
        if let Some(closing) = self.saving.after_saving
            && self.dirty(closing).is_empty()
        {
            self.saving.after_saving = None;
            self.let_go(ctx, closing);
        }
    }

    /// Keeps what is not saved aside, and says in the title what is open.
    pub(super) fn keep_scenes(&mut self, ctx: &egui::Context) {
        let now = ctx.input(|i| i.time);
        if let Some(secs) = self.saving.autosave.tick(&self.session, now) {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(secs.max(0.05)));
        }
        let title = self.title();
        if title != self.saving.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.saving.title = title;
        }
        #[cfg(target_arch = "wasm32")]
        crate::web::ask_before_leaving(!self.dirty(Closing::Window).is_empty());
    }

    /// The window's title: the scene that is open, with a mark while it is not saved.
    #[must_use]
    pub fn title(&self) -> String {
        let name = self.session.active_clip().map(|clip| clip.name.as_str());
        match (self.session.authored(), name) {
            (Some(authored), Some(name)) => {
                let mark = if authored.is_dirty() { "* " } else { "" };
                format!("{mark}{name} \u{2013} posekit")
            }
            _ => "posekit".to_owned(),
        }
    }
}
