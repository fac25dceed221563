//! The oracle against closed forms, against marching, and against plain sampling.

use glam::{DVec3, Vec3};
use proptest::prelude::*;

use super::{March, Oracle, Truth, march};
use crate::{Kernel, Metaball, NO_LIMIT, Ray, Scene, Verdict};

/// A small generator of random numbers (Steele et al. 2014, "Fast splittable pseudorandom number
/// generators"), so that a failing scene is found again.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 40) as f32 / (1u32 << 24) as f32
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Evenly from the cube from −half to half.
    fn cube(&mut self, half: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.between(-half, half)))
    }

    /// A direction, not evenly spread.
    fn direction(&mut self) -> Vec3 {
        self.cube(1.0).try_normalize().unwrap_or(Vec3::Z)
    }

    /// Overlapping balls in the cube from −1 to 1, the largest `ratio` times the smallest.
    fn scene(&mut self, kernel: Kernel, balls: usize, ratio: f32) -> Scene {
        self.scene_of(Signs::Positive, kernel, balls, ratio)
    }

    fn scene_of(&mut self, signs: Signs, kernel: Kernel, balls: usize, ratio: f32) -> Scene {
        let balls: Vec<_> = (0..balls)
            .map(|index| Metaball {
                center: self.cube(1.0),
                radius: 0.9 * ratio.powf(-self.unit()),
                strength: signs.of(index) * self.between(0.3, 2.0),
            })
            .collect();
        scene(balls, kernel, self.between(0.05, 0.9))
    }

    /// A ray from `distance` away towards somewhere in or near the support of one of the balls.
    fn ray(&mut self, scene: &Scene, distance: f32) -> Ray {
        let ball = scene.ball((self.unit() * scene.len() as f32) as usize);
        let target = ball.center + ball.radius * self.cube(1.0);
        let origin = target + distance * self.direction();
        Ray::new(origin, (target - origin).try_normalize().unwrap_or(Vec3::Z))
    }
}

/// Which balls of a scene are negative.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Signs {
    Positive,
    /// Every third is negative, but not the first.
    Mixed,
}

impl Signs {
    const BOTH: [Self; 2] = [Self::Positive, Self::Mixed];

    fn of(self, index: usize) -> f32 {
        if self == Self::Mixed && index % 3 == 2 { -1.0 } else { 1.0 }
    }
}

fn scene(balls: impl IntoIterator<Item = Metaball>, kernel: Kernel, threshold: f32) -> Scene {
    Scene::new(balls, kernel, threshold).expect("a legal scene")
}

/// Distance along the ray to the point nearest to `center`, and the distance there.
fn nearest(ray: &Ray, center: Vec3) -> (f64, f64) {
    let (direction, offset) = (ray.direction.as_dvec3(), center.as_dvec3() - ray.origin.as_dvec3());
    let t = offset.dot(direction) / direction.length_squared();
    (t, (offset - t * direction).length())
}

mod closed_forms {
    use super::*;

    /// `copies` coincident balls are a sphere whose radius the kernel's inverse gives. Rays that
    /// pass within 0.999 of it meet it at an angle of at least 2.6°, so t errs by some roundings of
    /// R/0.045, below 1e-13; the eye is at least one R away.
    #[track_caller]
    fn check_sphere(copies: usize, distance: f32) {
        let mut random = Random(copies as u64);
        for kernel in Kernel::all() {
            for _ in 0..200 {
                let ball = Metaball {
                    center: random.cube(3.0),
                    radius: random.between(0.5, 2.0),
                    strength: random.between(0.5, 2.0),
                };
                let level = random.between(0.1, 0.9);
                let threshold = level * ball.strength * copies as f32;
                let scene = scene(vec![ball; copies], kernel, threshold);
                let share = f64::from(threshold) / (f64::from(ball.strength) * copies as f64);
                let radius = f64::from(ball.radius)
                    * kernel.ratio_at(share).expect("the threshold is reached");

                let ray = random.ray(&scene, distance * ball.radius);
                let (middle, from_center) = nearest(&ray, ball.center);
                let truth = Oracle::new(&scene).first_hit(&ray);
                let is_clear = (from_center / radius - 1.0).abs() > 1e-3;
                if from_center > radius {
                    assert!(truth.verdict == Verdict::Miss || !is_clear, "{kernel}: {truth:?}");
                    assert!(!truth.t.is_finite() || !is_clear);
                    let field = kernel.value((from_center / f64::from(ball.radius)).powi(2));
                    assert!((truth.margin - (1.0 - field / share).abs()).abs() < 1e-8);
                } else if is_clear {
                    let half = (radius * radius - from_center * from_center).sqrt()
                        / ray.direction.as_dvec3().length();
                    assert_eq!(truth.verdict, Verdict::Hit, "{kernel}: {truth:?}");
                    assert!((truth.t / (middle - half) - 1.0).abs() < 1e-12, "{kernel}: {truth:?}");
                    assert!((truth.exit / (middle + half) - 1.0).abs() < 1e-12);
                    let outward = ray.origin.as_dvec3() + truth.t * ray.direction.as_dvec3()
                        - ball.center.as_dvec3();
                    assert!((outward.normalize() - truth.normal).length() < 1e-9);
                    assert_eq!(truth.smallest_radius, ball.radius);
                }
            }
        }
    }

