//! Opens the window on the files given: for trying the viewer alone.

fn main() -> Result<(), posekit_viewer::WindowError> {
    let paths = std::env::args_os().skip(1).map(Into::into).collect();
    posekit_viewer::run_native(posekit_viewer::ViewerOptions {
        paths,
        ..Default::default()
    })
}
