//! Draws metaballs on the CPU: `cargo run --release --example trace_on_cpu -- picture.png`.

use std::{env, error::Error};

use fbvh::{Options, TraceOptions, Tracer, Tree};
use glam::Vec3;
use image::{Rgb, RgbImage};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("needed the path of a picture to write")?;

    // A spring of a thousand balls, thinner towards its end.
    let balls = (0..1000).map(|at| {
        let along = at as f32 / 1000.0;
        let angle = 40.0 * along;
        let center = Vec3::new(angle.cos(), 4.0 * along - 2.0, angle.sin());
        Metaball::new(center, 0.35 - 0.2 * along)
    });
    let scene = Scene::new(balls, Kernel::Wyvill, 0.5)?;
    let tree = Tree::build(&scene, &Options::fitted())?;
    let tracer = Tracer::new(&tree, &scene, TraceOptions::DEFAULT);

    let camera = Camera::look_at(Vec3::new(2.0, 1.5, 6.0), Vec3::ZERO, Vec3::Y, 45.0)?;
    let hits = tracer.first_hits(&View::new(camera, WIDTH, HEIGHT)?.rays());

    let light = Vec3::new(0.4, 0.8, 0.45).normalize();
    let picture = RgbImage::from_fn(WIDTH, HEIGHT, |column, row| {
        let hit = hits[(row * WIDTH + column) as usize];
        if !hit.is_hit() {
            return Rgb([24, 26, 32]);
        }
        let brightness = 0.25 + 0.75 * hit.normal.dot(light).max(0.0);
        Rgb([235.0, 150.0, 60.0].map(|channel| (channel * brightness) as u8))
    });
    picture.save(path)?;
    Ok(())
}
