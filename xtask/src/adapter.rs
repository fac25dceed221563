//! What pictures by an adapter need beyond Rust: one, real or in software.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::packages::install;
use crate::run::say;

/// Mesa's software driver, and what loads it.
const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

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
    if !install("No Vulkan driver was found", &PACKAGES)? {
        say(HOW_TO_INSTALL);
        return Ok(Adapter::Missing);
    }
    if driver_exists() {
        Ok(Adapter::Found)
    } else {
        Err("apt-get installed mesa-vulkan-drivers, but no driver file appeared".to_owned())
    }
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
    loader().is_some()
}

/// Vulkan's loader, of this machine.
pub(crate) fn loader() -> Option<PathBuf> {
    let listed = Command::new("ldconfig").arg("-p").output();
    match listed {
        Ok(output) if output.status.success() => {
            let text = String::from_utf8_lossy(&output.stdout);
            let line = text.lines().find(|line| line.contains(LOADER))?;
            Some(PathBuf::from(line.split("=> ").nth(1)?))
        }
        // Systems without glibc's cache.
        _ => ["/usr/lib", "/usr/lib64", "/usr/local/lib"]
            .into_iter()
            .map(|folder| Path::new(folder).join(LOADER))
            .find(|file| file.exists()),
    }
}

const LOADER: &str = "libvulkan.so.1";