    #[test]
    fn one_ball() {
        check_sphere(1, 4.0);
    }

    #[test]
    fn one_ball_from_ten_thousand_radii() {
        check_sphere(1, 1e4);
    }

    #[test]
    fn two_coincident_balls() {
        check_sphere(2, 4.0);
    }

    #[test]
    fn fifteen_coincident_balls() {
        check_sphere(15, 4.0);
    }

    #[test]
    fn four_thousand_coincident_balls() {
        let scene = scene(vec![Metaball::new(Vec3::ZERO, 1.0); 4096], Kernel::QUARTIC, 2048.0);
        let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::Z * 3.0, Vec3::NEG_Z));
        // v² = 1/2.
        let radius = (1.0 - 0.5f64.sqrt()).sqrt();
        approx::assert_abs_diff_eq!(truth.t, 3.0 - radius, epsilon = 1e-12);
        approx::assert_abs_diff_eq!(truth.margin, 1.0, epsilon = 1e-9);
    }

    /// Centres within 0.5e-3·√3 of one point put the surface within as much of the coincident one.
    /// Eight thousand events close together: a second's work a ray if each visited all balls.
    #[test]
    fn four_thousand_nearly_coincident_balls() {
        let mut random = Random(5);
        let balls: Vec<_> = (0..4096).map(|_| Metaball::new(random.cube(0.5e-3), 1.0)).collect();
        for kernel in Kernel::all() {
            let scene = scene(balls.iter().copied(), kernel, 2048.0);
            let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::Z * 3.0, Vec3::NEG_Z));
            let radius = kernel.ratio_at(0.5).expect("reached");
            approx::assert_abs_diff_eq!(truth.t, 3.0 - radius, epsilon = 0.9e-3);
            approx::assert_abs_diff_eq!(truth.exit, 3.0 + radius, epsilon = 0.9e-3);
        }
    }

    /// With α = 1 two balls make spheres: the sum of two paraboloids is a paraboloid. Along the
    /// axis through centres at ±c, 2(1 − (t² + c²)/R²) = T where both are positive.
    #[test]
    fn two_balls_apart() {
        let kernel = Kernel::power(1).expect("legal");
        let ball = |x| Metaball::new(Vec3::X * x, 2.0);
        let scene = scene([ball(-0.5), ball(0.5)], kernel, 1.5);
        let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::X * 5.0, Vec3::NEG_X));
        approx::assert_abs_diff_eq!(truth.t, 5.0 - 0.75f64.sqrt(), epsilon = 1e-14);
        approx::assert_abs_diff_eq!(truth.exit, 5.0 + 0.75f64.sqrt(), epsilon = 1e-14);
        // In the middle the field is 2(1 − 1/16).
        approx::assert_abs_diff_eq!(truth.margin, 1.875 / 1.5 - 1.0, epsilon = 1e-9);
    }

    /// With α = 1 what a negative ball leaves of a larger one around it is 1 − t²/4 outside of it, and
    /// 1 − t²/4 − (1 − t²) inside: a shell.
    #[test]
    fn a_ball_in_a_ball() {
        let outer = Metaball::new(Vec3::ZERO, 2.0);
        let inner = Metaball { strength: -1.0, ..Metaball::new(Vec3::ZERO, 1.0) };
        let scene = scene([outer, inner], Kernel::power(1).expect("legal"), 0.5);
        let oracle = Oracle::new(&scene);
        let truth = oracle.first_hit(&Ray::new(Vec3::X * 5.0, Vec3::NEG_X));
        let (surface, hollow) = (2.0f64.sqrt(), (2.0f64 / 3.0).sqrt());
        approx::assert_abs_diff_eq!(truth.t, 5.0 - surface, epsilon = 1e-14);
        approx::assert_abs_diff_eq!(truth.exit, 5.0 - hollow, epsilon = 1e-14);
        // The field is greatest at the inner ball's rim.
        approx::assert_abs_diff_eq!(truth.margin, 0.75 / 0.5 - 1.0, epsilon = 1e-9);
        let within = oracle.first_hit(&Ray::new(Vec3::ZERO, Vec3::X));
        assert_eq!((within.verdict, within.normal), (Verdict::Hit, DVec3::NEG_X));
        approx::assert_abs_diff_eq!(within.t, hollow, epsilon = 1e-14);
        approx::assert_abs_diff_eq!(within.exit, surface, epsilon = 1e-14);
    }

    /// What takes away as much as is added, to a part of T, leaves a field that is all rounding.
    #[test]
    fn balls_that_cancel() {
        for kernel in Kernel::all() {
            let mut random = Random(23);
            let pair = |center| {
                let ball = Metaball { strength: 1e6, ..Metaball::new(center, 1.0) };
                [ball, Metaball { strength: -ball.strength, ..ball }]
            };
            let balls: Vec<_> = (0..6).flat_map(|_| pair(random.cube(0.5))).collect();
            let lone = Metaball::new(Vec3::ZERO, 1.0);
            let (field, alone) = (
                scene(balls.iter().copied().chain([lone]), kernel, 0.5),
                scene([lone], kernel, 0.5),
            );
            for _ in 0..20 {
                let ray = random.ray(&alone, 3.0);
                let expected = Oracle::new(&alone).first_hit(&ray);
                let truth = Oracle::new(&field).first_hit(&ray);
                if expected.margin > 1e-6 {
                    assert_eq!(truth.verdict, expected.verdict, "{kernel}");
                    assert!(truth.verdict == Verdict::Miss || (truth.t - expected.t).abs() < 1e-6);
                }
            }
        }
    }

    /// Balls that touch: the chords have an end in common and the field a zero between two sheets.
    #[test]
    fn touching_balls() {
        for kernel in Kernel::all() {
            let ball = |x| Metaball::new(Vec3::X * x, 1.0);
            let scene = scene([ball(-1.0), ball(1.0)], kernel, 0.5);
            let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::X * -5.0, Vec3::X));
            let radius = kernel.ratio_at(0.5).expect("reached");
            approx::assert_abs_diff_eq!(truth.t, 4.0 - radius, epsilon = 1e-12);
            approx::assert_abs_diff_eq!(truth.exit, 4.0 + radius, epsilon = 1e-12);
        }
    }
}

