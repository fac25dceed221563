//! From what a user types to a scene.

use std::path::Path;

use particle_files::{Loaded, Overrides, ReadOptions};

use crate::error::LoadError;
use crate::{BenchScene, FileFacts, Kind, generate, generators, known};

/// The scene of a spec: a name of [`known()`], a generator's `name:count[:density[:seed]]`, or the path
/// of a file that [`particle_files::load`] reads.
///
/// # Errors
/// Names the file with line and column or key, or the part of the spec, what was needed and found.
pub fn load(spec: &str, overrides: &Overrides) -> Result<BenchScene, LoadError> {
    load_as(spec, &ReadOptions::default(), overrides)
}

/// The same; files are read so.
///
/// # Errors
/// As [`load()`]; and where options are given for a scene of no file.
pub fn load_as(
    spec: &str,
    options: &ReadOptions,
    overrides: &Overrides,
) -> Result<BenchScene, LoadError> {
    let made = if let Some(known) = known().iter().find(|known| known.name == spec) {
        check_unread(spec, options)?;
        known.scene()?
    } else if let Some(recipe) = generate::parse(spec)? {
        check_unread(spec, options)?;
        recipe.scene()?
    } else if is_word(spec) {
        return Err(unknown(spec));
    } else {
        return Ok(of_file(particle_files::load(spec, options, overrides)?));
    };
    Ok(BenchScene { scene: overrides.apply(made.scene)?, ..made })
}

/// Whether somebody who wrote this meant a known scene or a generator: a word, and no file has its name.
pub(crate) fn is_word(spec: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_:.".contains(c);
    let name = spec.split(':').next().unwrap_or_default();
    spec != "-" && spec.chars().all(is_plain) && !name.contains('.') && !Path::new(spec).exists()
}

/// Refuses options of reading for what is not read.
pub(crate) fn check_unread(spec: &str, options: &ReadOptions) -> Result<(), LoadError> {
    if *options == ReadOptions::default() {
        return Ok(());
    }
    Err(LoadError::Parameter {
        name: "options of reading".to_owned(),
        needed: "a file".to_owned(),
        found: format!("the scene {spec:?}, which is of no file"),
    })
}

fn of_file(loaded: Loaded) -> BenchScene {
    let Loaded { name, scene, camera, notes, cell, legend, .. } = loaded;
    let about = format!("The particles of {name}.");
    let file = Some(FileFacts { notes, cell, legend });
    BenchScene { name, about, scene, camera, path: Vec::new(), kind: Kind::General, file }
}

fn unknown(spec: &str) -> LoadError {
    let known: Vec<_> = known().iter().map(|known| known.name).collect();
    let generators: Vec<_> = generators().iter().map(|generator| generator.name).collect();
    LoadError::Unknown {
        spec: spec.to_owned(),
        known: known.join(", "),
        generators: generators.join(", "),
    }
}
