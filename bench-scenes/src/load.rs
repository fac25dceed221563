//! From what a user types to a scene.

use std::path::{Path, PathBuf};

use glam::Vec3;
use metaball_core::{Color, Kernel, Scene};

use crate::cameras::framing;
use crate::error::{Flaw, LoadError};
use crate::file::{self, FileKind};
use crate::particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles};
use crate::scene_file::{self, SceneFile};
use crate::{BenchScene, Kind, generate, generators, known};

/// What replaces a scene's own choices; `None` keeps them. Support radii stay as they are.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overrides {
    /// Another kernel.
    pub kernel: Option<Kernel>,
    /// Another exponent, 1 to 8, for a scene (or a `kernel` above) of a power kernel.
    pub exponent: Option<i64>,
    /// Another threshold T.
    pub threshold: Option<f32>,
    /// One colour for all balls.
    pub color: Option<Color>,
}

/// The scene of a spec: a name of [`known()`], a generator's `name:count[:density[:seed]]`, or the path
/// of a `.toml`, `.csv`, `.xyz`, `.pdb`, `.ent`, `.cif`, `.mmcif` or `.balls` file, also with `.gz`.
///
/// # Errors
/// Names the file with line and column or key, or the part of the spec, what was needed and found.
pub fn load(spec: &str, overrides: &Overrides) -> Result<BenchScene, LoadError> {
    let path = Path::new(spec);
    let mut scene = if let Some(known) = known().iter().find(|known| known.name == spec) {
        known.scene()?
    } else if let Some(recipe) = generate::parse(spec)? {
        recipe.scene()?
    } else if let Some(kind) = FileKind::of(path) {
        from_file(path, kind)?
    } else {
        let names = |names: &mut dyn Iterator<Item = &str>| names.collect::<Vec<_>>().join(", ");
        return Err(LoadError::Unknown {
            spec: spec.to_owned(),
            known: names(&mut known().iter().map(|known| known.name)),
            generators: names(&mut generators().iter().map(|generator| generator.name)),
        });
    };
    scene.scene = overridden(scene.scene, overrides)?;
    Ok(scene)
}

/// The kernel of a name in scene files and commands: `power` (with an exponent, else 2), `power-1` to
/// `power-8`, `wyvill`, `perlin`.
///
/// # Errors
/// When there is no such kernel, or it does not go with the exponent.
pub fn kernel_named(name: &str, exponent: Option<i64>) -> Result<Kernel, LoadError> {
    let parameter = |name: &str, needed: &str, found: String| LoadError::Parameter {
        name: name.to_owned(),
        needed: needed.to_owned(),
        found,
    };
    let named = match name {
        "power" => Some(Kernel::QUARTIC),
        _ => Kernel::all().find(|kernel| kernel.to_string() == name),
    };
    match (named, exponent) {
        (Some(Kernel::Power(own)), Some(exponent))
            if name == "power" || i64::from(own.get()) == exponent =>
        {
            Kernel::power(exponent).map_err(|error| {
                parameter("kernel exponent", "an integer from 1 to 8", error.found.to_string())
            })
        }
        (Some(_), Some(_)) => {
            Err(parameter("kernel exponent", "the kernel power", format!("{name:?}")))
        }
        (Some(kernel), None) => Ok(kernel),
        (None, _) => {
            let needed = "power, power-1 to power-8, wyvill or perlin";
            Err(parameter("kernel", needed, format!("{name:?}")))
        }
    }
}

/// The scene with its own choices replaced.
pub(crate) fn overridden(scene: Scene, overrides: &Overrides) -> Result<Scene, LoadError> {
    let kernel = overrides.kernel.unwrap_or(scene.kernel());
    let kernel = match (kernel, overrides.exponent) {
        (Kernel::Power(_), Some(exponent)) => kernel_named("power", Some(exponent))?,
        (_, exponent) => kernel_named(&kernel.to_string(), exponent)?,
    };
    let threshold = overrides.threshold.unwrap_or(scene.threshold());
    let count = scene.len();
    let scene = scene.with_kernel(kernel).with_threshold(threshold)?;
    match overrides.color {
        Some(color) => Ok(scene.with_colors(vec![color; count])?),
        None => Ok(scene),
    }
}

fn from_file(path: &Path, kind: FileKind) -> Result<BenchScene, LoadError> {
    if kind != FileKind::SceneFile {
        return Ok(of_file(path, in_file(path, kind, DEFAULT_KERNEL, DEFAULT_THRESHOLD)?));
    }
    let (scene_file, table, kind) = open_scene_file(path)?;
    let scene = in_file(&table, kind, scene_file.kernel, scene_file.threshold)?;
    let framed = of_file(path, scene);
    Ok(BenchScene { camera: scene_file.camera.unwrap_or(framed.camera), ..framed })
}

/// The scene of a particle file.
pub(crate) fn in_file(
    path: &Path,
    kind: FileKind,
    kernel: Kernel,
    threshold: f32,
) -> Result<Scene, LoadError> {
    scene_of(particles_in(path, kind)?, path, kernel, threshold)
}

/// The particles of a particle file.
pub(crate) fn particles_in(path: &Path, kind: FileKind) -> Result<Particles, LoadError> {
    let bytes = file::read(path)?;
    kind.parse(&bytes).map_err(|flaw| flaw.in_file(&path.display().to_string()))
}

/// The scene of a file's particles.
pub(crate) fn scene_of(
    particles: Particles,
    path: &Path,
    kernel: Kernel,
    threshold: f32,
) -> Result<Scene, LoadError> {
    particles
        .into_scene(kernel, threshold)
        .map_err(|flaw| flaw.in_file(&path.display().to_string()))
}

/// What a scene file says, and the path and kind of the particle file that it names.
pub(crate) fn open_scene_file(path: &Path) -> Result<(SceneFile, PathBuf, FileKind), LoadError> {
    let own = path.display().to_string();
    let bytes = file::read(path)?;
    let scene_file =
        file::text(&bytes).and_then(scene_file::parse).map_err(|flaw| flaw.in_file(&own))?;
    let table = path.parent().unwrap_or(Path::new("")).join(&scene_file.particles);
    let kind = FileKind::of(&table).filter(|kind| kind.is_particles()).ok_or_else(|| {
        let needed =
            "a .csv, .xyz, .pdb, .ent, .cif, .mmcif or .balls file, or one of these with .gz";
        let flaw = Flaw::needed(needed, format_args!("{:?}", scene_file.particles));
        flaw.at_key("particles").in_file(&own)
    })?;
    Ok((scene_file, table, kind))
}

/// The scene of a user's file, framed from the front, a little from the right and from above.
fn of_file(path: &Path, scene: Scene) -> BenchScene {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    BenchScene {
        about: format!("The particles of {name}."),
        name,
        camera: framing(&scene.bounds(), Vec3::new(0.4, 0.3, 1.0)),
        path: Vec::new(),
        kind: Kind::General,
        scene,
    }
}