mod edges {
    use super::*;

    fn one_ball(threshold: f32) -> Scene {
        scene([Metaball::new(Vec3::ZERO, 1.0)], Kernel::power(1).expect("legal"), threshold)
    }

    #[test]
    fn nothing_there() {
        let scene = scene([], Kernel::QUARTIC, 0.5);
        let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::ZERO, Vec3::Z));
        assert_eq!(truth.verdict, Verdict::Miss);
        assert!(truth.t.is_infinite() && truth.exit.is_infinite());
        assert_eq!((truth.normal, truth.margin, truth.smallest_radius), (DVec3::ZERO, 1.0, 0.0));
    }

    #[test]
    fn threshold_above_the_field() {
        let truth = Oracle::new(&one_ball(1.25)).first_hit(&Ray::new(Vec3::X * 3.0, Vec3::NEG_X));
        assert_eq!(truth.verdict, Verdict::Miss);
        approx::assert_abs_diff_eq!(truth.margin, 0.2, epsilon = 1e-9);
    }

    #[test]
    fn eye_inside() {
        let scene = one_ball(0.5);
        let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::X * 0.5, Vec3::X));
        assert_eq!((truth.verdict, truth.t, truth.normal), (Verdict::Inside, 0.0, DVec3::X));
        approx::assert_abs_diff_eq!(truth.exit, 0.5f64.sqrt() - 0.5, epsilon = 1e-14);
        approx::assert_abs_diff_eq!(truth.margin, 0.5, epsilon = 1e-14);
        let middle = Oracle::new(&scene).first_hit(&Ray::new(Vec3::ZERO, Vec3::X));
        assert_eq!((middle.verdict, middle.normal), (Verdict::Inside, DVec3::ZERO));
    }

    /// 1 − 1/4 is exactly the threshold.
    #[test]
    fn eye_on_the_surface() {
        let scene = one_ball(0.75);
        for direction in [Vec3::X, Vec3::NEG_X, Vec3::Y] {
            let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::X * 0.5, direction));
            assert_eq!((truth.verdict, truth.t, truth.margin), (Verdict::Inside, 0.0, 0.0));
        }
    }

    #[test]
    fn eye_in_a_support() {
        let truth = Oracle::new(&one_ball(0.5)).first_hit(&Ray::new(Vec3::X * 0.9, Vec3::NEG_X));
        assert_eq!(truth.verdict, Verdict::Hit);
        approx::assert_abs_diff_eq!(truth.t, f64::from(0.9f32) - 0.5f64.sqrt(), epsilon = 1e-14);
    }

    #[test]
    fn surface_behind_the_eye() {
        let truth = Oracle::new(&one_ball(0.5)).first_hit(&Ray::new(Vec3::X * 0.9, Vec3::X));
        assert_eq!(truth.verdict, Verdict::Miss);
        // The field falls from 1 − 0.81 at the start.
        approx::assert_abs_diff_eq!(truth.margin, 1.0 - 0.19 / 0.5, epsilon = 1e-6);
    }

    #[test]
    fn opaque_things_end_the_ray() {
        let scene = one_ball(0.75);
        let trace = |t_max| {
            let ray = Ray { t_max, ..Ray::new(Vec3::X * 3.0, Vec3::NEG_X) };
            Oracle::new(&scene).first_hit(&ray)
        };
        // The ball spans t from 2.5 to 3.5.
        assert_eq!(trace(2.25).verdict, Verdict::Miss);
        assert_eq!(trace(2.75).verdict, Verdict::Hit);
        assert_eq!(trace(2.75).exit, 2.75);
        assert_eq!(trace(4.0).exit, 3.5);
        // At the end the field is 1 − 0.75² and 1 − 0.25², to the rounding of the ray.
        approx::assert_abs_diff_eq!(trace(2.25).margin, 1.0 - 0.4375 / 0.75, epsilon = 1e-9);
        approx::assert_abs_diff_eq!(trace(2.75).margin, 0.9375 / 0.75 - 1.0, epsilon = 1e-9);
        for t_max in [0.0, -1.0, f32::NAN] {
            assert_eq!(trace(t_max).verdict, Verdict::Miss);
        }
        for t_max in [f32::INFINITY, NO_LIMIT] {
            assert_eq!(trace(t_max), trace(10.0));
        }
    }

    #[test]
    fn rays_start_where_they_say() {
        let scene = one_ball(0.75);
        let trace = |t_min, t_max| {
            let ray = Ray { t_min, t_max, ..Ray::new(Vec3::X * 3.0, Vec3::NEG_X) };
            Oracle::new(&scene).first_hit(&ray)
        };
        // The ball spans t from 2.5 to 3.5.
        let whole = trace(0.0, NO_LIMIT);
        assert_eq!(trace(2.25, NO_LIMIT).t, whole.t);
        let inside = trace(2.75, NO_LIMIT);
        assert_eq!((inside.verdict, inside.t, inside.exit), (Verdict::Inside, 2.75, 3.5));
        assert_eq!(inside.normal, DVec3::X);
        // At the start the field is 1 − 0.25².
        approx::assert_abs_diff_eq!(inside.margin, 0.9375 / 0.75 - 1.0, epsilon = 1e-9);
        assert_eq!(trace(2.75, 3.0).exit, 3.0);
        assert_eq!(trace(2.75, 2.75).verdict, Verdict::Inside);
        assert_eq!(trace(3.75, NO_LIMIT).verdict, Verdict::Miss);
        for (t_min, t_max) in [(3.0, 2.9), (3.0, f32::NAN), (f32::NAN, 4.0)] {
            let nothing = trace(t_min, t_max);
            assert_eq!((nothing.verdict, nothing.margin), (Verdict::Miss, f64::INFINITY));
        }
    }

    #[test]
    fn rays_without_meaning_do_no_harm() {
        for kernel in Kernel::all() {
            let scene = scene([Metaball::new(Vec3::ZERO, 1.0)], kernel, 0.5);
            let oracle = Oracle::new(&scene);
            for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::splat(f32::MIN_POSITIVE)] {
                assert_eq!(oracle.first_hit(&Ray::new(Vec3::X * 3.0, bad)).verdict, Verdict::Miss);
                assert_eq!(oracle.first_hit(&Ray::new(Vec3::ZERO, bad)).verdict, Verdict::Inside);
            }
            for bad in [Vec3::NAN, Vec3::INFINITY] {
                assert_eq!(oracle.first_hit(&Ray::new(bad, Vec3::X)).verdict, Verdict::Miss);
            }
        }
    }

    /// Towards tangency the margin must go to zero with the distance: k(d²) − T changes by k′·Δ(d²).
    #[test]
    fn margins_of_grazing_rays() {
        for kernel in Kernel::all() {
            let scene = scene([Metaball::new(Vec3::ZERO, 1.0)], kernel, 0.5);
            let oracle = Oracle::new(&scene);
            let radius = kernel.ratio_at(0.5).expect("reached");
            for step in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, -1e-6, -1e-5, -1e-4, -1e-3, -1e-2] {
                let distance = (radius * (1.0 + step)) as f32;
                let ray = Ray::new(Vec3::new(distance, 0.0, 3.0), Vec3::NEG_Z);
                let truth = oracle.first_hit(&ray);
                let field = kernel.value(f64::from(distance).powi(2));
                let expected = if field < 0.5 { Verdict::Miss } else { Verdict::Hit };
                assert_eq!(truth.verdict, expected, "{kernel} at {step}");
                assert!((truth.margin - (field / 0.5 - 1.0).abs()).abs() < 2e-9);
            }
        }
    }
}

