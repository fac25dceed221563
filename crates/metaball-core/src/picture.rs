//! Pictures: what one shows, its pixels, and its scale.

use bytemuck::{Pod, Zeroable};

use crate::{Color, Hit, WorkKind};

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Picture {
    /// The lit surface by Phong's model, in the blended colours where the scene has colours.
    Phong,
    /// Normals as colours: red to the right, green upwards, blue towards the eye.
    Normal,
    /// Distances as grey, white where the surface is nearest.
    Depth,
    /// The surface's colour without light.
    Color,
    /// The balls alone: each as the sphere in which it reaches the threshold by itself (Kanamori et
    /// al. 2008, figure 11 left). Needs no hits.
    Spheres,
    /// What each pixel cost, as a heat map from 0 to the costliest pixel.
    Work(WorkKind),
}

/// Pixels, eight bits a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue (sRGB-encoded) and 255, row by row from the top left: 4 bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Image {
    /// The image of so many pixels across and down, row by row from the top left.
    pub fn new(width: u32, height: u32, pixels: &[Color]) -> Self {
        Self { width, height, rgba: bytemuck::cast_slice(pixels).to_vec() }
    }
}

/// An image and its scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaded {
    /// The image.
    pub image: Image,
    /// What the ends of the scale stand for: scene units for [`Picture::Depth`], a count for
    /// [`Picture::Work`], nothing for the others.
    pub range: Option<ValueRange>,
}

/// Ends of a scale: WGSL's `ValueRange` of `shaders/wgsl/shade/picture.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct ValueRange {
    /// The least value.
    pub low: f32,
    /// The greatest value.
    pub high: f32,
}

impl ValueRange {
    /// Distances of the nearest and the farthest hit, the scale of [`Picture::Depth`]; 0 and 0 where
    /// there is no hit.
    pub fn of_distances(hits: &[Hit]) -> Self {
        Self::spanned(hits).unwrap_or_default()
    }

    /// The same of a part of a picture; `None` where there is no hit.
    pub fn spanned(hits: &[Hit]) -> Option<Self> {
        let distances = hits.iter().filter(|hit| hit.is_hit()).map(|hit| hit.t);
        distances.map(|t| Self { low: t, high: t }).reduce(Self::union)
    }

    /// From the lesser of both lows to the greater of both highs.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}
