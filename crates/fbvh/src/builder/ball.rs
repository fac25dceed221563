//! The builder's working copy of a ball, and tests of overlap.

use glam::{Vec3, Vec3A, Vec4};
use metaball_core::Aabb;

/// A ball in 24 bytes, of which one vector register takes the first 16: the builder copies it from list
/// to list.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    /// The centre, and after it the support radius.
    sphere: [f32; 4],
    pub(super) strength: f32,
    /// Index in the field.
    pub(super) index: u32,
}

/// Squared distances are computed from differences that are right to a float, with at most eight
/// roundings of 6e-8 after that: what truly overlaps is within this factor of overlapping in f32.
const SLACK: f32 = 1.0 + 1e-6;

impl Ball {
    /// No ball, where there is room for one.
    pub(super) const NONE: Self = Self { sphere: [0.0; 4], strength: 0.0, index: 0 };

    pub(super) fn new(center: Vec3, radius: f32, strength: f32, index: u32) -> Self {
        Self { sphere: center.extend(radius).into(), strength, index }
    }

    #[inline]
    pub(super) fn center(&self) -> Vec3A {
        Vec3A::from_vec4(Vec4::from_array(self.sphere))
    }

    #[inline]
    pub(super) fn radius(&self) -> f32 {
        self.sphere[3]
    }

    /// Whether it takes away from the field.
    #[inline]
    pub(super) fn is_negative(&self) -> bool {
        self.strength < 0.0
    }

    /// Whether the support sphere meets the box. Never false where it does.
    #[inline]
    pub(super) fn reaches(&self, bounds: &Aabb) -> bool {
        sphere_meets(self.center(), self.radius(), bounds)
    }

    /// Whether the support spheres meet. Never false where they do.
    #[inline]
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.is_within(self.radius() + other.radius(), other)
    }

    /// Whether the centres are at most so far apart. Never false where they are.
    #[inline]
    pub(super) fn is_within(&self, distance: f32, other: &Self) -> bool {
        self.center().distance_squared(other.center()) <= distance * distance * SLACK
    }
}

/// Whether the sphere meets the box. Never false where it does.
#[inline]
pub(super) fn sphere_meets(center: Vec3A, radius: f32, bounds: &Aabb) -> bool {
    let below = Vec3A::from(bounds.min) - center;
    let above = center - Vec3A::from(bounds.max);
    let outside = below.max(above).max(Vec3A::ZERO);
    outside.length_squared() <= radius * radius * SLACK
}

/// The box around the support spheres.
pub(super) fn bounds_of(balls: &[Ball]) -> Aabb {
    let everything = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    bounds_within(&everything, balls, Ball::radius)
}

/// The part of a box around spheres about the balls' centres, of the radii that are given. No point of
/// a sphere is lost to rounding: the box around them is a float wider on every side. Ends with the ball
/// that completes the whole of `bounds`: in dense regions one of the first.
#[inline]
pub(super) fn bounds_within(bounds: &Aabb, balls: &[Ball], radius: impl Fn(&Ball) -> f32) -> Aabb {
    let (low, high) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
    let (mut min, mut max) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    for ball in balls {
        let radius = Vec3A::splat(radius(ball));
        min = min.min(ball.center() - radius);
        max = max.max(ball.center() + radius);
        if (min.cmple(low) & max.cmpge(high)).all() {
            return *bounds;
        }
    }
    let each = |corner: Vec3A, round: fn(f32) -> f32| {
        Vec3::new(round(corner.x), round(corner.y), round(corner.z))
    };
    Aabb { min: each(min, f32::next_down), max: each(max, f32::next_up) }.intersection(bounds)
}

/// Moves the balls that satisfy the test to the front, in their order, and returns how many they are.
/// What remains after them is meaningless.
#[inline]
pub(super) fn retain(balls: &mut [Ball], test: impl Fn(&Ball) -> bool) -> usize {
    let mut kept = 0;
    for at in 0..balls.len() {
        let ball = balls[at];
        balls[kept] = ball;
        kept += usize::from(test(&ball));
    }
    kept
}

/// Moves the balls that satisfy the test to the front, and returns how many they are.
pub(super) fn partition(balls: &mut [Ball], test: impl Fn(&Ball) -> bool) -> usize {
    let mut front = 0;
    for at in 0..balls.len() {
        if test(&balls[at]) {
            balls.swap(front, at);
            front += 1;
        }
    }
    front
}