mod against_marching {
    use super::*;

    /// Whether the two agree; `None` where marching is too coarse: its intervals end at a width of
    /// `width`, on which the balls vary by at most Σ q·3.1/R·width (3.1 exceeds |dk/dρ| of every
    /// kernel, α = 8 having the steepest).
    fn agree(scene: &Scene, truth: &Truth, march: &March) -> Option<bool> {
        let smallest =
            scene.supports().iter().map(|support| support.radius).fold(f32::INFINITY, f32::min);
        let width = 2e-10 * (20.0 + f64::from(smallest));
        let steepness: f64 = scene
            .balls()
            .map(|ball| f64::from(ball.strength.abs()) * 3.1 / f64::from(ball.radius))
            .sum();
        if truth.margin * f64::from(scene.threshold()) <= 2.0 * width * steepness {
            return None;
        }
        // Both know t to better than 1e-12; an interval's ends are exact numbers.
        let is_within = truth.verdict != Verdict::Hit
            || (march.low <= truth.t * (1.0 + 1e-12) && truth.t * (1.0 - 1e-12) <= march.high);
        Some(truth.verdict == march.verdict && is_within)
    }

    /// Compares rays with the oracle of one scene against marching in another. Returns the numbers
    /// of rays that agree, that differ, and that cannot be compared.
    fn compare(oracle_scene: &Scene, march_scene: &Scene, rays: &[Ray]) -> [usize; 3] {
        let truths = Oracle::new(oracle_scene).first_hits(rays);
        let mut counts = [0; 3];
        for (ray, truth) in rays.iter().zip(&truths) {
            let march = march(march_scene, ray);
            match agree(oracle_scene, truth, &march) {
                Some(true) => counts[0] += 1,
                Some(false) => counts[1] += 1,
                None => counts[2] += 1,
            }
        }
        counts
    }

