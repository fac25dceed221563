//! Scenes of files.

use std::path::{Path, PathBuf};

use glam::DVec3;
use metaball_core::{Camera, Kernel, Scene};

use crate::cell::Cell;
use crate::coloring::Legend;
use crate::error::{Flaw, LoadError};
use crate::file::{self, named};
use crate::formats::PackedFrames;
use crate::formula::FormulaOptions;
use crate::framing::{FRONT, framed, framing};
use crate::notes::Notes;
use crate::options::ReadOptions;
use crate::overrides::Overrides;
use crate::particles::Particles;
use crate::read::{parse, particles_of, read};
use crate::scene_file::{SceneCamera, SceneFile};
use crate::surface::Surface;
use crate::table::Table;

/// What was loaded from a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Loaded {
    /// The file's name without its folder; empty for a table of elsewhere.
    pub name: String,
    /// The balls, their kernel and threshold.
    pub scene: Scene,
    /// The scene file's camera, or one that frames the particles.
    pub camera: Camera,
    /// The periodic cell, in the coordinates of the file, in the unit of the scene.
    pub cell: Option<Cell>,
    /// What the colours say, where a column gave them.
    pub legend: Option<Legend>,
    /// What was read, guessed and left out.
    pub notes: Notes,
}

/// The scene of a particle file, or of a scene file (`.toml`) that names one; `-` is standard input.
///
/// # Errors
/// Names the file with line and column or key, or the option, what was needed and what was found.
pub fn load(
    path: impl AsRef<Path>,
    options: &ReadOptions,
    overrides: &Overrides,
) -> Result<Loaded, LoadError> {
    let path = path.as_ref();
    let source = Source::of(path)?;
    source.is_of_one_scene(path)?;
    source.load(path, options, overrides, |options| read(&source.particles, options))
}

/// The scene of the bytes of a particle file: [`load()`] without the file system. Errors name `name`, and its
/// ending decides where the bytes could be of several formats.
///
/// # Errors
/// As [`load()`]; and scene files are refused, since their particles are in another file.
pub fn load_bytes(
    name: impl AsRef<Path>,
    bytes: &[u8],
    options: &ReadOptions,
    overrides: &Overrides,
) -> Result<Loaded, LoadError> {
    let name = name.as_ref();
    if file::ending(name).as_deref() == Some(SceneFile::ENDING) {
        let found = "a scene file, whose particles are in another";
        return Err(Flaw::needed("a file of particles", found).in_file(&named(name)));
    }
    let source = Source { particles: name.to_owned(), ..Source::default() };
    source.is_of_one_scene(name)?;
    source.load(name, options, overrides, |options| parse(name, bytes, options))
}

/// The scene of a table, which need not come from a file: [`load`] after the table. It has no name.
///
/// # Errors
/// Names the column or the option, what was needed and what was found.
pub fn load_table(
    table: Table,
    options: &ReadOptions,
    overrides: &Overrides,
) -> Result<Loaded, LoadError> {
    let surface = Source::default().surface(options)?.overridden(overrides)?;
    loaded(particles_of(table, options)?, &surface, (options, overrides), |_| Ok(None))
}

/// The scene of particles, without a name. It has a camera of its own where coordinates begin, or else one
/// that frames the particles.
fn loaded(
    mut particles: Particles,
    surface: &Surface,
    (options, overrides): (&ReadOptions, &Overrides),
    own_camera: impl FnOnce(DVec3) -> Result<Option<Camera>, LoadError>,
) -> Result<Loaded, LoadError> {
    let (cell, legend) = (particles.cell, particles.legend.take());
    let (scene, mut notes) = surface.scene(particles, None)?;
    if scene.origin() != DVec3::ZERO {
        notes.changed(format!(
            "coordinates begin at {}: f32 moves what is far from it",
            scene.origin()
        ));
    }
    let camera = match own_camera(scene.origin())? {
        Some(camera) => camera,
        None => framing(&framed(&scene, cell.as_ref(), options, &mut notes), FRONT),
    };
    let scene = overrides.apply(scene)?;
    Ok(Loaded { name: String::new(), scene, camera, cell, legend, notes })
}

/// A particle file, and how its balls make a surface.
#[derive(Default)]
pub(crate) struct Source {
    pub(crate) particles: PathBuf,
    pub(crate) camera: Option<SceneCamera>,
    kernel: Option<Kernel>,
    threshold: Option<f32>,
    formula: FormulaOptions,
}

impl Source {
    /// The one that a scene file says; of any other file nothing but the particles.
    pub(crate) fn of(path: &Path) -> Result<Self, LoadError> {
        if file::ending(path).as_deref() == Some(SceneFile::ENDING) {
            let SceneFile { particles, kernel, threshold, formula, camera } =
                SceneFile::open(path)?;
            return Ok(Self { particles, camera, kernel, threshold, formula });
        }
        Ok(Self { particles: path.to_owned(), ..Self::default() })
    }

    /// Refuses a file of many frames.
    fn is_of_one_scene(&self, path: &Path) -> Result<(), LoadError> {
        if file::ending(&self.particles).as_deref() == Some(PackedFrames::ENDING) {
            let flaw = Flaw::needed("the particles of one scene", "those of many frames");
            return Err(flaw.in_file(&path.display().to_string()));
        }
        Ok(())
    }

    /// The scene of the particles that are read so. `path` is what was asked for.
    fn load(
        &self,
        path: &Path,
        options: &ReadOptions,
        overrides: &Overrides,
        read: impl FnOnce(&ReadOptions) -> Result<Particles, LoadError>,
    ) -> Result<Loaded, LoadError> {
        let options = &self.options(options);
        let surface = self.surface(options)?.overridden(overrides)?;
        let loaded = loaded(read(options)?, &surface, (options, overrides), |origin| {
            let camera = self.camera.as_ref().map(|camera| camera.at(origin)).transpose();
            camera.map_err(|flaw| flaw.in_file(&named(path)))
        })?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Loaded { name, ..loaded })
    }

    /// How its particles are read, where the options do not say otherwise.
    pub(crate) fn options(&self, options: &ReadOptions) -> ReadOptions {
        ReadOptions { formula: options.formula.or(&self.formula), ..options.clone() }
    }

    /// How its particles make a surface under these options.
    pub(crate) fn surface(&self, options: &ReadOptions) -> Result<Surface, LoadError> {
        let formula = options.formula.formula()?;
        Ok(Surface { kernel: self.kernel, threshold: self.threshold, formula })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_loaded_as_their_file_is() {
        let (options, overrides) = (ReadOptions::default(), Overrides::default());
        let path = "examples/water.xyz";
        let bytes = std::fs::read(path).expect("there");
        let of_file = load(path, &options, &overrides).expect("legal");
        let of_bytes = load_bytes("water.xyz", &bytes, &options, &overrides).expect("legal");
        assert_eq!(of_bytes.scene, of_file.scene);
        assert_eq!((of_bytes.camera, of_bytes.name), (of_file.camera, of_file.name));
        let error = load_bytes("water.toml", b"particles = 'water.xyz'", &options, &overrides);
        assert_eq!(
            error.expect_err("of another file").to_string(),
            "water.toml: needed a file of particles, found a scene file, whose particles are in another"
        );
    }
}
