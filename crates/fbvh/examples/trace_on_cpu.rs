//! Draws metaballs on the CPU: `cargo run --release -p fbvh --example trace_on_cpu -- picture.png`.

use std::{env, error::Error};

use fbvh::{Options, Tracer, Tree};
use glam::Vec3;
use image::{Rgb, RgbImage};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("needed the path of a picture to write")?;

    // A spring of a thousand balls, thinner towards its end.
    let balls = (0..1000).map(|at| {
        let along = at as f32 / 1000.0;
        let angle = 40.0 * along;
        Metaball::new(Vec3::new(angle.cos(), 4.0 * along - 2.0, angle.sin()), 0.35 - 0.2 * along)
    });
    let scene = Scene::new(balls, Kernel::Wyvill, 0.5)?;
    let tree = Tree::build(&scene, &Options::certified())?;
    eprintln!("{} leaves of {:.1} balls", tree.leaf_count(), tree.stats().split.mean);

    let camera = Camera::look_at(Vec3::new(2.0, 1.5, 6.0), Vec3::ZERO, Vec3::Y, 45.0)?;
    let view = View::new(camera, 640, 480)?;
    let hits = Tracer::new(&tree, &scene).picture_hits(&view.rays(), 640);
    eprintln!("{} of {} rays hit", hits.iter().filter(|hit| hit.is_hit()).count(), hits.len());

    let light = Vec3::new(0.4, 0.8, 0.45).normalize();
    let shade = |column, row| {
        let hit = hits[(row * 640 + column) as usize];
        let brightness = 0.25 + 0.75 * hit.normal.dot(light).max(0.0);
        Rgb(if hit.is_hit() {
            [235.0, 150.0, 60.0].map(|c| (c * brightness) as u8)
        } else {
            [24; 3]
        })
    };
    RgbImage::from_fn(640, 480, shade).save(path)?;
    Ok(())
}
