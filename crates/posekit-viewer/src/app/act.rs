//! What is done about what is asked.

use std::path::PathBuf;

use posekit_render::cpu::CpuRenderer;
use posekit_render::image::Image;

use super::Viewer;
use crate::command::{self, Command};
use crate::load::{Input, Purpose};
use crate::panels::Request;
use crate::panels::export::ExportWindow;
use crate::panels::sides::Side;
use crate::picture::painter::thread_count;
use crate::picture::to_color_image;
use crate::state::clip::Source;
use crate::state::mode::Mode;
use crate::state::notices::NoticeKind;
use crate::state::session::ClipId;
use crate::theme;
#[cfg(not(target_arch = "wasm32"))]
use crate::work::dialog::Wanted;
use crate::work::export::Take;
use crate::work::files;

/// Size of a picture that is copied or saved.
const PICTURE_SIZE: (u32, u32) = (1920, 1080);

impl Viewer {
    /// Does what a command says.
    pub(super) fn run(&mut self, ctx: &egui::Context, command: Command) {
        if self.run_in_lab(ctx, command) || self.run_in_interpolation(ctx, command) {
            return;
        }
        if self.run_in_animate(ctx, command) {
            return;
        }
        if command == Command::Mode(Mode::Animate) && !self.has_room_below {
            // What it begins with, and its timeline, are where the side is.
            (self.layout.left, self.layout.right) = (false, false);
        }
        if command::apply(command, &mut self.session) {
            if command == Command::ToggleLook {
                theme::choose(ctx, self.session.look());
            }
            return;
        }
        match command {
            Command::ToggleLeft => self.sides.toggle(Side::Left, &mut self.layout),
            Command::ToggleRight => self.sides.toggle(Side::Right, &mut self.layout),
            Command::ToggleCurves => self.layout.curves = !self.layout.curves,
            Command::ToggleText => self.layout.text = !self.layout.text,
            Command::ToggleHelp => self.help_open = !self.help_open,
            Command::ShowMessages => self.messages_open = true,
            Command::Open => self.ask_for_files(),
            Command::OpenFolder => self.ask_for_folder(),
            Command::CopyPicture => self.copy_picture(ctx),
            Command::SavePicture => self.save_picture(ctx),
            Command::SaveRange => self.save_range(ctx),
            Command::ExportVideo => self.open_export(),
            _ => {}
        }
    }

    /// Does what a request says.
    pub(super) fn serve(&mut self, ctx: &egui::Context, request: Request) {
        match request {
            Request::Activate(id) => self.session.activate(id),
            Request::SetShown(id, shown) => self.session.set_shown(id, shown),
            Request::Close(id) => self.close_or_ask(id),
            Request::OpenPath(path, beside) => {
                let input = Input::Path(path);
                if beside {
                    self.loader.read(input, Purpose::Beside);
                } else {
                    self.open_inputs(vec![input]);
                }
            }
            Request::ShowText(id) => {
                self.session.activate(id);
                self.layout.text = true;
            }
            Request::ShowTextOf(path) => {
                self.open_inputs(vec![Input::Path(path)]);
                self.layout.text = true;
            }
            // In a window it is a file of this machine already.
            #[cfg(not(target_arch = "wasm32"))]
            Request::Download(_) => {}
            #[cfg(target_arch = "wasm32")]
            Request::Download(address) => {
                crate::web::download_address(self.loader.outbox(), &address)
            }
            Request::CloseFolder => {
                self.loader.forget_folder();
                self.library.clear();
            }
            Request::ShowFinding(index) => {
                let finding = self
                    .session
                    .active_clip()
                    .and_then(|clip| clip.findings.get(index).cloned());
                if let Some(finding) = finding {
                    self.session.show_finding(&finding);
                }
            }
            Request::Reload(id) => self.reload(ctx, id),
            Request::Author(start) => self.start_authoring(ctx, start),
            #[cfg(not(target_arch = "wasm32"))]
            Request::AskInWindow(asks) => self.dialogs.asks_in_window = asks,
        }
    }

