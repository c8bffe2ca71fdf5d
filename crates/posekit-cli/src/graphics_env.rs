//! What graphics libraries find in their environment.
//!
//! Mesa's Vulkan layer that picks a default device (`VK_LAYER_MESA_device_select`, on by itself wherever Mesa is
//! installed) asks a Wayland compositor which one that is, and libwayland writes `error: XDG_RUNTIME_DIR is invalid
//! or not set in the environment.` to standard error where that variable is missing, each time it is asked: over
//! ssh, in containers, in cron jobs. wgpu 30 enables the surface extensions that wake the layer even where nothing
//! is shown. There is nobody to ask then, so the layer is told to stay out.

use std::env;
use std::ffi::OsStr;
use std::path::Path;

/// Switches the layer off; its own name for that, see its manifest.
const LAYER_OFF: &str = "NODEVICE_SELECT";
/// By these a user has chosen a device, which the layer then has to see to.
const CHOICES: [&str; 2] = ["MESA_VK_DEVICE_SELECT", "DRI_PRIME"];

/// Begins the program again with the layer switched off, where it would complain; otherwise, and where the program
/// cannot be begun again, returns.
///
/// A process cannot change its own environment without unsafe code, since other threads may be reading it; the next
/// program in its place can be given another one. To be called before anything was read or written.
pub(crate) fn keep_quiet() {
    let is_set = |name: &str| env::var_os(name).is_some();
    let runtime_dir = env::var_os("XDG_RUNTIME_DIR");
    if would_complain(runtime_dir.as_deref())
        && !is_set(LAYER_OFF)
        && !CHOICES.into_iter().any(is_set)
    {
        begin_again();
    }
}

/// libwayland's own condition.
fn would_complain(runtime_dir: Option<&OsStr>) -> bool {
    !runtime_dir.is_some_and(|folder| Path::new(folder).is_absolute())
}

#[cfg(target_os = "linux")]
fn begin_again() {
    use std::os::unix::process::CommandExt;
    let Ok(program) = env::current_exe() else {
        return;
    };
    let mut arguments = env::args_os();
    let name = arguments.next().unwrap_or_else(|| program.clone().into());
    // Returns only when it failed: then the line stays, and nothing else is lost.
    let _failed = std::process::Command::new(program)
        .arg0(name)
        .args(arguments)
        .env(LAYER_OFF, "1")
        .exec();
}

#[cfg(not(target_os = "linux"))]
fn begin_again() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_complains_where_the_folder_is_missing_or_not_absolute() {
        assert!(would_complain(None));
        assert!(would_complain(Some(OsStr::new(""))));
        assert!(would_complain(Some(OsStr::new("run/user/1000"))));
        assert!(!would_complain(Some(OsStr::new("/run/user/1000"))));
    }
}
