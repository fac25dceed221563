//! Extreme distances, sizes, strengths and thresholds.
//!
//! No camera lies in the plane between two equal balls, where points of rays coincide: that is
//! another case.

use glam::Vec3;
use metaball_core::{Camera, Kernel, Metaball};

use super::case::{Case, Category, SIZE};
use super::shape::pair;
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

pub(super) const CASES: &[Case] = &[
    Case {
        name: "distance",
        category: Category::Magnitude,
        about: "A pair of balls seen from afar through a lens that keeps their size.",
        parameter: "distance from the eye, radii",
        values: &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        redraw: None,
        make: distance,
    },
    Case {
        name: "offset",
        category: Category::Magnitude,
        about: "A pair of balls and the eye, moved away from the origin together.",
        parameter: "offset on every axis, radii",
        values: &[0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        redraw: None,
        make: offset,
    },
    Case {
        name: "scale",
        category: Category::Magnitude,
        about: "A pair of balls and the eye, all made larger or smaller.",
        parameter: "scale, radii",
        values: &[1.0, 1e-2, 1e2, 1e-4, 1e4, 1e-6, 1e6, 1e-9, 1e9, 1e-12, 1e12],
        quick: &[1e-6],
        size: SIZE,
        redraw: None,
        make: scale,
    },
    Case {
        name: "radius-ratio",
        category: Category::Magnitude,
        about: "A small ball that sits on a large one, seen from near.",
        parameter: "large radius over small radius",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e3],
        size: SIZE,
        redraw: None,
        make: radius_ratio,
    },
    Case {
        name: "background",
        category: Category::Magnitude,
        about: "One weak ball larger than the scene and the eye's distance, around twenty balls.",
        parameter: "radius of the large ball",
        values: &[10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        redraw: None,
        make: background,
    },
    Case {
        name: "strength",
        category: Category::Magnitude,
        about: "A strong ball beside one of strength 1.",
        parameter: "strength of the strong ball",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e8],
        quick: &[1e4],
        size: SIZE,
        redraw: None,
        make: strength,
    },
    Case {
        name: "exponent",
        category: Category::Magnitude,
        about: "A pair of balls under power kernels of growing degree.",
        parameter: "exponent of the kernel",
        values: &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
        quick: &[4.0],
        size: SIZE,
        redraw: None,
        make: exponent,
    },
    Case {
        name: "cut",
        category: Category::Magnitude,
        about: "A pair of balls under Gaussians, which are steeper the farther out they are cut; nearer, their \
                slopes jump more.",
        parameter: "cut of the Gaussian, standard deviations",
        values: &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        quick: &[2.0],
        size: SIZE,
        redraw: None,
        make: cut,
    },
    Case {
        name: "threshold-near-zero",
        category: Category::Magnitude,
        about: "The surface nears the rims of the supports.",
        parameter: "threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-12],
        quick: &[1e-5],
        size: SIZE,
        redraw: None,
        make: threshold_near_zero,
    },
    Case {
        name: "threshold-near-maximum",
        category: Category::Magnitude,
        about: "The surface shrinks to a speck at the centre; none is left at 0 and below.",
        parameter: "the field's maximum minus the threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0, -1e-3, -1.0],
        quick: &[1e-2],
        size: SIZE,
        redraw: None,
        make: threshold_near_maximum,
    },
];

fn distance(value: f64) -> Result<Shot, LoadError> {
    let fov = 2.0 * (1.6 / value).atan().to_degrees();
    let eye = value as f32 * Vec3::new(0.28, 0.0, 0.96);
    Ok((pair(0.5)?, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
}

fn offset(value: f64) -> Result<Shot, LoadError> {
    let offset = Vec3::splat(value as f32);
    let balls = [-0.5, 0.5].map(|x| Metaball::new(offset + Vec3::X * x, 1.0));
    Ok((quartic(balls)?, looking(offset + Vec3::new(1.5, 1.0, 5.0), offset)?))
}

fn scale(value: f64) -> Result<Shot, LoadError> {
    let scale = value as f32;
    let balls = [-0.5, 0.5].map(|x| Metaball::new(Vec3::X * (x * scale), scale));
    Ok((quartic(balls)?, looking(scale * Vec3::new(1.5, 1.0, 5.0), Vec3::ZERO)?))
}

fn radius_ratio(value: f64) -> Result<Shot, LoadError> {
    let small = value.recip() as f32;
    let surface = std::f32::consts::FRAC_1_SQRT_2;
    let top = Vec3::Z * (surface + 0.5 * small);
    let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(top, small)];
    let eye = top + small * Vec3::new(1.0, 1.5, 4.0);
    Ok((quartic(balls)?, looking(eye, top)?))
}

fn background(value: f64) -> Result<Shot, LoadError> {
    let large = Metaball { center: Vec3::ZERO, radius: value as f32, strength: 0.2 };
    let mut random = Random::new(6);
    let balls = (0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0));
    let scene = quartic([large].into_iter().chain(balls))?;
    Ok((scene, looking(Vec3::new(0.0, 2.0, 8.0), Vec3::ZERO)?))
}

fn strength(value: f64) -> Result<Shot, LoadError> {
    let strong = Metaball { center: Vec3::NEG_X * 0.8, radius: 1.0, strength: value as f32 };
    let scene = quartic([strong, Metaball::new(Vec3::X * 0.8, 1.0)])?;
    Ok((scene, looking(Vec3::new(1.5, 1.0, 6.0), Vec3::ZERO)?))
}

fn exponent(value: f64) -> Result<Shot, LoadError> {
    let kernel = particle_files::kernel_named("power", Some(value.round() as i64))?;
    Ok((pair(0.4)?.with_kernel(kernel), looking(Vec3::new(1.2, 0.9, 4.0), Vec3::ZERO)?))
}

fn cut(value: f64) -> Result<Shot, LoadError> {
    let kernel = Kernel::gaussian(value)?;
    Ok((pair(0.3)?.with_kernel(kernel), looking(Vec3::new(1.2, 0.9, 4.0), Vec3::ZERO)?))
}

fn threshold_near_zero(value: f64) -> Result<Shot, LoadError> {
    let scene = pair(0.8)?.with_threshold(value as f32)?;
    Ok((scene, looking(Vec3::new(1.5, 1.0, 6.0), Vec3::ZERO)?))
}

fn threshold_near_maximum(value: f64) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let scene = scene.with_threshold((1.0 - value) as f32)?;
    // The quartic is 1 − 2r²: the speck fills half the picture's height while it is there.
    let speck = (0.5 * value.max(1e-6)).sqrt();
    let fov = 2.0 * (2.0 * speck / 3.0).atan().to_degrees();
    let eye = Vec3::new(0.0, 0.0, 3.0);
    Ok((scene, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
}
