//! The commands `scenes` and `methods`.

use bench_scenes::{generators, known, moving};

use experiments::console;
use harness::methods;

/// Lists the known scenes and the generators.
pub(crate) fn scenes() {
    console::line("Scenes");
    for scene in known() {
        console::line(&format!("  {:<24} {}", scene.name, scene.about));
    }
    console::line("\nGenerators, as NAME:COUNT, NAME:COUNT:DENSITY or NAME:COUNT:DENSITY:SEED");
    for generator in generators() {
        console::line(&format!("  {:<24} {}", generator.name, generator.about));
    }
    console::line("\nMoving scenes, for animate");
    for (name, about) in moving() {
        console::line(&format!("  {name:<24} {about}"));
    }
    for generator in generators().iter().filter(|generator| generator.moves()) {
        console::line(&format!(
            "  {:<24} {}",
            format!("{}:COUNT", generator.name),
            generator.about
        ));
    }
    console::line(
        "\nFiles: .toml scenes; .pdb, .cif, .xyz and .csv particles, also with .gz;\nparticles-%04d.xyz and the like, and .frames, move",
    );
}

/// Lists the methods.
pub(crate) fn methods() {
    for method in methods::methods() {
        console::line(&format!("{:<18} {} ({})", method.name, method.title, method.paper));
        console::line(&format!("{:<18} {}", "", method.about));
    }
}
