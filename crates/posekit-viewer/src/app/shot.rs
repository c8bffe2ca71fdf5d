//! The cameras of the active clip's scene, as the export is offered them.

use super::Viewer;
use crate::panels::export::ExportWindow;
use crate::work::export::{ExportCamera, ExportOptions};

impl Viewer {
    /// The names of the cameras of the active clip's scene.
    pub(super) fn camera_names(&self) -> Vec<String> {
        let scene = self.session.authored().map(|authored| authored.scene());
        let cameras = scene.map_or(&[][..], |scene| &scene.cameras);
        let named = cameras.iter().enumerate().map(|(index, camera)| {
            if camera.name.is_empty() {
                format!("Camera {}", index + 1)
            } else {
                camera.name.clone()
            }
        });
        named.collect()
    }

    /// The options that the export starts with: a shot is taken by its camera, the one that is looked
    /// through before others.
    pub(super) fn first_export_options(&self) -> ExportOptions {
        let count = self.camera_names().len();
        let looked_through = self.session.looks_through();
        let camera = match (looked_through, self.export_options.camera) {
            (Some(index), _) => ExportCamera::Scene(index),
            (None, ExportCamera::Scene(index)) if index < count => ExportCamera::Scene(index),
            (None, _) if count > 0 => ExportCamera::Scene(0),
            (None, _) => ExportCamera::View,
        };
        ExportOptions {
            camera,
            ..self.export_options
        }
    }

    /// The frame of the camera that is looked through is that of the video.
    pub(super) fn follow_export_size(&mut self) {
        if let ExportWindow::Choosing(options) = &self.export {
            let (width, height) = options.size.pixels();
            self.session.set_frame_aspect(width as f32 / height as f32);
        }
    }
}
