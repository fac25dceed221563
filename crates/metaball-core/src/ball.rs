//! Metaballs and their support spheres.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// One metaball: it adds `strength * kernel(|x - center|² / radius²)` to the field and nothing
/// outside its support sphere. pᵢ, Rᵢ and qᵢ of the papers. A negative ball, one of negative strength, takes
/// away from what the others make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metaball {
    /// Centre, world space, scene units.
    pub center: Vec3,
    /// Support radius R > 0, scene units: the kernel is zero from here on.
    pub radius: f32,
    /// Strength q, not 0: the field's value at the centre of the ball alone; no unit.
    pub strength: f32,
}

impl Metaball {
    /// A ball of strength 1.
    pub const fn new(center: Vec3, radius: f32) -> Self {
        Self { center, radius, strength: 1.0 }
    }

    /// Whether it takes away from the field.
    pub const fn is_negative(&self) -> bool {
        self.strength < 0.0
    }
}

/// Where a metaball's field may differ from 0. Sixteen bytes, laid out as WGSL's
/// `struct Support { center: vec3<f32>, radius: f32 }`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Support {
    /// Centre, world space, scene units.
    pub center: Vec3,
    /// Support radius R, scene units, positive.
    pub radius: f32,
}
