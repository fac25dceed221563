//! Almost no balls, and many over one point.

use glam::Vec3;
use metaball_core::{Camera, Metaball};

use super::case::{Case, Category, SIZE, number};
use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, looking, quartic};

/// Fewer pixels where there are many balls on every ray.
const SMALLER_WHERE_MANY: fn(f64) -> (u32, u32) =
    |count| if count < 500.0 { (33, 25) } else { (9, 7) };

/// Numbers of balls: Kanamori's list size K = 14 with its neighbours and its tenfold, and the balls
/// that fill the longest list of eight targets (29) and the array of Illés and Szécsi (32).
const COUNTS: &[f64] = &[1.0, 2.0, 13.0, 14.0, 15.0, 29.0, 30.0, 32.0, 33.0, 65.0, 140.0, 1000.0];

/// [`COUNTS`] and thousands.
const COUNTS_AND_THOUSANDS: &[f64] =
    &[1.0, 2.0, 13.0, 14.0, 15.0, 29.0, 30.0, 32.0, 33.0, 65.0, 140.0, 1000.0, 2048.0, 4096.0];

pub(super) const CASES: &[Case] = &[
    Case {
        name: "few",
        category: Category::Overlap,
        about: "Almost no balls.",
        parameter: "number of balls",
        values: &[3.0, 2.0, 1.0, 0.0],
        quick: &[0.0],
        size: SIZE,
        redraw: None,
        make: few,
    },
    Case {
        name: "coincident",
        category: Category::Overlap,
        about: "So many equal balls with one centre: lists and arrays overflow.",
        parameter: "number of balls",
        values: COUNTS_AND_THOUSANDS,
        quick: &[2.0, 33.0],
        size: SMALLER_WHERE_MANY,
        redraw: None,
        make: coincident,
    },
    Case {
        name: "overlapping",
        category: Category::Overlap,
        about: "So many balls whose centres lie within a tenth of a radius.",
        parameter: "number of balls",
        values: COUNTS_AND_THOUSANDS,
        quick: &[15.0, 33.0],
        size: SMALLER_WHERE_MANY,
        redraw: None,
        make: overlapping,
    },
    Case {
        name: "concentric",
        category: Category::Overlap,
        about: "Balls of different radii, from 1 to 2, with one centre.",
        parameter: "number of balls",
        values: COUNTS,
        quick: &[14.0],
        size: SMALLER_WHERE_MANY,
        redraw: None,
        make: concentric,
    },
    Case {
        name: "common-entry",
        category: Category::Overlap,
        about: "Balls of different radii whose supports the view axis enters at one point (Kanamori, figure 9a).",
        parameter: "number of balls",
        values: COUNTS,
        quick: &[2.0],
        size: SMALLER_WHERE_MANY,
        redraw: None,
        make: common_entry,
    },
    Case {
        name: "veiled",
        category: Category::Overlap,
        about: "So many weak balls in a row, below T, before the surface (Kanamori, figure 9c).",
        parameter: "number of balls",
        values: &[0.0, 1.0, 13.0, 14.0, 15.0, 65.0, 140.0, 1000.0],
        quick: &[65.0],
        size: SMALLER_WHERE_MANY,
        redraw: None,
        make: veiled,
    },
];

fn few(value: f64) -> Result<Shot, LoadError> {
    let balls = (0..number(value)).map(|index| Metaball::new(Vec3::X * index as f32, 1.0));
    Ok((quartic(balls)?, looking(Vec3::new(1.0, 0.0, 6.0), Vec3::X)?))
}

fn coincident(value: f64) -> Result<Shot, LoadError> {
    let balls = vec![Metaball::new(Vec3::ZERO, 1.0); number(value)];
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
}

fn overlapping(value: f64) -> Result<Shot, LoadError> {
    let mut random = Random::new(1);
    let balls = (0..number(value))
        .map(|_| Metaball::new(0.1 * random.in_ball().as_vec3(), 1.0))
        .collect::<Vec<_>>();
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
}

fn concentric(value: f64) -> Result<Shot, LoadError> {
    let balls = radii(value).map(|radius| Metaball::new(Vec3::ZERO, radius));
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 7.0), Vec3::ZERO)?))
}

fn common_entry(value: f64) -> Result<Shot, LoadError> {
    let balls = radii(value).map(|radius| Metaball::new(Vec3::NEG_Z * radius, radius));
    Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::NEG_Z)?))
}

fn veiled(value: f64) -> Result<Shot, LoadError> {
    // Supports overlap in pairs: the field before the last ball stays at 0.14 or below.
    let last = number(value) as f32;
    let veil = (0..number(value)).map(|index| Metaball {
        center: Vec3::new(0.0, 0.0, last - index as f32 + 0.5),
        radius: 0.7,
        strength: 0.1,
    });
    let balls = veil.chain([Metaball::new(Vec3::NEG_Z, 1.0)]);
    // A lens that keeps the last ball's size.
    let (eye, distance) = (Vec3::Z * (last + 3.0), last + 4.0);
    let fov = 2.0 * (1.4 / distance).atan().to_degrees();
    Ok((quartic(balls)?, Camera::look_at(eye, Vec3::NEG_Z, Vec3::Y, fov)?))
}

/// So many radii at equal steps from 1 to 2.
fn radii(value: f64) -> impl Iterator<Item = f32> {
    let last = (number(value).max(2) - 1) as f32;
    (0..number(value)).map(move |index| 1.0 + index as f32 / last)
}
