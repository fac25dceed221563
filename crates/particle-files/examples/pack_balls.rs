//! Packs the particles of a file into a `.balls` file:
//!
//! ```sh
//! cargo run -p particle-files --example pack_balls -- frame.xyz.gz RADIUS frame.balls
//! ```
//!
//! RADIUS is the support radius of all particles, in the file's units.

use std::error::Error;

use particle_files::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, ReadOptions, pack_balls, read};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [frame, radius, packed] = arguments.as_slice() else {
        return Err("needed FRAME RADIUS OUTPUT".into());
    };
    let options = ReadOptions { support_radius: Some(radius.parse()?), ..ReadOptions::default() };
    let frame = read(frame, &options)?.into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD)?;
    std::fs::write(packed, pack_balls(&frame)?)?;
    Ok(())
}