    fn rays(random: &mut Random, scene: &Scene, count: usize) -> Vec<Ray> {
        (0..count)
            .map(|_| {
                // Half the eyes stand among the balls.
                let reach = if random.unit() < 0.5 { 1.0 } else { 16.0 };
                let distance = reach * random.unit();
                let ray = random.ray(scene, distance);
                let t_max = if random.unit() < 0.2 { 3.0 * random.unit() } else { NO_LIMIT };
                // Before the balls, among them, behind them, and behind the ray's end.
                let t_min =
                    if random.unit() < 0.3 { distance + 2.0 * random.unit() - 1.0 } else { 0.0 };
                Ray { t_min: t_min.max(0.0), t_max, ..ray }
            })
            .collect()
    }

    #[test]
    fn both_oracles_agree() {
        let positive = [(1, 1.0), (2, 3.0), (12, 4.0), (30, 100.0), (60, 2.0)];
        let positive = positive.map(|(balls, ratio)| (Signs::Positive, balls, ratio));
        let mixed = [(3, 3.0), (12, 4.0), (30, 100.0), (60, 2.0)];
        let mixed = mixed.map(|(balls, ratio)| (Signs::Mixed, balls, ratio));
        for (signs, balls, ratio) in positive.into_iter().chain(mixed) {
            for kernel in Kernel::all() {
                let mut random = Random(balls as u64);
                let mut counts = [0; 3];
                for _ in 0..12 {
                    let scene = random.scene_of(signs, kernel, balls, ratio);
                    let rays = rays(&mut random, &scene, 40);
                    for (sum, count) in counts.iter_mut().zip(compare(&scene, &scene, &rays)) {
                        *sum += count;
                    }
                }
                let [agreeing, differing, unknown] = counts;
                assert_eq!(differing, 0, "{kernel}, {balls} balls: {counts:?}");
                assert!(unknown * 50 < agreeing, "{kernel}, {balls} balls: {counts:?}");
            }
        }
    }

