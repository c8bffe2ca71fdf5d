//! What comes in: clips that were read, files that were dropped, answers of dialogs.

use std::path::PathBuf;

use egui::ColorImage;
use posekit::figure::UpAxis;

use super::Viewer;
#[cfg(not(target_arch = "wasm32"))]
use crate::load::Input;
use crate::load::{Chosen, Event, Listing, Purpose, Summary};
use crate::panels::library::Preview;
use crate::picture::Texture;
use crate::state::animate::Authored;
use crate::state::clip::{Clip, ReadingSaid};
use crate::state::library::EntryState;
use crate::state::notices::NoticeKind;
use crate::state::session::ClipId;

impl Viewer {
    /// Takes in what was done away from the window.
    pub(super) fn take_events(&mut self, ctx: &egui::Context) {
        let now = ctx.input(|i| i.time);
        for event in self.loader.take_events() {
            match event {
                Event::Begun {
                    job,
                    purpose,
                    clip,
                    thumbnail,
                } => {
                    let id = self.take_in(purpose, *clip);
                    self.pictures.insert(id, Texture::new(ctx, *thumbnail));
                    self.beginnings.insert(job, id);
                }
                Event::GivenUp { job, message } => {
                    if let Some(id) = self.beginnings.remove(&job) {
                        self.close(id);
                    }
                    if let Some(message) = message {
                        self.notices.add(NoticeKind::Failure, message, now);
                    }
                }
                Event::Read {
                    job,
                    purpose,
                    clip,
                    authored,
                    thumbnail,
                } => {
                    let begun = self.beginnings.remove(&job).map(Purpose::Replace);
                    let purpose = begun.unwrap_or(purpose);
                    let read = (*clip, authored.map(|authored| *authored));
                    self.take_clip(ctx, purpose, read, *thumbnail);
                }
                Event::Poses { name, poses } => self.take_poses(&name, poses, now),
                Event::Robot { purpose, robot } => self.take_robot(purpose, *robot, now),
                Event::FilledIn(filled) => {
                    self.interpolation.clip.take(filled.map(|filled| *filled))
                }
                Event::Failed { message } => {
                    self.notices.add(NoticeKind::Failure, message, now);
                }
                Event::Written { message } => {
                    self.saved_count += 1;
                    self.notices.add(NoticeKind::Done, message, now);
                }
                Event::Checked { clip, findings } => {
                    self.checking.remove(&clip);
                    self.session.set_findings(clip, findings);
                }
                Event::Authored { clip, started } => self.take_authored(clip, *started, now),
                Event::Changed { clip } => self.tell_changed(clip, now),
                Event::Chosen(chosen) => self.take_chosen(chosen),
                #[cfg(not(target_arch = "wasm32"))]
                Event::Answered { wanted, answer } => {
                    self.take_system_answer(ctx, *wanted, answer);
                }
                Event::Summary(summary) => self.take_summary(ctx, *summary),
                Event::FolderDone => {}
                Event::Text(text) => self.text.take(text),
            }
        }
    }

    fn take_clip(
        &mut self,
        ctx: &egui::Context,
        purpose: Purpose,
        (clip, authored): (Clip, Option<Authored>),
        thumbnail: ColorImage,
    ) {
        let repaired = clip.report.first_repair().map(ToString::to_string);
        let name = clip.name.clone();
        let is_authored = authored.is_some();
        let id = self.take_in(purpose, clip);
        if let Some(authored) = authored {
            self.session.put_authored(id, authored);
            self.adopt_kept(id);
        }
        self.opened(ctx, id, thumbnail);
        if !is_authored && self.reading.up.is_none() {
            self.tell_stood(ctx, id);
        }
        if let Some(repaired) = repaired {
            let text = format!("{name} was repaired while it was read: {repaired}");
            let now = ctx.input(|i| i.time);
            self.notices.add(NoticeKind::Done, text, now);
        }
    }

    /// Says that a figure was stood on another axis than its file's Y.
    fn tell_stood(&mut self, ctx: &egui::Context, id: ClipId) {
        let Some(clip) = self
            .session
            .clip(id)
            .filter(|clip| clip.reading.up != UpAxis::Y)
        else {
            return;
        };
        let (name, up) = (&clip.name, clip.reading.up);
        let text =
            format!("{name}: {up} is up, judging by the rest pose; change it in the inspector");
        self.notices
            .add(NoticeKind::Done, text, ctx.input(|i| i.time));
    }

    fn take_in(&mut self, purpose: Purpose, clip: Clip) -> ClipId {
        // A file that is read again is read as it was.
        let clip = match purpose {
            Purpose::Replace(id) => {
                let before = self.session.clip(id).map(|clip| clip.reading);
                let said = before.map_or(self.reading, |reading| ReadingSaid {
                    positions: Some(reading.positions),
                    up: Some(reading.up),
                });
                said.apply(clip)
            }
            Purpose::Group { .. } | Purpose::Beside => self.reading.apply(clip),
        };
        match purpose {
            Purpose::Group { group, rank } => self.take_into_group(clip, group, rank),
            Purpose::Beside => self.session.open_beside(clip),
            Purpose::Replace(id) => {
                self.session.replace(id, clip);
                id
            }
        }
    }

