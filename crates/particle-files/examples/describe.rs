//! Says what a file of particles holds:
//!
//! ```sh
//! cargo run -p particle-files --example describe -- crates/particle-files/examples/water.xyz
//! ```

use std::error::Error;
use std::io::{Write, stdout};
use std::process::ExitCode;

use particle_files::{Overrides, ReadOptions, load};

fn main() -> ExitCode {
    match describe() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn describe() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("needed FILE")?;
    let loaded = load(path, &ReadOptions::default(), &Overrides::default())?;
    let (scene, bounds) = (&loaded.scene, loaded.scene.bounds());
    let mut out = stdout().lock();
    writeln!(out, "{}: {} balls", loaded.name, scene.len())?;
    writeln!(out, "kernel {}, threshold {}", scene.kernel(), scene.threshold())?;
    writeln!(out, "from {} to {}, support radii included", bounds.min, bounds.max)?;
    writeln!(out, "seen from {}", loaded.camera.eye())?;
    for note in &loaded.notes {
        writeln!(out, "- {note}")?;
    }
    Ok(())
}
