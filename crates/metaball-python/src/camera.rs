//! Where pictures are seen from.

use glam::{DVec3, Vec3};
use metaball::Viewpoint;
use metaball_core::Camera as SceneCamera;
use pyo3::prelude::*;

use crate::errors::raised;

/// A camera of a scene's coordinates, to be pickled: eye, axes and half the height of its picture.
pub(crate) type CameraParts = ([f32; 3], [[f32; 3]; 3], f32);

pub(crate) fn parts_of(camera: &SceneCamera) -> CameraParts {
    let axes = [camera.right(), camera.up(), camera.forward()];
    (camera.eye().into(), axes.map(|axis| axis.to_array()), camera.half_height())
}

pub(crate) fn camera_of((eye, axes, half_height): CameraParts) -> PyResult<SceneCamera> {
    let camera = SceneCamera::of_parts(eye.into(), axes.map(Vec3::from_array), half_height);
    camera.map_err(raised)
}

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