    /// Files are read at the same time, and the last may be there first: clips stand in the order in which
    /// they were given, and the first of them is the active one.
    fn take_into_group(&mut self, clip: Clip, group: u32, rank: usize) -> ClipId {
        let session = &mut self.session;
        let is_open = |id: &ClipId| session.clip(*id).is_some();
        self.grouped.retain(|id, _| is_open(id));
        let others = self.grouped.iter().filter(|(_, place)| place.0 == group);
        let after = others
            .clone()
            .filter(|(_, place)| place.1 > rank)
            .min_by_key(|(_, place)| place.1);
        let after = after.map(|(id, _)| *id);
        let active = session.active_id();
        let precedes_active = others
            .clone()
            .any(|(id, place)| Some(*id) == active && place.1 > rank);
        let id = if others.count() == 0 {
            session.open(clip)
        } else {
            session.open_beside(clip)
        };
        if let Some(after) = after {
            session.move_before(id, after);
        }
        if precedes_active {
            session.activate_among(id);
        }
        self.grouped.insert(id, (group, rank));
        id
    }

    /// What follows when a clip was opened or read again.
    pub(super) fn opened(&mut self, ctx: &egui::Context, id: ClipId, thumbnail: ColorImage) {
        self.tell_doubt(id, ctx.input(|i| i.time));
        let picture = Texture::new(ctx, thumbnail);
        self.pictures.insert(id, picture);
        let open = self.session.clips().iter().find(|open| open.id == id);
        if let Some(clip) = open.map(|open| open.clip.clone()) {
            self.checking.insert(id);
            self.loader.check(id, clip);
        }
        self.watch_files();
    }

    /// Watches the files of the clips that are open now.
    pub(super) fn watch_files(&self) {
        #[cfg(not(target_arch = "wasm32"))]
        self.watch.set(&self.session);
    }

    /// Says why a figure is drawn as bones although bodies are shown.
    fn tell_doubt(&mut self, clip: ClipId, now: f64) {
        let open = self.session.clips().iter().find(|open| open.id == clip);
        let doubt = open.and_then(|open| Some((&open.clip.name, open.doubt()?)));
        if let Some((name, why)) = doubt {
            let text = format!("{name} is drawn as bones, not as a body: {why}");
            self.notices.add(NoticeKind::Done, text, now);
        }
    }

    fn tell_changed(&mut self, clip: ClipId, now: f64) {
        let open = self.session.clips().iter().find(|open| open.id == clip);
        if let Some(open) = open {
            let text = format!("{} has changed on disk", open.clip.name);
            self.notices.add(NoticeKind::Changed(clip), text, now);
        }
    }

    fn take_chosen(&mut self, chosen: Chosen) {
        match chosen {
            Chosen::Inputs(inputs) => self.open_inputs(inputs),
            Chosen::Beside(inputs) => {
                for input in inputs {
                    self.loader.read(input, Purpose::Beside);
                }
            }
        }
    }

    fn take_summary(&mut self, ctx: &egui::Context, summary: Summary) {
        let state = match summary.outcome {
            Ok(numbers) => {
                let thumbnail = numbers.thumbnail.clone();
                let picture = Texture::new(ctx, thumbnail);
                EntryState::Ready(Preview { numbers, picture })
            }
            Err(why) => EntryState::Refused(why),
        };
        self.library.set_state(&summary.path, state);
    }

    /// Lists a server's clips in the library.
    pub(super) fn take_listing(&mut self, listing: Listing) {
        let files = listing.clips.iter().map(|(file, _)| file.clone()).collect();
        let named = listing.clips.into_iter();
        let named = named.map(|(file, name)| (file.path, name)).collect();
        self.library.list_named(listing.folder.into(), named);
        self.library.shortage = listing.shortage;
        self.loader.look_at(files);
    }

    /// Lists a folder's clips in the library.
    pub(super) fn list_folder(&mut self, ctx: &egui::Context, folder: PathBuf) {
        #[cfg(not(target_arch = "wasm32"))]
        {
            let now = ctx.input(|i| i.time);
            // It is remembered for a start from another place, and has a name even where it was given as a dot.
            let folder = crate::state::animate::place::absolute(&folder);
            match crate::state::library::motion_files(&folder) {
                Ok(paths) if paths.is_empty() => {
                    let text = format!("There are no BVH files or scenes in {}", folder.display());
                    self.notices.add(NoticeKind::Failure, text, now);
                }
                Ok(paths) => {
                    self.library.list(folder, paths);
                    let entries = self.library.entries.iter();
                    let files = entries.map(|entry| entry.path.clone().into()).collect();
                    self.loader.look_at(files);
                }
                Err(error) => {
                    let text = format!(
                        "{}: {}",
                        folder.display(),
                        posekit_formats::system::in_words(&error)
                    );
                    self.notices.add(NoticeKind::Failure, text, now);
                }
            }
        }
        #[cfg(target_arch = "wasm32")]
        {
            // A page sees no folders; it gets files by drop, dialog and address.
            drop((ctx, folder));
        }
    }

    /// Takes what was dropped onto the window.
    pub(super) fn take_dropped(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input_mut(|i| std::mem::take(&mut i.raw.dropped_files));
        if dropped.is_empty() {
            return;
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            let mut inputs = Vec::new();
            for file in dropped {
                let path = file.path().to_owned();
                if path.is_dir() {
                    self.list_folder(ctx, path);
                } else {
                    inputs.push(Input::Path(path));
                }
            }
            self.open_inputs(inputs);
        }
        #[cfg(target_arch = "wasm32")]
        self.open_inputs(crate::web::dropped_inputs(&dropped));
    }
}
