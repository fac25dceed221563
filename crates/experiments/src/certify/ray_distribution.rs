//! How the rays of a test scene are distributed: each kind meets something that is hard.

use std::fmt;

use bench_scenes::Random;
use fbvh::Tree;
use glam::{DVec3, Vec3};
use metaball_core::reference::Truth;
use metaball_core::{Camera, Ray, Scene, Verdict};
use serde::{Deserialize, Serialize};

/// How a ray was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RayDistribution {
    /// Through a pixel of a picture, from 1 to 10,000 radii away.
    Picture,
    /// Towards a ball, from anywhere; some rays are short.
    Ball,
    /// Along the surface, past one of its points at up to a thousandth of its least radius.
    Tangent,
    /// Along a face of a leaf's box, an edge of it, or through a corner.
    Face,
    /// Out of the solid, from a point beneath the surface.
    Exit,
}

impl fmt::Display for RayDistribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Picture => "picture",
            Self::Ball => "ball",
            Self::Tangent => "tangent",
            Self::Face => "box face",
            Self::Exit => "from inside",
        })
    }
}

/// How near to tangency or to a face counts as near, radii.
pub const NEAR: f64 = 1e-3;

/// A ray to test a tracer with.
#[derive(Debug, Clone, Copy)]
pub struct TestRay {
    /// The ray.
    pub ray: Ray,
    /// How it was made.
    pub distribution: RayDistribution,
    /// Where along it, in t, it is within [`NEAR`] of tangency or of a face; `None` where it is not known to
    /// be.
    pub near: Option<Near>,
}

/// What a ray comes near to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Near {
    /// A point of the surface along which it runs; only if nothing lies before it.
    Tangency {
        /// Where, in t.
        t: f64,
        /// Radius of the ball there, scene units.
        radius: f64,
    },
    /// A face of a box.
    Face,
}

impl TestRay {
    fn new(ray: Ray, distribution: RayDistribution) -> Self {
        Self { ray, distribution, near: None }
    }

    /// Whether the ray is as near to tangency or to a face as it was meant to be, which for tangency is up
    /// to what lies before.
    pub fn is_near(&self, truth: &Truth) -> bool {
        match self.near {
            None => false,
            Some(Near::Face) => true,
            Some(Near::Tangency { t, radius }) => {
                truth.verdict == Verdict::Miss
                    || (truth.verdict == Verdict::Hit && truth.t >= t - 0.1 * radius)
            }
        }
    }
}

/// A point of the surface that a ray has found.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    point: DVec3,
    normal: DVec3,
    radius: f64,
}

impl SurfacePoint {
    /// Where the ray hits.
    pub fn new(ray: &Ray, truth: &Truth) -> Option<Self> {
        let radius = f64::from(truth.smallest_radius);
        let is_one = truth.verdict == Verdict::Hit && truth.normal != DVec3::ZERO && radius > 0.0;
        let point = ray.origin.as_dvec3() + truth.t * ray.direction.as_dvec3();
        is_one.then_some(Self { point, normal: truth.normal, radius })
    }
}

/// 10 to a power that is uniform between two.
pub fn decades(random: &mut Random, low: f64, high: f64) -> f64 {
    10f64.powf(random.between(low, high))
}

/// The ray through a point that starts so far before it; the direction is a unit vector.
fn through(point: DVec3, direction: DVec3, before: f64) -> Ray {
    Ray::new((point - before * direction).as_vec3(), direction.as_vec3())
}

/// Towards a point in or near a random ball, from up to 10,000 radii away; every fourth is short.
pub fn at_ball(scene: &Scene, random: &mut Random) -> TestRay {
    let ball = scene.ball((random.unit() * scene.len() as f64) as usize);
    let radius = f64::from(ball.radius);
    let target = ball.center.as_dvec3() + 1.1 * radius * random.in_ball();
    let high = random.one_of(&[1.0, 2.0, 4.0]);
    let before = radius * decades(random, -1.0, high);
    let mut ray = through(target, random.direction(), before);
    if random.unit() < 0.25 {
        ray.t_max = (before * random.between(0.0, 2.0)) as f32;
    }
    TestRay::new(ray, RayDistribution::Ball)
}

/// Past a point of the surface, along it: above or beneath by 1e-6 to 1e-3 of a radius. From afar rounding
/// moves it further off; it is near if it still is.
pub fn along_surface(surface: &SurfacePoint, random: &mut Random) -> TestRay {
    let SurfacePoint { point, normal, radius } = *surface;
    let side = random.one_of(&[-1.0, 1.0]);
    let lift = side * radius * decades(random, -6.0, -3.0);
    let high = random.one_of(&[1.0, 1.0, 4.0]);
    let before = radius * decades(random, 0.0, high);
    let along = normal.cross(random.direction()).try_normalize();
    let along = along.unwrap_or_else(|| normal.any_orthonormal_vector());
    let ray = through(point + lift * normal, along, before);

    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let t = (point - origin).dot(direction) / direction.length_squared();
    let distance = (origin + t * direction).distance(point);
    let near = (distance <= NEAR * radius).then_some(Near::Tangency { t, radius });
    TestRay { ray, distribution: RayDistribution::Tangent, near }
}

