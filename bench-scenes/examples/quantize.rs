//! Packs a frame of a particle simulation into a `.balls` file of this package:
//!
//! ```sh
//! cargo run -p bench-scenes --example quantize -- frame.xyz.gz RADIUS frame.balls
//! ```
//!
//! RADIUS is the support radius of all particles, in the frame's units.

use std::error::Error;

use bench_scenes::{Overrides, load, quantize};
use metaball_core::{Metaball, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [frame, radius, packed] = arguments.as_slice() else {
        return Err("needed FRAME RADIUS OUTPUT".into());
    };
    let radius = radius.parse()?;
    let frame = load(frame, &Overrides::default())?.scene;
    let balls = frame.supports().iter().map(|support| Metaball::new(support.center, radius));
    let frame = Scene::new(balls, frame.kernel(), frame.threshold())?;
    std::fs::write(packed, quantize(&frame)?)?;
    Ok(())
}
