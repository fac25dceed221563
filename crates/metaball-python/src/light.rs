//! Options of light, by the names of the command line.

use std::path::PathBuf;

use glam::Vec3;
use metaball::{FloorKind, LightOptions};
use pyo3::prelude::*;

use crate::errors::refused;

/// The keywords of light, `metaball.LightOptions`; what is left out is `None`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Light {
    shadows: Option<bool>,
    lamp: Option<Lamps>,
    lamp_size: Option<f32>,
    ambient_occlusion: Option<u32>,
    occlusion_reach: Option<f32>,
    reflections: Option<u32>,
    reflectivity: Option<f32>,
    refraction: Option<f32>,
    absorption: Option<[f32; 3]>,
    opacity: Option<f32>,
    bounces: Option<u32>,
    floor: Option<String>,
    environment: Option<PathBuf>,
    cel: Option<u32>,
    depth_cue: Option<f32>,
    samples: Option<u32>,
    seed: Option<u32>,
    exposure: Option<f32>,
}

/// A lamp in one direction, or some.
#[derive(FromPyObject)]
enum Lamps {
    #[pyo3(transparent, annotation = "three numbers")]
    One([f32; 3]),
    #[pyo3(transparent, annotation = "a sequence of three numbers each")]
    Some(Vec<[f32; 3]>),
}

impl Lamps {
    fn directions(self) -> Vec<Vec3> {
        match self {
            Self::One(direction) => vec![Vec3::from_array(direction)],
            Self::Some(directions) => directions.into_iter().map(Vec3::from_array).collect(),
        }
    }
}

impl Light {
    pub(crate) fn options(self) -> PyResult<LightOptions> {
        let floor = match self.floor.as_deref() {
            None => None,
            Some("plain") => Some(FloorKind::Plain),
            Some("tiles") => Some(FloorKind::Tiles),
            Some(other) => {
                return Err(refused("floor", "plain or tiles", format_args!("{other:?}")));
            }
        };
        Ok(LightOptions {
            shadows: self.shadows.unwrap_or_default(),
            lamps: self.lamp.map(Lamps::directions).unwrap_or_default(),
            lamp_size: self.lamp_size,
            ambient_occlusion: self.ambient_occlusion,
            occlusion_reach: self.occlusion_reach,
            reflections: self.reflections,
            reflectivity: self.reflectivity,
            refraction: self.refraction,
            absorption: self.absorption.map(Vec3::from_array),
            opacity: self.opacity,
            bounces: self.bounces,
            floor,
            environment: self.environment,
            cel: self.cel,
            depth_cue: self.depth_cue,
            samples: self.samples,
            seed: self.seed,
            exposure: self.exposure,
        })
    }
}
