//! Where the eye is.

use glam::Vec3;
use metaball_core::{Camera, Metaball};

use super::case::{AROUND_ZERO, Case, Category, SIZE};
use crate::error::LoadError;
use crate::small::{Shot, looking, quartic};

pub(super) const CASES: &[Case] = &[
    Case {
        name: "eye-at-support",
        category: Category::Viewpoint,
        about: "The eye at the rim of a support, inside it for negative values.",
        parameter: "distance of the eye from the rim, radii",
        values: AROUND_ZERO,
        quick: &[0.0],
        size: SIZE,
        redraw: None,
        make: at_support,
    },
    Case {
        name: "eye-at-surface",
        category: Category::Viewpoint,
        about: "The eye at the surface, inside it for negative values.",
        parameter: "distance of the eye from the surface, radii",
        values: AROUND_ZERO,
        quick: &[-1e-3],
        size: SIZE,
        redraw: None,
        make: at_surface,
    },
    Case {
        name: "behind-the-eye",
        category: Category::Viewpoint,
        about: "A weak ball behind the image plane, whose support reaches before it up to 1.",
        parameter: "distance of its centre behind the eye, radii",
        values: &[0.01, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.1, 2.0, 10.0],
        quick: &[0.5],
        size: SIZE,
        redraw: None,
        make: behind,
    },
];

fn at_support(value: f64) -> Result<Shot, LoadError> {
    eye_at(1.0 + value)
}

fn at_surface(value: f64) -> Result<Shot, LoadError> {
    eye_at(std::f64::consts::FRAC_1_SQRT_2 + value)
}

fn behind(value: f64) -> Result<Shot, LoadError> {
    let behind = Metaball { center: Vec3::Z * value as f32, radius: 1.0, strength: 0.2 };
    let balls = [behind, Metaball::new(Vec3::NEG_Z * 1.5, 1.0)];
    Ok((quartic(balls)?, looking(Vec3::ZERO, Vec3::NEG_Z)?))
}

/// One ball seen along −z from so far off its centre.
fn eye_at(distance: f64) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let eye = Vec3::Z * distance as f32;
    Ok((scene, Camera::look_at(eye, eye - Vec3::Z, Vec3::Y, 90.0)?))
}
