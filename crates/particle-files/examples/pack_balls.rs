//! Packs the particles of a file into a `.balls` file:
//!
//! ```sh
//! cargo run -p particle-files --example pack_balls -- frame.xyz.gz RADIUS frame.balls
//! ```
//!
//! RADIUS is the support radius of all particles, in the file's units.

use std::error::Error;

use metaball_core::Metaball;
use particle_files::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles, pack_balls, read};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [frame, radius, packed] = arguments.as_slice() else {
        return Err("needed FRAME RADIUS OUTPUT".into());
    };
    let radius = radius.parse()?;
    let balls = read(frame)?.balls.iter().map(|ball| Metaball::new(ball.center, radius)).collect();
    let frame = Particles { balls, ..Particles::default() };
    let frame = frame.into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD)?;
    std::fs::write(packed, pack_balls(&frame)?)?;
    Ok(())
}
