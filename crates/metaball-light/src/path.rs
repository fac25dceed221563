//! What all passes read and write: twins of the structs of `shaders/wgsl/light/path.wgsl`, where fields are
//! explained.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use metaball_core::NO_LIMIT;

use crate::{Effects, Environment, Floor, Surface};

/// What holds for a whole pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Settings {
    pub(crate) absorption: Vec3,
    pub(crate) refraction: f32,
    pub(crate) reflectivity: f32,
    pub(crate) bounces: u32,
    pub(crate) shadows: u32,
    pub(crate) occlusion_rays: u32,
    pub(crate) occlusion_reach: f32,
    pub(crate) lamps: u32,
    pub(crate) sample: u32,
    pub(crate) samples: u32,
    pub(crate) seed: u32,
    pub(crate) bands: u32,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) floor_middle: Vec3,
    pub(crate) floor_reach: f32,
    pub(crate) floor_color: Vec3,
    pub(crate) tile: f32,
}

/// A lamp.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Lamp {
    pub(crate) toward: Vec3,
    pub(crate) size: f32,
    pub(crate) color: Vec3,
    padding: u32,
}

/// A pixel's path of light.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct Path {
    pub(crate) radiance: Vec3,
    pub(crate) stage: u32,
    pub(crate) throughput: Vec3,
    pub(crate) rays_sent: u32,
    pub(crate) position: Vec3,
    pub(crate) clearance: f32,
    pub(crate) normal: Vec3,
    pub(crate) bounces: u32,
    pub(crate) pending: Vec3,
    pub(crate) on_floor: u32,
    pub(crate) base: Vec3,
    pub(crate) undecided: u32,
}

/// The stage of a path whose ray runs outside of the solid.
pub(crate) const OUTSIDE: u32 = 1;
/// The stage of one whose ray runs inside.
pub(crate) const WITHIN: u32 = 2;

impl Path {
    /// A path at the eye.
    pub(crate) const START: Self = Self {
        radiance: Vec3::ZERO,
        stage: OUTSIDE,
        throughput: Vec3::ONE,
        rays_sent: 0,
        position: Vec3::ZERO,
        clearance: 0.0,
        normal: Vec3::ZERO,
        bounces: 0,
        pending: Vec3::ZERO,
        on_floor: 0,
        base: Vec3::ZERO,
        undecided: 0,
    };
}

impl Settings {
    /// The settings of a picture's first sample.
    pub(crate) fn new(effects: &Effects, samples: u32, seed: u32) -> Self {
        let (reflectivity, refraction, absorption) = match effects.surface {
            Surface::Opaque { reflectivity } => (reflectivity, 0.0, Vec3::ZERO),
            Surface::SeeThrough { .. } => (0.0, 0.0, Vec3::ZERO),
            Surface::Fluid { refraction, absorption } => (0.0, refraction, absorption),
        };
        let (columns, rows) = match &effects.environment {
            Environment::Sky => (0, 0),
            Environment::Panorama(panorama) => panorama.size(),
        };
        let none = Floor { middle: Vec3::ZERO, reach: 0.0, color: Vec3::ZERO, tile: 0.0 };
        let floor = effects.floor.unwrap_or(none);
        Self {
            absorption,
            refraction,
            reflectivity,
            bounces: effects.bounces,
            shadows: u32::from(effects.cast_shadows()),
            occlusion_rays: effects.occlusion_rays(),
            occlusion_reach: effects.occlusion.map_or(NO_LIMIT, |occlusion| occlusion.reach),
            lamps: effects.lamps.len() as u32,
            sample: 0,
            samples,
            seed,
            bands: effects.bands,
            columns,
            rows,
            floor_middle: floor.middle,
            floor_reach: floor.reach,
            floor_color: floor.color,
            tile: floor.tile,
        }
    }

    /// Shadow and occlusion rays of a surface point, at most.
    #[cfg(feature = "gpu")]
    pub(crate) fn rays_per_surface(&self) -> u32 {
        self.lamps * self.shadows + self.occlusion_rays
    }
}

impl Lamp {
    pub(crate) fn new(lamp: &crate::Lamp) -> Self {
        Self {
            toward: lamp.toward.normalize_or(Vec3::Y),
            size: libm::sinf((0.5 * lamp.diameter).clamp(0.0, 90.0).to_radians()),
            color: lamp.color,
            padding: 0,
        }
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use metaball_shaders::{KernelModule, Variant, compose, host_layout, struct_layout};

    use super::*;

    #[test]
    fn host_structs_are_their_wgsl_twins() {
        let variant = Variant {
            kernel: KernelModule::Power,
            radii: false,
            strengths: false,
            colors: false,
            counting: false,
            chosen: &["light/environment/image"],
        };
        let module = compose("light/surface", &variant).expect("composes");
        let twin = |name| struct_layout(&module, name).expect("used by the shader");
        let settings = host_layout!(Settings {
            absorption,
            refraction,
            reflectivity,
            bounces,
            shadows,
            occlusion_rays,
            occlusion_reach,
            lamps,
            sample,
            samples,
            seed,
            bands,
            columns,
            rows,
            floor_middle,
            floor_reach,
            floor_color,
            tile,
        });
        assert_eq!(settings, twin("Settings"));
        assert_eq!(host_layout!(Lamp { toward, size, color, padding }), twin("Lamp"));
        let path = host_layout!(Path {
            radiance,
            stage,
            throughput,
            rays_sent,
            position,
            clearance,
            normal,
            bounces,
            pending,
            on_floor,
            base,
            undecided,
        });
        assert_eq!(path, twin("Path"));
    }
}
