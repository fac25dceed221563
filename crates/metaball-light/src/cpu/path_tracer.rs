//! A view with its effects on the CPU, drawn tile by tile.

use std::ops::Range;

use glam::Vec3;
use metaball_core::{
    HostTracer, PixelDirections, Ray, RayQuery, Scene, SurfaceColors, SurfaceHit, View,
};
use rayon::prelude::*;

use super::follow::{Rays, Sample, Scratch};
use super::lighting::Lighting;
use crate::{Effects, UnansweredError};

/// A view of a scene with its light. The same picture byte for byte on every machine, whatever its
/// threads and vectors.
#[derive(Debug)]
pub struct PathTracer<'a, T> {
    pub(super) tracer: &'a T,
    view: View,
    directions: PixelDirections,
    pub(super) lighting: Lighting,
    colors: SurfaceColors<'a>,
    samples: u32,
}

/// Rows of a picture in linear light.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The mean of all samples, or one of them, row by row from the left.
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
        let (colors, directions) = (SurfaceColors::new(scene), view.directions());
        Ok(Self { tracer, view: view.clone(), directions, lighting, colors, samples })
    }

    /// The light of some of the view's rows, on rayon's current pool.
    pub fn rows(&self, rows: Range<u32>) -> Rows {
        self.mean(rows, None)
    }

    /// The light of some of the view's rows along the paths of a single sample, one of those that the
    /// picture has. All of them, summed from the first on and divided by their number, are
    /// [`rows`](PathTracer::rows) bit for bit: a picture can be shown while it gets better.
    pub fn rows_of_sample(&self, rows: Range<u32>, index: u32) -> Rows {
        self.light(rows, index..index + 1, None)
    }

    /// The same where these rows' [first hits](PathTracer::first_hits) are known: with a single sample
    /// its paths begin there.
    ///
    /// # Panics
    /// When there are not as many hits as pixels.
    pub fn rows_behind(&self, rows: Range<u32>, first_hits: &[SurfaceHit]) -> Rows {
        assert_eq!(first_hits.len(), self.pixels_of(&rows).len(), "a hit a pixel");
        self.mean(rows, Some(first_hits).filter(|_| self.lighting.has_one_sample()))
    }

    /// What the rays through the middles of pixels find, row by row from the left, on rayon's current
    /// pool.
    pub fn first_hits(&self, rows: Range<u32>) -> Vec<SurfaceHit> {
        let middle =
            |&pixel: &u32| Ray::new(self.view.camera().eye(), self.directions.through(pixel));
        let (hits, _) = self.in_tiles(rows, SurfaceHit::MISS, |pixels, scratch| {
            let rays = pixels.iter().map(middle);
            (scratch.first_hits(self.tracer, rays).to_vec(), Rays::default())
        });
        hits
    }

    /// The light of some pixels, named by their indices row by row: the mean of all samples. As many
    /// as a tile's are followed together, on rayon's current pool.
    pub fn pixels(&self, pixels: &[u32]) -> Vec<Vec3> {
        let means = pixels.par_chunks((TILE * TILE) as usize).map_init(
            || Scratch::new(self.tracer.scratch()),
            |scratch, pixels| {
                let mut light = self.sums(pixels, 0..self.samples, None, scratch);
                self.divide(&mut light);
                light
            },
        );
        means.flatten().collect()
    }

    /// The mean of all samples.
    fn mean(&self, rows: Range<u32>, first_hits: Option<&[SurfaceHit]>) -> Rows {
        let mut lit = self.light(rows, 0..self.samples, first_hits);
        self.divide(&mut lit.light);
        lit
    }

    /// Makes means of the sums of all samples.
    fn divide(&self, sums: &mut [Vec3]) {
        sums.iter_mut().for_each(|sum| *sum /= self.samples as f32);
    }

    /// The sums of some samples.
    fn light(
        &self,
        rows: Range<u32>,
        samples: Range<u32>,
        first_hits: Option<&[SurfaceHit]>,
    ) -> Rows {
        let first = self.pixels_of(&rows).start;
        let (light, rays) = self.in_tiles(rows, Vec3::ZERO, |pixels, scratch| {
            let of_tile = |hits: &[SurfaceHit]| -> Vec<_> {
                pixels.iter().map(|&pixel| hits[pixel as usize - first]).collect()
            };
            scratch.rays = Rays::default();
            let first_hits = first_hits.map(of_tile);
            let sums = self.sums(pixels, samples.clone(), first_hits.as_deref(), scratch);
            (sums, scratch.rays)
        });
        Rows { light, rays }
    }

    /// Indices of the pixels of some rows.
    fn pixels_of(&self, rows: &Range<u32>) -> Range<usize> {
        let width = self.view.width() as usize;
        rows.start as usize * width..rows.end as usize * width
    }

    /// What `draw` makes of the pixels of each tile, row by row, and the sum of the rays that it took.
    fn in_tiles<P: Copy + Send>(
        &self,
        rows: Range<u32>,
        blank: P,
        draw: impl Fn(&[u32], &mut Scratch<T::Scratch>) -> (Vec<P>, Rays) + Sync,
    ) -> (Vec<P>, Rays) {
        let corners: Vec<_> = (rows.clone().step_by(TILE as usize))
            .flat_map(|top| {
                (0..self.view.width()).step_by(TILE as usize).map(move |left| (left, top))
            })
            .collect();
        let drawn: Vec<_> = corners
            .into_par_iter()
            .map_init(
                || Scratch::new(self.tracer.scratch()),
                |scratch, corner| {
                    let pixels = self.tile(corner, rows.end);
                    let (values, rays) = draw(&pixels, scratch);
                    (pixels, values, rays)
                },
            )
            .collect();
        let range = self.pixels_of(&rows);
        let (mut all, mut rays) = (vec![blank; range.len()], Rays::default());
        for (pixels, values, tile_rays) in drawn {
            rays = rays + tile_rays;
            for (pixel, value) in pixels.into_iter().zip(values) {
                all[pixel as usize - range.start] = value;
            }
        }
        (all, rays)
    }

    /// Pixels of a tile, block by block.
    fn tile(&self, (left, top): (u32, u32), end: u32) -> Vec<u32> {
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
        pixels
    }

    /// The sums of some samples of some pixels.
    fn sums(
        &self,
        pixels: &[u32],
        samples: Range<u32>,
        first_hits: Option<&[SurfaceHit]>,
        scratch: &mut Scratch<T::Scratch>,
    ) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; pixels.len()];
        for index in samples {
            self.follow(Sample { pixels, index, first_hits }, scratch);
            for (sum, path) in sums.iter_mut().zip(&scratch.paths) {
                *sum += path.radiance;
            }
        }
        sums
    }

    /// The ray of a pixel's sample.
    pub(super) fn eye_ray(&self, (pixel, sample): (u32, u32)) -> Ray {
        self.lighting.eye_ray(&self.view, self.directions.through(pixel), (pixel, sample))
    }

    /// The surface's own colour in linear light.
    pub(super) fn color(&self, ray: &Ray, found: &SurfaceHit) -> Vec3 {
        self.colors.at(ray.origin + found.hit.t * ray.direction, self.tracer.balls_near(found))
    }
}
