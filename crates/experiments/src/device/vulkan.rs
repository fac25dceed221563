//! What of Vulkan a machine has, what it lacks, and by which variables its graphics processor is found.
//!
//! A container often has NVIDIA's driver without the loader, without the manifest that the loader reads, or
//! with one in a folder that it does not read. Each of these is tried in turn, by a process of its own that
//! opens the adapter; the first that finds a graphics processor is what all parts run with.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;
use harness::output::write_json;
use harness::record::{Adapter, Processor};
use metaball_core::gpu::{AdapterChoice, Gpu};
use picture_files::write_atomically;
use serde::{Deserialize, Serialize};

use super::process::{Job, LOG, run_job};
use super::{adapter_arguments, nvidia};
use crate::unfinished;

/// What there is, and what there is not.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Vulkan {
    /// The adapter that was found.
    pub adapter: Option<Adapter>,
    /// Variables by which it is found; empty where it is found without.
    pub environment: BTreeMap<String, String>,
    /// The loader, `libvulkan.so.1`.
    pub loader: Option<PathBuf>,
    /// Manifests of drivers, and the libraries that they name.
    pub manifests: Vec<Manifest>,
    /// NVIDIA's driver, in its own words; `null` where there is none.
    pub nvidia_driver: Option<String>,
    /// What is missing, in words.
    pub missing: Vec<String>,
}

/// A driver's manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The file.
    pub path: PathBuf,
    /// The library as it names it.
    pub library: String,
    /// Where that is; `null` where it is nowhere.
    pub found: Option<PathBuf>,
}

/// Folders whose manifests the loader reads by itself.
const READ_BY_THE_LOADER: [&str; 3] =
    ["/etc/vulkan/icd.d", "/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"];

/// Folders in which containers have manifests that the loader does not read.
const NOT_READ: [&str; 2] =
    ["/usr/local/nvidia/share/vulkan/icd.d", "/opt/nvidia/share/vulkan/icd.d"];

/// Folders of libraries besides those that the system's own configuration names.
const LIBRARIES: [&str; 10] = [
    "/usr/lib/x86_64-linux-gnu",
    "/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/lib/aarch64-linux-gnu",
    "/usr/lib64",
    "/lib64",
    "/usr/lib",
    "/usr/local/lib",
    "/usr/local/nvidia/lib64",
    "/usr/local/nvidia/lib",
];

const LOADER: &str = "libvulkan.so.1";
const LIBRARY_PATH: &str = "LD_LIBRARY_PATH";
const DRIVER_FILES: &str = "VK_DRIVER_FILES";

/// What NVIDIA's Vulkan driver is in: for X, and without it.
const NVIDIA_DRIVERS: [&str; 2] = ["libGLX_nvidia.so.0", "libEGL_nvidia.so.0"];

/// How long an adapter may take to open.
const OPENING: Duration = Duration::from_secs(20);

impl Vulkan {
    /// Looks around, then opens the adapter in one way after the other.
    ///
    /// # Errors
    /// When a file cannot be written into the folder.
    pub(super) fn open(out: &Path, choice: &AdapterChoice) -> anyhow::Result<Self> {
        let mut vulkan = Self::look();
        for environment in vulkan.ways(out)? {
            let adapter = adapter_with(&environment, choice, &out.join("adapter"))?;
            let is_gpu = |adapter: &Adapter| adapter.processor == Some(Processor::Gpu);
            if let Some(adapter) = adapter
                && (vulkan.adapter.is_none() || is_gpu(&adapter))
            {
                let is_found = is_gpu(&adapter);
                vulkan.adapter = Some(adapter);
                vulkan.environment = environment;
                if is_found {
                    break;
                }
            }
        }
        vulkan.note_what_was_found(&out.join("adapter"));
        Ok(vulkan)
    }

    /// Says what was found instead of a graphics processor where there should be one, or any adapter.
    fn note_what_was_found(&mut self, folder: &Path) {
        let driver = self.nvidia_driver.as_deref();
        match (&self.adapter, driver) {
            (Some(adapter), Some(driver)) if adapter.processor != Some(Processor::Gpu) => {
                let note =
                    format!("adapter: needed a graphics processor of {driver}, found {adapter}");
                self.missing.push(note);
            }
            (None, _) => {
                let log = fs::read_to_string(folder.join(LOG)).unwrap_or_default();
                let said = log.lines().next().unwrap_or("nothing").to_owned();
                self.missing.push(format!("adapter: needed one, found {said}"));
            }
            _ => {}
        }
    }

