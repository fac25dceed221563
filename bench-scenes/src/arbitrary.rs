//! Scenes of any kind by seed: what a claim about all scenes is tried on.

use glam::DVec3;
use metaball_core::{Kernel, Metaball, Scene, SceneError};

use crate::random::Random;

/// Scales of scenes: what a radius of 1 becomes.
const SCALES: [f64; 12] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];

/// Distances of scenes from the origin, in radii.
const OFFSETS: [f64; 5] = [1.0, 10.0, 100.0, 1e3, 1e4];

/// The most balls of a scene.
const MOST_BALLS: f64 = 300.0;

/// A scene of 1 to 300 balls, the same for the same seed: any kernel, sparse to dense, radii equal, mixed
/// or in ratios up to 1 : 100,000 with small balls at the surfaces of large ones, strengths equal or
/// from a hundredth to a hundred, centres that coincide or lie on a grid, from scale 1e-4 to 1e7, up to
/// 10,000 radii away from the origin.
///
/// # Errors
/// When the balls make no scene, which those of no seed do.
pub fn arbitrary(seed: u64) -> Result<Scene, SceneError> {
    let mut random = Random::new(seed);
    let kernels: Vec<_> = Kernel::all().collect();
    let kernel = random.one_of(&kernels);
    let count = 1 + (random.unit().powi(3) * MOST_BALLS) as usize;
    // Radius of the ball in which centres lie, for so many radii of free space around each on average.
    let extent = random.one_of(&[0.35, 0.5, 0.8, 1.2]) * (count as f64).cbrt();
    let sizes = random.one_of(&[Sizes::Equal, Sizes::Equal, Sizes::Mixed, Sizes::Ratio]);
    let ratio = random.one_of(&[10.0, 100.0, 1e3, 1e4, 1e5]);
    let strengths =
        random.one_of(&[Strengths::One, Strengths::One, Strengths::Mixed, Strengths::Wide]);
    let twins = random.one_of(&[0.0, 0.0, 0.0, 0.25]);
    let is_grid = random.unit() < 0.125;

    let mut balls: Vec<(DVec3, f64, f64)> = Vec::with_capacity(count);
    for index in 0..count {
        let mut center = extent * random.in_ball();
        if is_grid {
            center = (2.0 * center).round() / 2.0;
        }
        let mut radius = match sizes {
            Sizes::Equal | Sizes::Ratio => 1.0,
            Sizes::Mixed => random.between(0.4, 1.6),
        };
        if index > 0 && random.unit() < twins {
            let other = (random.unit() * index as f64) as usize;
            center = balls[other].0;
        } else if index > 0 && sizes == Sizes::Ratio && random.unit() < 0.7 {
            // Where the surface of a large ball is likely to be.
            let other = (random.unit() * index as f64) as usize;
            center =
                balls[other].0 + random.direction() * balls[other].1 * random.between(0.2, 1.0);
            radius = random.between(1.0, 3.0) / ratio;
        }
        let strength = match strengths {
            Strengths::One => 1.0,
            Strengths::Mixed => random.between(0.2, 3.0),
            Strengths::Wide => random.one_of(&[0.01, 0.1, 1.0, 10.0, 100.0]),
        };
        balls.push((center, radius, strength));
    }

    let threshold = match (random.unit() * 8.0) as u32 {
        0 => random.one_of(&[1e-4, 1e-3, 1e-2, 0.99]),
        _ => random.between(0.05, 0.9),
    };
    let scale = random.one_of(&SCALES) * random.between(0.7, 1.4);
    let offset = if random.unit() < 0.5 { 0.0 } else { random.one_of(&OFFSETS) };
    let offset = offset * random.direction();
    let balls = balls.into_iter().map(|(center, radius, strength)| Metaball {
        center: (scale * (center + offset)).as_vec3(),
        radius: (scale * radius) as f32,
        strength: strength as f32,
    });
    Scene::new(balls, kernel, threshold as f32)
}

/// [`arbitrary`] with every third ball negative, from a fifth to one and a half times as strong.
///
/// # Errors
/// As [`arbitrary`].
pub fn carved(seed: u64) -> Result<Scene, SceneError> {
    let scene = arbitrary(seed)?;
    let share = -Random::new(!seed).between(0.2, 1.5) as f32;
    let balls = scene.balls().enumerate().map(|(index, ball)| Metaball {
        strength: ball.strength * if index % 3 == 1 { share } else { 1.0 },
        ..ball
    });
    Scene::new(balls, scene.kernel(), scene.threshold())
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sizes {
    Equal,
    Mixed,
    Ratio,
}

#[derive(Debug, Clone, Copy)]
enum Strengths {
    One,
    Mixed,
    Wide,
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn every_seed_makes_a_scene_of_its_own() {
        let scenes: Vec<_> = (0..300).map(|seed| arbitrary(seed).expect("legal")).collect();
        assert_eq!(scenes[7], arbitrary(7).expect("legal"));
        assert_ne!(scenes[7], scenes[8]);
        for kernel in Kernel::all() {
            assert!(scenes.iter().any(|scene| scene.kernel() == kernel), "{kernel}");
        }
        let radii = |scene: &Scene| {
            let radii = scene.supports().iter().map(|support| support.radius);
            radii.fold((f32::INFINITY, 0.0f32), |(low, high), r| (low.min(r), high.max(r)))
        };
        let far = |scene: &Scene| scene.bounds().center().distance(Vec3::ZERO) / radii(scene).1;
        assert!(scenes.iter().any(|scene| radii(scene).0 < 2e-4));
        assert!(scenes.iter().any(|scene| radii(scene).1 > 5e6));
        assert!(scenes.iter().any(|scene| radii(scene).1 > 1e4 * radii(scene).0));
        assert!(scenes.iter().any(|scene| far(scene) > 9e3));
        assert!(scenes.iter().any(|scene| scene.len() == 1));
        assert!(scenes.iter().any(|scene| scene.len() > 200));
        assert!(scenes.iter().any(|scene| scene.strengths().is_some()));
        assert!(scenes.iter().all(|scene| scene.negative_ball().is_none()));
    }

    #[test]
    fn a_third_of_a_carved_scene_is_negative() {
        for seed in 0..50 {
            let scene = carved(seed).expect("legal");
            let negative = scene.balls().filter(Metaball::is_negative).count();
            assert_eq!(negative, (scene.len() + 1) / 3);
            assert_eq!(scene.supports(), arbitrary(seed).expect("legal").supports());
        }
    }
}
