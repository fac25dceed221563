//! What rays see that leave the scene.

mod image;
mod sky;

use glam::Vec3;

use crate::Environment;

impl Environment {
    /// Linear light from a direction.
    pub(super) fn light(&self, direction: Vec3) -> Vec3 {
        match self {
            Self::Sky => sky::light(direction),
            Self::Panorama(panorama) => image::light(panorama, direction),
        }
    }

    /// Mean light from above a surface, as its normal weighs it.
    pub(super) fn ambient(&self, normal: Vec3) -> Vec3 {
        match self {
            Self::Sky => sky::ambient(normal),
            Self::Panorama(panorama) => image::ambient(panorama, normal),
        }
    }
}
