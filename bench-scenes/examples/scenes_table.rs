//! Prints the table of scenes in this package's README, measured anew:
//!
//! ```sh
//! cargo run -p bench-scenes --example scenes_table
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use bench_scenes::{known, mean_overlap};

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = stdout().lock();
    writeln!(out, "| scene | balls | kernel | T | overlap | what it is for |")?;
    writeln!(out, "| --- | ---: | --- | ---: | ---: | --- |")?;
    for known in known() {
        let scene = known.scene()?.scene;
        writeln!(
            out,
            "| `{}` | {} | {} | {} | {:.1} | {} |",
            known.name,
            scene.len(),
            scene.kernel(),
            scene.threshold(),
            mean_overlap(&scene),
            known.about,
        )?;
    }
    Ok(())
}