    /// Canary: one ball less, one moved by a thousandth of its radius, or a start that is ignored must be
    /// noticed on rays towards that ball.
    #[test]
    fn a_wrong_oracle_is_caught() {
        for (signs, kernel) in Signs::BOTH
            .into_iter()
            .flat_map(|signs| Kernel::all().map(move |kernel| (signs, kernel)))
        {
            let mut random = Random(7);
            let right = random.scene_of(signs, kernel, 5, 3.0);
            // Below the greatest field of the first ball alone, so that it makes a surface.
            let threshold = 0.25 * right.ball(0).strength;
            let right = right.with_threshold(threshold).expect("legal");
            let first = scene([right.ball(0)], kernel, threshold);
            let rays = rays(&mut random, &first, 200);
            assert_eq!(compare(&right, &right, &rays)[1], 0, "{kernel}");

            let missing = scene(right.balls().skip(1), kernel, threshold);
            assert!(compare(&missing, &right, &rays)[1] > 10, "{kernel}");
            let moved = right.balls().enumerate().map(|(index, mut ball)| {
                ball.center.x += if index == 0 { 1e-3 * ball.radius } else { 0.0 };
                ball
            });
            assert!(compare(&scene(moved, kernel, threshold), &right, &rays)[1] > 10, "{kernel}");

            let late = |ray: &&Ray| ray.t_min > 0.0 && !ray.is_empty();
            let differs = |ray: &Ray| {
                let whole = Ray { t_min: 0.0, ..*ray };
                let truth = Oracle::new(&right).first_hit(&whole);
                agree(&right, &truth, &march(&right, ray)) == Some(false)
            };
            assert!(rays.iter().filter(late).any(differs), "{kernel}");
        }
    }
}

mod against_sampling {
    use super::*;

    const SAMPLES: usize = 20_000;

