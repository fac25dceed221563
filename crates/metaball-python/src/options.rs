//! Options of pictures.

use glam::Vec3;
use metaball::{Clip, Picture};
use pyo3::prelude::*;

use crate::errors::{raised, refused};

/// A half-space that is kept: where n·x is at most the offset.
pub(crate) type Plane = ([f32; 3], f64);

/// The least and the greatest corner of a box that is kept.
pub(crate) type Corners = ([f64; 3], [f64; 3]);

/// What a picture shows, by the names of the command line.
pub(crate) fn picture_named(name: &str) -> PyResult<Picture> {
    match name {
        "phong" => Ok(Picture::Phong),
        "normal" => Ok(Picture::Normal),
        "depth" => Ok(Picture::Depth),
        "color" => Ok(Picture::Color),
        _ => Err(refused("picture", "phong, normal, depth or color", format_args!("{name:?}"))),
    }
}

/// The region that is kept.
pub(crate) fn clip(planes: Vec<Plane>, corners: Option<Corners>) -> PyResult<Clip> {
    let of_planes = planes.into_iter().try_fold(Clip::default(), |clip, (normal, offset)| {
        clip.and_plane(Vec3::from_array(normal), offset)
    });
    let clip = of_planes.map_err(raised)?;
    let Some((least, greatest)) = corners else { return Ok(clip) };
    let is_box = least.iter().zip(&greatest).all(|(least, greatest)| least <= greatest);
    if !is_box {
        let found = format!("{least:?} and {greatest:?}");
        return Err(refused("clip_box", "the least corner and then the greatest", found));
    }
    let cut = Vec3::AXES.iter().enumerate().try_fold(clip, |clip, (axis, &normal)| {
        clip.and_plane(normal, greatest[axis])?.and_plane(-normal, -least[axis])
    });
    cut.map_err(raised)
}
