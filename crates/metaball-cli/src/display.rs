//! Commands that show nothing on a display ask for none.

/// Starts the process anew, in its own place, where a layer of Mesa's Vulkan drivers would complain: wgpu
/// can draw to Wayland's displays, so the layer that puts adapters in order
/// (`VK_LAYER_MESA_device_select`) looks for one, and libwayland prints an error wherever no folder is
/// named for its sockets. wgpu cannot be told to leave displays out; the layer can, by its variable in the
/// environment of a process that begins.
#[cfg(target_os = "linux")]
pub(crate) fn leave_out() {
    use std::env::{args_os, current_exe, var_os};
    use std::os::unix::process::CommandExt;
    use std::path::Path;
    use std::process::Command;

    /// Turns the layer off; set, it also says that the process has been started anew.
    const NO_LAYER: &str = "NODEVICE_SELECT";

    let has_folder =
        var_os("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).is_absolute());
    if has_folder || var_os(NO_LAYER).is_some() {
        return;
    }
    let (Ok(program), mut arguments) = (current_exe(), args_os()) else { return };
    let mut anew = Command::new(program);
    if let Some(name) = arguments.next() {
        anew.arg0(name);
    }
    // It returns only where it failed; then there is an error too much on the terminal, and no harm.
    let _ = anew.args(arguments).env(NO_LAYER, "1").exec();
}

/// Other systems have no such layer.
#[cfg(not(target_os = "linux"))]
pub(crate) fn leave_out() {}