/// Along a face of a leaf, on it or up to a thousandth of a radius off; or along an edge, or through a
/// corner. Half of them run in planes of an axis exactly.
pub fn along_face(scene: &Scene, tree: &Tree, random: &mut Random) -> TestRay {
    let leaf = (random.unit() * tree.leaf_count() as f64) as usize;
    let bounds = tree.leaves()[leaf].bounds();
    let (own, split) = tree.leaf_balls(leaf);
    let radii = own.iter().chain(split).map(|&ball| scene.supports()[ball as usize].radius);
    let least = radii.fold(f32::INFINITY, f32::min);
    let any = || scene.supports()[0].radius;
    let radius = f64::from(if least.is_finite() { least } else { any() });

    let first = random.one_of(&[0, 1, 2]);
    // 1: a face, 2: an edge, 3: a corner.
    let axes = random.one_of(&[1, 1, 1, 1, 2, 2, 3]);
    let is_straight = random.unit() < 0.5;
    let extent = bounds.extent().as_dvec3();
    let size = extent.max_element().max(f64::MIN_POSITIVE);
    let mut point =
        bounds.min.as_dvec3() + extent * DVec3::from_array([(); 3].map(|()| random.unit()));
    let mut direction = random.direction();
    let mut exact = [None; 3];
    for offset in 0..axes {
        let axis = (first + offset) % 3;
        let face = random.one_of(&[bounds.min, bounds.max])[axis];
        point[axis] = f64::from(near_face(face, radius, random));
        if axes < 3 {
            let tilt = 0.5 * NEAR * radius / size;
            direction[axis] = if is_straight { 0.0 } else { tilt * random.between(-1.0, 1.0) };
            exact[axis] = is_straight.then_some(point[axis] as f32);
        }
    }
    let direction = direction.try_normalize().unwrap_or(DVec3::X);
    let before = random.one_of(&[0.0, 1.0, 1.0, 1.0]) * size * decades(random, -1.0, 2.0);
    let mut ray = through(point, direction, before);
    for (axis, coordinate) in exact.into_iter().enumerate() {
        ray.origin[axis] = coordinate.unwrap_or(ray.origin[axis]);
    }

    // How near to a face it passes, measured on the ray as it is sent.
    let (origin, sent) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let t = (point - origin).dot(sent) / sent.length_squared();
    let there = origin + t * sent;
    let nearest = |axis: usize| {
        let [low, high] =
            [bounds.min, bounds.max].map(|face| (f64::from(face[axis]) - there[axis]).abs());
        low.min(high)
    };
    let distance = (0..3).map(nearest).fold(f64::INFINITY, f64::min);
    let near = (distance <= NEAR * radius).then_some(Near::Face);
    TestRay { ray, distribution: RayDistribution::Face, near }
}

/// A face's coordinate, or one off by a float, or by 1e-7 to 1e-3 radii.
fn near_face(face: f32, radius: f64, random: &mut Random) -> f32 {
    match (random.unit() * 6.0) as u32 {
        0 | 1 => face,
        2 => face.next_up(),
        3 => face.next_down(),
        _ => {
            let side = random.one_of(&[-1.0, 1.0]);
            let off = side * 0.4 * radius * decades(random, -7.0, -3.0);
            (f64::from(face) + off) as f32
        }
    }
}

/// From beneath a point of the surface in any direction; every eighth is short.
pub fn from_inside(surface: &SurfacePoint, random: &mut Random) -> TestRay {
    let SurfacePoint { point, normal, radius } = *surface;
    let depth = 0.5 * radius * decades(random, -5.0, 0.0);
    let mut ray = through(point - depth * normal, random.direction(), 0.0);
    if random.unit() < 0.125 {
        ray.t_max = (radius * random.unit()) as f32;
    }
    TestRay::new(ray, RayDistribution::Exit)
}

/// A primary ray.
pub fn of_picture(ray: Ray) -> TestRay {
    TestRay::new(ray, RayDistribution::Picture)
}

/// A camera 1 to 10,000 radii away from a ball, with a lens that shows the whole scene, or the ball;
/// `None` where rounding leaves no direction.
pub fn camera(scene: &Scene, random: &mut Random) -> Option<Camera> {
    let ball = scene.ball((random.unit() * scene.len() as f64) as usize);
    let radius = f64::from(ball.radius);
    let before = radius * decades(random, 0.0, 4.0);
    let size = f64::from(scene.bounds().extent().max_element());
    let shown = random.one_of(&[2.0 * radius, size.max(2.0 * radius)]);
    let center = ball.center.as_dvec3();
    let degrees = (2.0 * (0.5 * shown / before).atan().to_degrees()).clamp(1e-3, 120.0);
    let direction = random.direction();
    let up = direction.any_orthonormal_vector().as_vec3();
    let eye: Vec3 = (center + before * direction).as_vec3();
    Camera::look_at(eye, ball.center, up, degrees as f32).ok()
}
