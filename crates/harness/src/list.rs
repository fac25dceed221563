//! The commands `scenes` and `methods`.

use bench_scenes::{generators, known};

use crate::console;
use crate::methods::METHODS;

/// Lists the known scenes and the generators.
pub fn scenes() {
    console::line("Scenes");
    for scene in known() {
        console::line(&format!("  {:<24} {}", scene.name, scene.about));
    }
    console::line("\nGenerators, as NAME:COUNT, NAME:COUNT:DENSITY or NAME:COUNT:DENSITY:SEED");
    for generator in generators() {
        console::line(&format!("  {:<24} {}", generator.name, generator.about));
    }
    console::line("\nFiles: .toml scenes; .pdb, .cif, .xyz and .csv particles, also with .gz");
}

/// Lists the methods.
pub fn methods() {
    for method in METHODS {
        console::line(&format!("{:<18} {} ({})", method.name, method.title, method.paper));
        console::line(&format!("{:<18} {}", "", method.about));
    }
}