    fn look() -> Self {
        let folders = library_folders();
        let manifests: Vec<_> = manifest_files()
            .into_iter()
            .filter_map(|path| Manifest::read(path, &folders))
            .collect();
        let nvidia_driver = nvidia_driver();
        let loader = find_library(LOADER, &folders);
        let missing = missing(loader.as_ref(), &manifests, nvidia_driver.is_some(), &folders);
        Self { loader, manifests, nvidia_driver, missing, ..Self::default() }
    }

    /// Environments to try: as it is; then, where there is an NVIDIA driver, with each manifest that the
    /// loader does not read, and with one of our own for each library that it may be in.
    fn ways(&self, out: &Path) -> anyhow::Result<Vec<BTreeMap<String, String>>> {
        let base = match (&self.loader, packed_loader()) {
            (None, Some(folder)) => with_library_folder(&folder),
            _ => BTreeMap::new(),
        };
        let mut ways = vec![base.clone()];
        if self.nvidia_driver.is_none() {
            return Ok(ways);
        }
        let mut add = |manifest: &Path, library: &Path| {
            let mut way = base.clone();
            way.insert(DRIVER_FILES.to_owned(), manifest.display().to_string());
            if let Some(folder) = library.parent().filter(|folder| !base_folder(folder)) {
                let before = way.remove(LIBRARY_PATH).or_else(|| env::var(LIBRARY_PATH).ok());
                let folder = folder.display().to_string();
                let all = before.map_or(folder.clone(), |before| format!("{before}:{folder}"));
                way.insert(LIBRARY_PATH.to_owned(), all);
            }
            ways.push(way);
        };
        let is_unread =
            |manifest: &&Manifest| NOT_READ.iter().any(|folder| manifest.path.starts_with(folder));
        for manifest in self.manifests.iter().filter(is_unread) {
            if let Some(library) = &manifest.found {
                add(&manifest.path, library);
            }
        }
        for name in NVIDIA_DRIVERS {
            if let Some(library) = find_library(name, &library_folders()) {
                add(&write_manifest(out, name, &library)?, &library);
            }
        }
        Ok(ways)
    }
}

/// What there is to see of NVIDIA's driver: of the kernel's, of the device, or of the tool.
fn nvidia_driver() -> Option<String> {
    let version = fs::read_to_string("/proc/driver/nvidia/version").ok();
    let device = "/dev/nvidia0";
    version
        .and_then(|text| text.lines().next().map(str::to_owned))
        .or_else(|| Path::new(device).exists().then(|| device.to_owned()))
        .or_else(nvidia::describe)
}

/// Opens the adapter in a process with these variables.
fn adapter_with(
    environment: &BTreeMap<String, String>,
    choice: &AdapterChoice,
    folder: &Path,
) -> anyhow::Result<Option<Adapter>> {
    let mut arguments: Vec<_> = ["device", "--part", "adapter"].map(str::to_owned).into();
    arguments.extend(adapter_arguments(choice));
    arguments.extend(["--out".to_owned(), folder.display().to_string()]);
    run_job(&Job { arguments, environment: environment.clone(), allowed: OPENING }, folder)?;
    Ok(unfinished::read(&folder.join(ADAPTER)))
}

const ADAPTER: &str = "adapter.json";

/// Writes which adapter was opened: what [`Vulkan::open`] reads.
pub(super) fn write_adapter(gpu: &Gpu, out: &Path) -> anyhow::Result<()> {
    write_json(&out.join(ADAPTER), &Adapter::of(Some(gpu)))
}

impl Manifest {
    /// `None` for a file that is no manifest.
    fn read(path: PathBuf, folders: &[PathBuf]) -> Option<Self> {
        let json: serde_json::Value = unfinished::read(&path)?;
        let library = json["ICD"]["library_path"].as_str()?.to_owned();
        let found = if library.contains('/') {
            let file = path.parent().map_or_else(|| library.clone().into(), |at| at.join(&library));
            file.exists().then_some(file)
        } else {
            find_library(&library, folders)
        };
        Some(Self { path, library, found })
    }
}

/// The manifests in all folders, and those that the environment names.
fn manifest_files() -> Vec<PathBuf> {
    let named = [DRIVER_FILES, "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"];
    let named = named.iter().filter_map(|name| env::var(name).ok());
    let mut files: Vec<PathBuf> =
        named.flat_map(|list| list.split(':').map(PathBuf::from).collect::<Vec<_>>()).collect();
    for folder in READ_BY_THE_LOADER.iter().chain(&NOT_READ) {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut found: Vec<_> = entries.map(|entry| entry.path()).collect();
        found.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
        found.sort();
        files.extend(found);
    }
    files
}

