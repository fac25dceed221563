//! The files that a scene is read from.

use std::path::{Path, PathBuf};

use crate::file;
use crate::numbered_path::NumberedPath;
use crate::scene_file::SceneFile;

/// The files that [`load`](crate::load()) and [`Sequence::open`](crate::Sequence::open) read for a path:
/// itself, what a scene file names, and all files of a sequence. Whoever writes files asks for them, so as
/// to write over none of them.
pub fn inputs(path: impl AsRef<Path>) -> Vec<PathBuf> {
    let path = path.as_ref();
    let is_scene_file = file::ending(path).as_deref() == Some(SceneFile::ENDING);
    let particles = is_scene_file.then(|| SceneFile::open(path)).and_then(Result::ok);
    let particles = particles.map(|scene| scene.particles);
    let numbered = files_of_sequence(particles.as_deref().unwrap_or(path));
    [path.to_owned()].into_iter().chain(particles).chain(numbered).collect()
}

fn files_of_sequence(path: &Path) -> Vec<PathBuf> {
    let numbered = path.to_str().and_then(|text| text.parse::<NumberedPath>().ok());
    let Some(numbered) = numbered else { return Vec::new() };
    let numbers = numbered.numbers().unwrap_or_default();
    numbers.into_iter().map(|number| numbered.path(number)).collect()
}
