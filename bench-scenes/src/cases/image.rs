//! Lenses, image sizes, and drawing again.

use glam::Vec3;
use metaball_core::{Camera, Metaball, Scene};

use super::case::{Case, Category, Redraw, SIZE, number};
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

pub(super) const CASES: &[Case] = &[
    Case {
        name: "wide-lens",
        category: Category::Image,
        about: "A wide lens before twenty balls.",
        parameter: "vertical field of view, degrees",
        values: &[38.0, 90.0, 120.0, 150.0, 170.0, 179.0, 179.9],
        quick: &[150.0],
        size: SIZE,
        redraw: None,
        make: lens,
    },
    Case {
        name: "narrow-lens",
        category: Category::Image,
        about: "A narrow lens before twenty balls.",
        parameter: "vertical field of view, degrees",
        values: &[38.0, 10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4],
        quick: &[0.1],
        size: SIZE,
        redraw: None,
        make: lens,
    },
    Case {
        name: "nudged",
        category: Category::Image,
        about: "The camera moved sideways by part of a pixel before twenty balls.",
        parameter: "part of a pixel",
        values: &[0.5, 0.25, 0.1, 1e-2, 1e-3, 1e-4],
        quick: &[0.25],
        size: SIZE,
        redraw: None,
        make: nudged,
    },
    Case {
        name: "image",
        category: Category::Image,
        about: "Twenty balls in pictures from one pixel to a strip 64 high.",
        parameter: "pixels across",
        values: &[1.0, 2.0, 64.0, 1024.0, 4096.0, 8192.0],
        quick: &[64.0],
        size: |across| (across.round() as u32, across.round().min(64.0) as u32),
        redraw: None,
        make: strip,
    },
    Case {
        name: "redrawn",
        category: Category::Image,
        about: "So many balls of random size; the same frame is drawn twice.",
        parameter: "number of balls",
        values: &[1.0, 20.0, 100.0, 1000.0],
        quick: &[20.0],
        size: SIZE,
        redraw: Some(Redraw::Same),
        make: cloud,
    },
    Case {
        name: "shuffled",
        category: Category::Image,
        about: "So many balls of random size, drawn in another order.",
        parameter: "number of balls",
        values: &[2.0, 20.0, 100.0, 1000.0],
        quick: &[20.0],
        size: SIZE,
        redraw: Some(Redraw::Shuffled),
        make: cloud,
    },
];

/// A field of view before twenty balls.
fn lens(degrees: f64) -> Result<Shot, LoadError> {
    let eye = Vec3::new(0.3, 0.2, 6.0);
    Ok((twenty()?, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, degrees as f32)?))
}

/// A camera moved by part of a pixel of a picture 25 high, as measured at the balls.
fn nudged(part: f64) -> Result<Shot, LoadError> {
    let (scene, camera) = lens(38.0)?;
    let pixel = 6.0 * 2.0 * camera.half_height() / 25.0;
    Ok((scene, camera.shifted(part as f32 * pixel, 0.0)))
}

/// A lens whose picture, if 128 times as wide as high, just holds twenty balls.
fn strip(across: f64) -> Result<Shot, LoadError> {
    lens(38.0 / (across / 64.0).max(1.0))
}

/// Balls of radii from 0.3 to 1 in a ball of radius 2.
fn cloud(count: f64) -> Result<Shot, LoadError> {
    let mut random = Random::new(9);
    let balls = (0..number(count)).map(|_| {
        let center = 2.0 * random.in_ball().as_vec3();
        Metaball::new(center, random.between(0.3, 1.0) as f32)
    });
    Ok((quartic(balls.collect::<Vec<_>>())?, looking(Vec3::new(0.3, 0.2, 8.0), Vec3::ZERO)?))
}

fn twenty() -> Result<Scene, LoadError> {
    let mut random = Random::new(7);
    quartic((0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0)))
}