/// Where libraries are: by the environment, by the system's configuration, and by custom.
fn library_folders() -> Vec<PathBuf> {
    let listed = env::var(LIBRARY_PATH).unwrap_or_default();
    let configured = fs::read_dir("/etc/ld.so.conf.d").into_iter().flatten().flatten();
    let configured = configured.filter_map(|entry| fs::read_to_string(entry.path()).ok());
    let lines: Vec<String> = configured
        .flat_map(|text| text.lines().map(|line| line.trim().to_owned()).collect::<Vec<_>>())
        .filter(|line| line.starts_with('/'))
        .collect();
    let listed = listed.split(':').filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let customary = LIBRARIES.iter().map(PathBuf::from);
    listed.chain(lines.into_iter().map(PathBuf::from)).chain(customary).collect()
}

fn find_library(name: &str, folders: &[PathBuf]) -> Option<PathBuf> {
    folders.iter().map(|folder| folder.join(name)).find(|path| path.exists())
}

/// Whether the system looks for libraries there by itself, as far as is known.
fn base_folder(folder: &Path) -> bool {
    LIBRARIES[..7].iter().any(|known| folder == Path::new(known))
}

/// The folder beside this program in which an archive of `cargo xtask device --pack` has the loader.
fn packed_loader() -> Option<PathBuf> {
    let folder = env::current_exe().ok()?.parent()?.join("lib");
    folder.join(LOADER).exists().then_some(folder)
}

fn with_library_folder(folder: &Path) -> BTreeMap<String, String> {
    let before = env::var(LIBRARY_PATH).map(|before| format!("{before}:")).unwrap_or_default();
    BTreeMap::from([(LIBRARY_PATH.to_owned(), format!("{before}{}", folder.display()))])
}

/// A manifest of our own for a driver that has none.
fn write_manifest(out: &Path, name: &str, library: &Path) -> anyhow::Result<PathBuf> {
    let path = out.join(format!("{name}.json"));
    let json = serde_json::json!({
        "file_format_version": "1.0.0",
        "ICD": {"library_path": library, "api_version": "1.3.0"},
    });
    write_atomically(&path, json.to_string().as_bytes()).context("a driver's manifest")?;
    Ok(path)
}

/// What is not there, and what it is needed for.
fn missing(
    loader: Option<&PathBuf>,
    manifests: &[Manifest],
    has_nvidia: bool,
    folders: &[PathBuf],
) -> Vec<String> {
    let mut missing = Vec::new();
    if loader.is_none() {
        missing.push(format!("{LOADER}: needed Vulkan's loader, found none"));
    }
    if manifests.is_empty() {
        let read = READ_BY_THE_LOADER.join(", ");
        missing.push(format!("driver's manifest: needed a .json in {read}, found none"));
    }
    for manifest in manifests.iter().filter(|manifest| manifest.found.is_none()) {
        let Manifest { path, library, .. } = manifest;
        missing.push(format!("{}: needed the library {library}, found none", path.display()));
    }
    let lacks = |name: &str| find_library(name, folders).is_none();
    if has_nvidia && NVIDIA_DRIVERS.iter().all(|name| lacks(name)) {
        missing.push(format!(
            "{}: needed NVIDIA's Vulkan driver (of a container, with `graphics` in \
             NVIDIA_DRIVER_CAPABILITIES), found none",
            NVIDIA_DRIVERS[0]
        ));
    }
    if has_nvidia {
        for name in ["libX11.so.6", "libXext.so.6"].into_iter().filter(|name| lacks(name)) {
            missing.push(format!("{name}: {} may need it, found none", NVIDIA_DRIVERS[0]));
        }
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named() {
        let none = missing(None, &[], true, &[]);
        let text = none.join("\n");
        for name in ["libvulkan.so.1", "icd.d", "libGLX_nvidia.so.0", "libX11.so.6"] {
            assert!(text.contains(name), "{name} in {text}");
        }

        let folder = tempfile::tempdir().expect("a folder");
        let folders = [folder.path().to_owned()];
        for library in NVIDIA_DRIVERS.iter().chain(&["libX11.so.6", "libXext.so.6", LOADER]) {
            fs::write(folder.path().join(library), "").expect("written");
        }
        let written = write_manifest(folder.path(), "own", &folder.path().join(NVIDIA_DRIVERS[0]));
        let manifest = Manifest::read(written.expect("written"), &folders).expect("a manifest");
        assert!(manifest.found.is_some());
        let loader = find_library(LOADER, &folders);
        let mut manifests = [manifest];
        assert_eq!(missing(loader.as_ref(), &manifests, true, &folders), [""; 0]);

        manifests[0].found = None;
        let text = missing(loader.as_ref(), &manifests, true, &folders).join("\n");
        assert!(text.contains("own.json: needed the library"), "{text}");
        assert_eq!(Manifest::read(folder.path().join(LOADER), &folders), None);
    }
}
