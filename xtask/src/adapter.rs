//! The machine's one need beyond Rust: a graphics adapter, real or in software.

use std::path::Path;
use std::process::Command;

use crate::run::{say, succeeds, to_the_end};

/// Shown on a machine without a Vulkan driver.
const HOW_TO_INSTALL: &str = "\
No Vulkan driver was found. Install your graphics card's, or Mesa's software one:
  Debian, Ubuntu   sudo apt-get install mesa-vulkan-drivers libvulkan1
  Fedora           sudo dnf install mesa-vulkan-drivers vulkan-loader
  Arch             sudo pacman -S vulkan-swrast vulkan-icd-loader
  openSUSE         sudo zypper install libvulkan_lvp libvulkan1
  Alpine           sudo apk add mesa-vulkan-swrast vulkan-loader";

/// Whether there is a graphics adapter for wgpu.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Adapter {
    Found,
    Missing,
}

/// Looks for a driver; installs Mesa's software one where that is possible and allowed, and
/// otherwise says how.
pub(crate) fn ensure() -> Result<Adapter, String> {
    if driver_exists() {
        return Ok(Adapter::Found);
    }
    let Some(mut rights) = install_rights() else {
        say(HOW_TO_INSTALL);
        return Ok(Adapter::Missing);
    };
    say("No Vulkan driver was found: installing mesa-vulkan-drivers and libvulkan1 with apt-get.");
    to_the_end(rights.args(["apt-get", "update", "-qq"]))?;
    let mut install = install_rights().unwrap_or(rights);
    install.args(["apt-get", "install", "-y", "-qq", "--no-install-recommends"]);
    to_the_end(install.args(["mesa-vulkan-drivers", "libvulkan1"]))?;
    if driver_exists() {
        Ok(Adapter::Found)
    } else {
        Err("apt-get installed mesa-vulkan-drivers, but no driver file appeared".to_owned())
    }
}

/// A command prefix that may install packages here, if there is one: `env` for root, `sudo -n` for
/// a user who needs no password. Only on systems with apt-get.
fn install_rights() -> Option<Command> {
    if !succeeds("apt-get", &["--version"]) {
        return None;
    }
    let user = Command::new("id").arg("-u").output().ok()?;
    let mut rights = if user.stdout.trim_ascii() == b"0" {
        Command::new("env")
    } else if succeeds("sudo", &["-n", "true"]) {
        let mut sudo = Command::new("sudo");
        sudo.args(["-n", "env"]);
        sudo
    } else {
        return None;
    };
    rights.arg("DEBIAN_FRONTEND=noninteractive");
    Some(rights)
}

/// Metal and Direct3D come with their systems; elsewhere Vulkan needs its loader and a driver's
/// manifest.
fn driver_exists() -> bool {
    if cfg!(any(target_os = "macos", windows)) {
        return true;
    }
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"];
    let manifest = named.iter().any(|name| std::env::var_os(name).is_some())
        || ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"]
            .into_iter()
            .any(holds_a_manifest);
    manifest && loader_exists()
}

fn holds_a_manifest(folder: &str) -> bool {
    Path::new(folder).read_dir().is_ok_and(|entries| {
        entries.flatten().any(|entry| entry.path().extension().is_some_and(|end| end == "json"))
    })
}

fn loader_exists() -> bool {
    let listed = Command::new("ldconfig").arg("-p").output();
    match listed {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).contains("libvulkan.so.1")
        }
        // Systems without glibc's cache.
        _ => ["/usr/lib", "/usr/lib64", "/usr/local/lib"]
            .into_iter()
            .any(|folder| Path::new(folder).join("libvulkan.so.1").exists()),
    }
}
