//! From what a user types to a scene.

use particle_files::{Format, Loaded, Overrides};

use crate::error::LoadError;
use crate::{BenchScene, Kind, generate, generators, known};

/// The scene of a spec: a name of [`known()`], a generator's `name:count[:density[:seed]]`, or the path
/// of a file that [`particle_files::load`] reads.
///
/// # Errors
/// Names the file with line and column or key, or the part of the spec, what was needed and found.
pub fn load(spec: &str, overrides: &Overrides) -> Result<BenchScene, LoadError> {
    let made = if let Some(known) = known().iter().find(|known| known.name == spec) {
        known.scene()?
    } else if let Some(recipe) = generate::parse(spec)? {
        recipe.scene()?
    } else {
        return match particle_files::load(spec, overrides) {
            Ok(loaded) => Ok(of_file(loaded)),
            Err(particle_files::LoadError::UnknownFormat { .. }) => Err(unknown(spec)),
            Err(error) => Err(error.into()),
        };
    };
    Ok(BenchScene { scene: overrides.apply(made.scene)?, ..made })
}

fn of_file(loaded: Loaded) -> BenchScene {
    let Loaded { name, scene, camera, .. } = loaded;
    let about = format!("The particles of {name}.");
    BenchScene { name, about, scene, camera, path: Vec::new(), kind: Kind::General }
}

fn unknown(spec: &str) -> LoadError {
    let known: Vec<_> = known().iter().map(|known| known.name).collect();
    let generators: Vec<_> = generators().iter().map(|generator| generator.name).collect();
    LoadError::Unknown {
        spec: spec.to_owned(),
        known: known.join(", "),
        generators: generators.join(", "),
        endings: Format::endings().collect::<Vec<_>>().join(", "),
    }
}
