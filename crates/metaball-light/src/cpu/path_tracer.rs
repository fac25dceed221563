//! A view with its effects on the CPU, drawn tile by tile.

use std::ops::Range;

use glam::Vec3;
use metaball_core::{HostTracer, Ray, RayQuery, Scene, SurfaceColors, SurfaceHit, View};
use rayon::prelude::*;

use super::follow::{Rays, Sample, Scratch};
use super::lighting::Lighting;
use crate::{Effects, UnansweredError};

/// A view of a scene with its light. The same picture byte for byte on every machine, whatever its
/// threads and vectors.
#[derive(Debug)]
pub struct PathTracer<'a, T> {
    pub(super) tracer: &'a T,
    pub(super) view: View,
    pub(super) lighting: Lighting,
    colors: SurfaceColors<'a>,
    samples: u32,
}

/// Rows of a picture in linear light.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The mean of all samples, row by row from the left.
    pub light: Vec<Vec3>,
    /// The rays that it took.
    pub rays: Rays,
}

/// Pixels across and down that are followed together, so that their rays are neighbours.
const TILE: u32 = 16;

/// Pixels whose eye rays make a packet: closer neighbours than eight of a row.
const BLOCK: (u32, u32) = (4, 2);

impl<'a, T: HostTracer> PathTracer<'a, T> {
    /// Rows in multiples of this many, from the top, are the same bit for bit as in the whole picture.
    pub const ROWS: u32 = TILE;

    /// Prepares a view of the scene that the tracer traces. A single sample goes through the middles of
    /// pixels, several are spread over them.
    ///
    /// # Errors
    /// When the tracer does not answer a query that the effects need.
    pub fn new(
        tracer: &'a T,
        scene: &'a Scene,
        view: &View,
        effects: &Effects,
        samples: u32,
        seed: u32,
    ) -> Result<Self, UnansweredError> {
        let unanswered = |query: &RayQuery| !tracer.answers(*query);
        if let Some(query) = effects.queries().into_iter().find(unanswered) {
            return Err(UnansweredError { query });
        }
        let lighting = Lighting::new(effects, samples, seed);
        let colors = SurfaceColors::new(scene);
        Ok(Self { tracer, view: view.clone(), lighting, colors, samples })
    }

    /// The light of some of the view's rows, on rayon's current pool.
    pub fn rows(&self, rows: Range<u32>) -> Rows {
        let (first, width) = (rows.start, self.view.width() as usize);
        let mut light = vec![Vec3::ZERO; width * rows.len()];
        let mut rays = Rays::default();
        let tiles: Vec<_> = (rows.clone().step_by(TILE as usize))
            .flat_map(|top| {
                (0..self.view.width()).step_by(TILE as usize).map(move |left| (left, top))
            })
            .collect();
        let drawn: Vec<_> = tiles
            .into_par_iter()
            .map_init(
                || Scratch::new(self.tracer.scratch()),
                |scratch, corner| self.tile(corner, rows.end, scratch),
            )
            .collect();
        for (pixels, sums, tile_rays) in drawn {
            rays = rays + tile_rays;
            for (pixel, sum) in pixels.into_iter().zip(sums) {
                light[pixel as usize - first as usize * width] = sum / self.samples as f32;
            }
        }
        Rows { light, rays }
    }

    /// The light of some pixels, named by their indices row by row: the mean of all samples. As many
    /// as a tile's are followed together, on rayon's current pool.
    pub fn pixels(&self, pixels: &[u32]) -> Vec<Vec3> {
        let sums = pixels.par_chunks((TILE * TILE) as usize).map_init(
            || Scratch::new(self.tracer.scratch()),
            |scratch, pixels| self.sums(pixels, scratch),
        );
        sums.flatten().map(|sum| sum / self.samples as f32).collect()
    }

    /// Pixels of a tile, and the sums of their samples.
    fn tile(
        &self,
        (left, top): (u32, u32),
        end: u32,
        scratch: &mut Scratch<T::Scratch>,
    ) -> (Vec<u32>, Vec<Vec3>, Rays) {
        let width = self.view.width();
        let (right, bottom) = ((left + TILE).min(width), (top + TILE).min(end));
        let mut pixels = Vec::with_capacity((TILE * TILE) as usize);
        for top in (top..bottom).step_by(BLOCK.1 as usize) {
            for left in (left..right).step_by(BLOCK.0 as usize) {
                for row in top..(top + BLOCK.1).min(bottom) {
                    let columns = left..(left + BLOCK.0).min(right);
                    pixels.extend(columns.map(|column| row * width + column));
                }
            }
        }
        scratch.rays = Rays::default();
        let sums = self.sums(&pixels, scratch);
        (pixels, sums, scratch.rays)
    }

    /// The sums of the samples of some pixels.
    fn sums(&self, pixels: &[u32], scratch: &mut Scratch<T::Scratch>) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; pixels.len()];
        for index in 0..self.samples {
            self.follow(Sample { pixels, index }, scratch);
            for (sum, path) in sums.iter_mut().zip(&scratch.paths) {
                *sum += path.radiance;
            }
        }
        sums
    }

    /// The surface's own colour in linear light.
    pub(super) fn color(&self, ray: &Ray, found: &SurfaceHit) -> Vec3 {
        self.colors.at(ray.origin + found.hit.t * ray.direction, self.tracer.balls_near(found))
    }
}