    pub(super) fn close(&mut self, id: ClipId) {
        // Nobody waits for the rest of a clip that was closed.
        for job in self.loader.jobs() {
            if self.beginnings.get(&job.id) == Some(&id) {
                job.progress.cancel();
            }
        }
        self.session.close(id);
        self.pictures.remove(&id);
        self.checking.remove(&id);
        self.notices.answer(id);
        self.watch_files();
    }

    fn reload(&mut self, _ctx: &egui::Context, id: ClipId) {
        self.notices.answer(id);
        let open = self.session.clips().iter().find(|open| open.id == id);
        if let Some(Source::File(path)) = open.map(|open| open.clip.source.clone()) {
            self.loader.read(Input::Path(path), Purpose::Replace(id));
        }
    }

    pub(super) fn ask_for_files(&mut self) {
        #[cfg(not(target_arch = "wasm32"))]
        self.ask_for(Wanted::Files);
        #[cfg(target_arch = "wasm32")]
        crate::web::ask_for_files(self.loader.outbox());
    }

    fn ask_for_folder(&mut self) {
        #[cfg(not(target_arch = "wasm32"))]
        self.ask_for(Wanted::Folder);
    }

    pub(super) fn hand_over(&mut self, ctx: &egui::Context, parcel: Result<files::Parcel, String>) {
        match parcel {
            #[cfg(not(target_arch = "wasm32"))]
            Ok(parcel) => self.ask_for(Wanted::File(parcel)),
            #[cfg(target_arch = "wasm32")]
            Ok(parcel) => crate::web::hand_over(self.loader.outbox(), &parcel),
            Err(message) => {
                self.notices
                    .add(NoticeKind::Failure, message, ctx.input(|i| i.time));
            }
        }
    }

    /// The scene as it is shown, drawn on the CPU: the same picture on every machine.
    #[must_use]
    pub fn picture(&self) -> Image {
        let (width, height) = PICTURE_SIZE;
        CpuRenderer::new(thread_count()).render(&self.seen(), width, height)
    }

    fn copy_picture(&mut self, ctx: &egui::Context) {
        ctx.copy_image(to_color_image(&self.picture()));
        self.notices.add(
            NoticeKind::Done,
            "The picture was copied",
            ctx.input(|i| i.time),
        );
    }

    fn save_picture(&mut self, ctx: &egui::Context) {
        let Some(clip) = self.session.active_clip() else {
            return;
        };
        let frame = self.session.transport.frame();
        let parcel = files::picture_parcel(&self.picture(), &clip.name, frame);
        self.hand_over(ctx, parcel);
    }

    fn save_range(&mut self, ctx: &egui::Context) {
        let Some(clip) = self.session.active_clip() else {
            return;
        };
        let parcel = files::range_parcel(clip, self.session.transport.range());
        self.hand_over(ctx, parcel);
    }

    fn open_export(&mut self) {
        if self.session.active_clip().is_some() {
            self.export = ExportWindow::Choosing(self.first_export_options());
        }
    }

    /// The options are chosen: asks for the file's name. A page starts at once: its browser knows
    /// where files go.
    pub(super) fn ask_where_to_export(&mut self) {
        let ExportWindow::Choosing(options) = &self.export else {
            return;
        };
        self.export_options = *options;
        self.export = ExportWindow::Closed;
        if let Some(clip) = self.session.active_clip() {
            let ending = self.export_options.format.extension();
            let name = format!("{}.{ending}", files::stem_of(&clip.name));
            #[cfg(not(target_arch = "wasm32"))]
            self.ask_for(Wanted::Video { name, ending });
            #[cfg(target_arch = "wasm32")]
            self.export_to(name.into());
        }
    }

    /// Starts making the video.
    pub fn export_to(&mut self, path: PathBuf) {
        let options = self.export_options;
        let take = Take::of(&self.session, &options);
        let outbox = self.loader.outbox();
        let running = crate::work::export::start(take, options.format, path, outbox);
        self.export = ExportWindow::Running(running);
    }
}
