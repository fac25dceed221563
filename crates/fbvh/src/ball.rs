//! The builder's working copy of a ball, and when two things overlap.

use glam::Vec3;
use metaball_core::Aabb;

/// A ball as the builder moves it about.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
    pub(crate) strength: f32,
    /// Index in the field.
    pub(crate) index: u32,
}

/// Squared distances are computed from differences that are right to a float, with at most eight
/// roundings of 6e-8 after that: what overlaps in truth is within this factor of overlapping in f32.
const SLACK: f32 = 1.0 + 1e-6;

impl Ball {
    /// Box of the support sphere.
    pub(crate) fn bounds(&self) -> Aabb {
        Aabb::around_sphere(self.center, self.radius)
    }

    /// Whether the support sphere meets the box. Never false where it does.
    pub(crate) fn reaches(&self, bounds: &Aabb) -> bool {
        sphere_meets(self.center, self.radius, bounds)
    }

    /// Whether the support spheres meet. Never false where they do.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        let reach = self.radius + other.radius;
        self.center.distance_squared(other.center) <= reach * reach * SLACK
    }
}

/// Whether the sphere meets the box. Never false where it does.
pub(crate) fn sphere_meets(center: Vec3, radius: f32, bounds: &Aabb) -> bool {
    bounds.distance_squared(center) <= radius * radius * SLACK
}
