//! Where pictures are seen from.

use glam::{DVec3, Vec3};
use metaball::Viewpoint;
use pyo3::prelude::*;

/// The attributes of a `metaball.Camera`.
#[derive(FromPyObject)]
pub(crate) struct Camera {
    eye: Option<[f64; 3]>,
    look_at: Option<[f64; 3]>,
    up: Option<[f32; 3]>,
    fov: Option<f32>,
}

impl Camera {
    /// What is asked for of it; nothing where there is none.
    pub(crate) fn viewpoint(camera: Option<Self>) -> Viewpoint {
        let Some(Self { eye, look_at, up, fov }) = camera else { return Viewpoint::default() };
        Viewpoint {
            eye: eye.map(DVec3::from_array),
            look_at: look_at.map(DVec3::from_array),
            up: up.map(Vec3::from_array),
            fov,
        }
    }
}