    /// The margin by its definition, from evenly spaced samples of the field.
    fn sampled_margin(samples: &[f64], truth: &Truth, step: f64, threshold: f64) -> f64 {
        let hit = ((truth.t / step).ceil() as usize).min(samples.len() - 1);
        let exit = ((truth.exit / step).floor() as usize).min(samples.len() - 1);
        let distance = |value: f64| (value - threshold).abs() / threshold;
        let mut margin = distance(samples[0]);
        for triple in samples[..=hit].windows(3) {
            if triple[0] <= triple[1] && triple[1] >= triple[2] && triple[1] < threshold {
                margin = margin.min(distance(triple[1]));
            }
        }
        if truth.verdict == Verdict::Hit && hit <= exit {
            let highest = samples[hit..=exit].iter().copied().fold(threshold, f64::max);
            margin = margin.min(distance(highest));
        }
        margin
    }

    /// A maximum lies within half a step of a sample, and the field's second derivative is at most
    /// Σ q·16/R² (16 = 2α for α = 8 exceeds |d²k/dρ²| of all kernels), so sampling errs by less than
    /// that times step²/8. For α = 1 the field has kinks and sampling errs by the slope, Σ q·2/R,
    /// times step/2.
    #[test]
    fn samples_agree() {
        let mut clear = 0;
        for kernel in Kernel::all() {
            let mut random = Random(3);
            for round in 0..60 {
                let signs = Signs::BOTH[round % 2];
                let scene = random.scene_of(signs, kernel, 12, 2.0);
                let threshold = f64::from(scene.threshold());
                let ray = Ray { t_max: 8.0, ..random.ray(&scene, 3.0) };
                let oracle = Oracle::new(&scene);
                let truth = oracle.first_hit(&ray);
                let step = f64::from(ray.t_max) / SAMPLES as f64;
                let at = |index: usize| index as f64 * step;
                let samples: Vec<f64> = (0..=SAMPLES)
                    .map(|index| {
                        let point = ray.origin.as_dvec3() + at(index) * ray.direction.as_dvec3();
                        oracle.field(point)
                    })
                    .collect();

                for (index, &sample) in samples.iter().enumerate() {
                    if at(index) < truth.t - 1e-9 {
                        assert!(sample < threshold, "{kernel}: {truth:?}");
                    } else if at(index) > truth.t + 1e-9 && at(index) < truth.exit - 1e-9 {
                        assert!(sample >= threshold, "{kernel}: {truth:?}");
                    }
                }
                let sum = |term: fn(f64) -> f64| -> f64 {
                    let share =
                        |ball: Metaball| f64::from(ball.strength.abs()) * term(ball.radius.into());
                    scene.balls().map(share).sum()
                };
                let error = if kernel == Kernel::power(1).expect("legal") {
                    sum(|radius| 2.0 / radius) * step / 2.0
                } else {
                    sum(|radius| 16.0 / (radius * radius)) * step * step / 8.0
                };
                let sampled = sampled_margin(&samples, &truth, step, threshold);
                assert!(
                    (sampled - truth.margin).abs() <= error / threshold + 1e-9,
                    "{kernel}: {truth:?}, sampled {sampled}"
                );
                clear += usize::from(truth.margin < 0.9);
            }
        }
        // The margin must have been something else than that of an empty start.
        assert!(clear > 100, "{clear}");
    }
}

mod invariance {
    use super::*;

    fn fixture(kernel: Kernel) -> (Scene, Vec<Ray>) {
        let mut random = Random(11);
        let scene = random.scene(kernel, 20, 10.0);
        let rays = (0..100).map(|_| random.ray(&scene, 5.0)).collect();
        (scene, rays)
    }

    #[test]
    fn threads_and_order_do_not_matter() {
        for kernel in Kernel::all() {
            let (scene, mut rays) = fixture(kernel);
            let oracle = Oracle::new(&scene);
            let truths = oracle.first_hits(&rays);
            let single = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
            assert_eq!(single.install(|| oracle.first_hits(&rays)), truths);
            rays.reverse();
            assert!(oracle.first_hits(&rays).iter().eq(truths.iter().rev()));
        }
    }

