//! Random scenes that shrink: the arrangements that builders stumble over.

use glam::Vec3;
use metaball_core::{Kernel, Metaball, Scene};
use proptest::prelude::*;

/// Any arrangement, kernel and threshold, of up to so many balls.
pub(crate) fn any_scene(balls: usize) -> impl Strategy<Value = Scene> {
    let kernels = prop::sample::select(Kernel::all().collect::<Vec<_>>());
    let thresholds = prop::sample::select(vec![0.05f32, 0.2, 0.5, 1.0, 3.0]);
    (any_balls(balls), kernels, thresholds).prop_map(|(balls, kernel, threshold)| {
        Scene::new(balls, kernel, threshold).expect("legal balls")
    })
}

/// As [`any_scene`], in half of the cases with every third ball negative.
pub(crate) fn any_signed_scene(balls: usize) -> impl Strategy<Value = Scene> {
    (any_scene(balls), prop::bool::ANY, 0.2f32..2.0).prop_map(|(scene, is_carved, share)| {
        let balls = scene.balls().enumerate().map(|(at, ball)| {
            let factor = if is_carved && at % 3 == 1 { -share } else { 1.0 };
            Metaball { strength: factor * ball.strength, ..ball }
        });
        Scene::new(balls, scene.kernel(), scene.threshold()).expect("legal balls")
    })
}

fn any_balls(count: usize) -> impl Strategy<Value = Vec<Metaball>> {
    prop_oneof![
        4 => scattered(count, 0.3f32..1.5, 0.5f32..3.0),
        1 => on_a_grid(count),
        1 => coincident(count),
        1 => nested(count),
        1 => one_huge(count),
        1 => flattened(count, Vec3::new(1.0, 0.0, 1.0)),
        1 => flattened(count, Vec3::X),
        1 => scattered(count, prop::sample::select(vec![1e-4f32, 1e-2, 1.0, 1e2, 1e4]), Just(1.0)),
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    [-4.0f32..4.0, -4.0f32..4.0, -4.0f32..4.0].prop_map(Vec3::from)
}

fn scattered(
    count: usize,
    radii: impl Strategy<Value = f32>,
    strengths: impl Strategy<Value = f32>,
) -> impl Strategy<Value = Vec<Metaball>> {
    let ball = (point(), radii, strengths).prop_map(|(center, radius, strength)| Metaball {
        center,
        radius,
        strength,
    });
    prop::collection::vec(ball, 0..count)
}

/// Centres, radii and so box faces on whole numbers.
fn on_a_grid(count: usize) -> impl Strategy<Value = Vec<Metaball>> {
    let ball = ([-3i8..=3, -3i8..=3, -3i8..=3], 1u8..=2).prop_map(|(center, radius)| {
        Metaball::new(Vec3::from(center.map(f32::from)), f32::from(radius))
    });
    prop::collection::vec(ball, 0..count)
}

fn coincident(count: usize) -> impl Strategy<Value = Vec<Metaball>> {
    (point(), prop::collection::vec(prop::sample::select(vec![0.5f32, 1.0]), 0..count)).prop_map(
        |(center, radii)| radii.into_iter().map(|radius| Metaball::new(center, radius)).collect(),
    )
}

/// Each ball inside the one before, close to its rim.
fn nested(count: usize) -> impl Strategy<Value = Vec<Metaball>> {
    (point(), 0..count.min(30)).prop_map(|(outer, count)| {
        (0..count)
            .map(|level| {
                let radius = 2.0 * 0.6f32.powi(level as i32);
                Metaball::new(outer + 0.3 * (2.0 - radius), radius)
            })
            .collect()
    })
}

fn one_huge(count: usize) -> impl Strategy<Value = Vec<Metaball>> {
    (point(), scattered(count, 0.05f32..0.2, Just(1.0))).prop_map(|(center, mut balls)| {
        balls.push(Metaball::new(center, 30.0));
        balls
    })
}

/// Centres in a plane or on a line.
fn flattened(count: usize, onto: Vec3) -> impl Strategy<Value = Vec<Metaball>> {
    scattered(count, 0.3f32..1.0, Just(1.0)).prop_map(move |mut balls| {
        balls.iter_mut().for_each(|ball| ball.center *= onto);
        balls
    })
}
