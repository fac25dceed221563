//! A run of the program in a temporary folder.

use std::fs;
use std::process::Command;

use anyhow::Context;
use image::{ImageBuffer, Rgb};
use metaball_core::View;
use tempfile::TempDir;

use super::PROGRAM;

const SCENE_FILE: &str = "scene.pov";
const PICTURE_FILE: &str = "picture.png";

/// A scene's file in a temporary folder that goes with it, and how it is drawn.
#[derive(Debug)]
pub(super) struct Job {
    size: (u32, u32),
    threads: usize,
    folder: TempDir,
}

impl Job {
    /// Writes the scene's file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub(super) fn new(scene: &str, view: &View, threads: usize) -> anyhow::Result<Self> {
        let folder = TempDir::new().context("cannot make a temporary folder")?;
        fs::write(folder.path().join(SCENE_FILE), scene)
            .context("cannot write POV-Ray's scene to the temporary folder")?;
        Ok(Self { size: (view.width(), view.height()), threads, folder })
    }

    /// Runs the program in the folder, where it may write whatever its configuration forbids, and
    /// returns its output. `declared` are numbers that the scene asks for.
    pub(super) fn draw(&self, declared: &[&str]) -> anyhow::Result<String> {
        let mut command = Command::new(PROGRAM);
        command.current_dir(self.folder.path());
        command.args([format!("+I{SCENE_FILE}"), format!("+O{PICTURE_FILE}")]);
        command.args([format!("+W{}", self.size.0), format!("+H{}", self.size.1)]);
        command.arg(format!("+WT{}", self.threads));
        // 16 bits a channel and linear; no antialiasing, window, progress or pause.
        command.args(["+FN16", "File_Gamma=1.0", "Dither=off", "-A", "-D", "-V", "-P"]);
        command.args(declared.iter().map(|name| format!("Declare={name}=1")));
        let output = command.output().with_context(|| format!("cannot run {PROGRAM}"))?;
        let log = String::from_utf8_lossy(&output.stderr).into_owned();
        anyhow::ensure!(
            output.status.success(),
            "{PROGRAM} ended with {}: {}",
            output.status,
            complaint(&log)
        );
        Ok(log)
    }

    /// What was drawn last.
    pub(super) fn picture(&self) -> anyhow::Result<ImageBuffer<Rgb<u16>, Vec<u16>>> {
        let picture = image::open(self.folder.path().join(PICTURE_FILE))
            .with_context(|| format!("{PROGRAM}: no picture to read"))?
            .into_rgb16();
        anyhow::ensure!(
            picture.dimensions() == self.size,
            "{PROGRAM}: needed a picture of {} × {}, found {:?}",
            self.size.0,
            self.size.1,
            picture.dimensions()
        );
        Ok(picture)
    }
}

/// The last line of its output, from its error on where it names one.
fn complaint(log: &str) -> &str {
    let log = log.trim();
    let start = log.rfind("Error").or_else(|| log.rfind('\n')).unwrap_or(0);
    log[start..].trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_complaints_are_passed_on() {
        let log = "Parsing\nFile 'scene.pov' line 2: Parse Error: Expected 'x'.\nRender failed\n";
        assert_eq!(complaint(log), "Error: Expected 'x'.\nRender failed");
        assert_eq!((complaint("one\nlast\n"), complaint("")), ("last", ""));
    }
}
