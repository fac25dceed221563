//! Axis-aligned boxes.

use glam::Vec3;

/// A closed axis-aligned box; empty when any `min` exceeds its `max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Least corner, world space, scene units.
    pub min: Vec3,
    /// Greatest corner, world space, scene units.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing and is the identity of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box around a sphere, rounded outwards by one float on every side so that no point of
    /// the sphere is lost to rounding.
    #[inline]
    pub fn around_sphere(center: Vec3, radius: f32) -> Self {
        let next = |corner: Vec3, round: fn(f32) -> f32| {
            Vec3::new(round(corner.x), round(corner.y), round(corner.z))
        };
        Self {
            min: next(center - radius, f32::next_down),
            max: next(center + radius, f32::next_up),
        }
    }

    /// Whether no point lies inside.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// The smallest box around both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box of the points in both.
    #[inline]
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether the point lies in the closed box.
    #[inline]
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// Lengths of the sides; zero where the box is empty.
    pub fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// The middle. Meaningless for an empty box.
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Area of the six faces; zero for an empty box.
    pub fn surface_area(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let side = self.extent();
        2.0 * (side.x * side.y + side.y * side.z + side.z * side.x)
    }

    /// Squared distance from the point to the nearest point of the box, zero inside.
    #[inline]
    pub fn distance_squared(&self, point: Vec3) -> f32 {
        (point - point.clamp(self.min, self.max)).length_squared()
    }
}