    /// Scaling by a power of two, from 1e-4 to 1e4, rounds nothing: every bit must follow.
    #[test]
    fn scale_does_not_matter() {
        for kernel in Kernel::all() {
            let (unscaled, rays) = fixture(kernel);
            let expected = Oracle::new(&unscaled).first_hits(&rays);
            for scale in [-13, 13].map(|exponent| 2f32.powi(exponent)) {
                let balls = unscaled.balls().map(|ball| Metaball {
                    center: scale * ball.center,
                    radius: scale * ball.radius,
                    ..ball
                });
                let scaled = scene(balls, kernel, unscaled.threshold());
                let oracle = Oracle::new(&scaled);
                for (ray, expected) in rays.iter().zip(&expected) {
                    let truth = oracle.first_hit(&Ray { origin: scale * ray.origin, ..*ray });
                    assert_eq!(truth.t, f64::from(scale) * expected.t);
                    assert_eq!(truth.margin, expected.margin);
                    assert!((truth.normal - expected.normal).length() < 1e-15);
                }
            }
        }
    }

    /// On a grid of 1/256 up to 16,384 the move is exact in f32. What remains is the rounding of f64
    /// at 1e4, 2e-12, times what a crossing amplifies it by: 1e3 at margins of 1e-6.
    #[test]
    fn offsets_do_not_matter() {
        let snap = |point: Vec3| (point * 256.0).round() / 256.0;
        for kernel in Kernel::all() {
            let (near, rays) = fixture(kernel);
            let moved = |offset: Vec3| {
                let balls = near
                    .balls()
                    .map(|ball| Metaball { center: snap(ball.center) + offset, ..ball });
                scene(balls, kernel, near.threshold())
            };
            let offset = Vec3::new(1e4, -1e4, 8192.0);
            let (here, there) = (moved(Vec3::ZERO), moved(offset));
            let (here, there) = (Oracle::new(&here), Oracle::new(&there));
            for ray in &rays {
                let ray = Ray { origin: snap(ray.origin), ..*ray };
                let expected = here.first_hit(&ray);
                let truth = there.first_hit(&Ray { origin: ray.origin + offset, ..ray });
                if expected.margin > 1e-6 {
                    assert_eq!(truth.verdict, expected.verdict);
                    if truth.verdict != Verdict::Miss {
                        assert!((truth.t - expected.t).abs() < 2e-9);
                        assert!((truth.normal - expected.normal).length() < 1e-6);
                    }
                }
            }
        }
    }

    proptest! {
        /// Whatever the scene, the answer is one: finite where it must be, in order, of unit length.
        #[test]
        fn answers_are_well_formed(
            seed: u64,
            kernel in proptest::sample::select(Kernel::all().collect::<Vec<_>>()),
            signs in proptest::sample::select(Signs::BOTH.to_vec()),
            balls in 0usize..40,
            log_ratio in 0.0f32..9.0,
            log_distance in -3.0f32..6.0,
        ) {
            let mut random = Random(seed);
            let scene = random.scene_of(signs, kernel, balls, 10f32.powf(log_ratio));
            let ray = if scene.is_empty() {
                Ray::new(Vec3::ZERO, Vec3::Z)
            } else {
                random.ray(&scene, 10f32.powf(log_distance))
            };
            let truth = Oracle::new(&scene).first_hit(&ray);
            prop_assert!(truth.margin >= 0.0 && truth.margin.is_finite());
            prop_assert!(truth.exit >= truth.t);
            match truth.verdict {
                Verdict::Miss => {
                    prop_assert!(truth.t.is_infinite());
                    prop_assert!(truth.margin <= 1.0 || signs == Signs::Mixed);
                }
                Verdict::Hit => {
                    prop_assert!(truth.t >= 0.0 && truth.exit.is_finite());
                    prop_assert!(truth.smallest_radius > 0.0);
                    prop_assert!(truth.margin <= 1.0 || signs == Signs::Mixed);
                }
                Verdict::Inside => prop_assert_eq!(truth.t, 0.0),
                Verdict::Undecided => prop_assert!(false, "the oracle decides"),
            }
            prop_assert!(truth.normal == DVec3::ZERO || truth.normal.is_normalized());
        }
    }
}
