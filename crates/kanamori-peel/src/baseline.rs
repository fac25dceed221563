//! What the paper measures itself against (section 6): the method of Nishita and Nakamae (1994) on
//! the CPU, with a hierarchy for its rays, four spheres at a time, on all threads.
//!
//! # Theory
//! Each ray is intersected with the effective spheres of a hierarchy that was split in the middle;
//! the points at which it enters and leaves them are sorted; between each two the field is one
//! polynomial, which Bézier clipping searches for its first root (section 3).
//!
//! # Changes versus the paper
//! Spheres are tested four at a time in f32, with a margin for its rounding; chords, polynomials and
//! roots are f64. The nearest kernel sphere ends the traversal, as it ends the peeling of section 5.2:
//! the paper does not say so of its CPU version, which without it would be slow in dense scenes for no
//! reason. Control points are values of the polar form of a ball's squared distance: appendix A clipped
//! to the interval without de Casteljau's steps.
//!
//! # Practice
//! Needs no adapter. [`Method`] is it behind [`HostMethod`], to be compared. Lists have no capacity to exceed and coincident points are all kept, so that answers
//! are right up to the threshold of clipping, in parts of an interval. A kernel that is no polynomial
//! along a ray, as Perlin's or a spline of SPH, is refused.

mod bernstein;
mod chord;
mod clipping;
mod intervals;
mod middle_split;
mod normal;

use std::time::{Duration, Instant};

use metaball_core::{
    Hit, HostError, HostMethod, HostRenderer, Kernel, NegativeBall, Ray, Scene, Verdict,
};
use rayon::prelude::*;

use self::chord::Chord;
use self::intervals::Intervals;
use self::middle_split::Tree;
use self::normal::normal;

/// A scene made ready for rays. Borrows it.
#[derive(Debug)]
pub struct Baseline<'a> {
    scene: &'a Scene,
    tree: Tree,
    threshold: f64,
}

/// Hits of rays, and the time and work that they took.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Each ray's first surface point, at its `t_min` where it starts inside.
    pub hits: Vec<Hit>,
    /// Time for finding and sorting the intersections with effective spheres, summed over threads.
    pub traversal: Duration,
    /// Time for the isosurface tests, summed over threads.
    pub isosurface: Duration,
    /// Intervals that Bézier clipping searched.
    pub searches: u64,
    /// Its iterations in all.
    pub iterations: u64,
    /// The most iterations of one search.
    pub most_iterations: u64,
}

/// Why a scene was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The kernel is no polynomial along a ray.
    #[error(
        "needed a kernel that is a polynomial along a ray, found {found}: Bézier clipping has no control points for it"
    )]
    NoPolynomial {
        /// The scene's kernel.
        found: Kernel,
    },
    /// A ball takes away from the field: what balls add on an interval is then no upper bound of what they
    /// have added on a part of it.
    #[error(transparent)]
    NegativeBall(#[from] NegativeBall),
}

/// Rays whose two phases are timed together: reading a clock takes time, too.
const RAYS_PER_TASK: usize = 64;

impl<'a> Baseline<'a> {
    /// Builds the hierarchy. `threshold` is the width, in parts of an interval, at which a range is
    /// a root: the paper prints 10e−4 (section 5.4).
    ///
    /// # Errors
    /// When the kernel is no polynomial along a ray, or a ball takes away from the field.
    pub fn build(scene: &'a Scene, threshold: f64) -> Result<Self, Refusal> {
        if scene.kernel().coefficients().is_none() {
            return Err(Refusal::NoPolynomial { found: scene.kernel() });
        }
        scene.negative_ball().map_or(Ok(()), Err)?;
        Ok(Self { scene, tree: Tree::build(scene), threshold })
    }

    /// Traces rays on rayon's current pool.
    pub fn trace(&self, rays: &[Ray]) -> Traced {
        let traced = rays
            .par_chunks(RAYS_PER_TASK)
            .map(|rays| self.trace_task(rays))
            .reduce(Traced::nothing, Traced::followed_by);
        debug_assert_eq!(traced.hits.len(), rays.len(), "one hit a ray");
        traced
    }

    /// First the intersections of all rays of the task, then their isosurface tests.
    fn trace_task(&self, rays: &[Ray]) -> Traced {
        let start = Instant::now();
        let mut chords = Vec::new();
        let mut stack = Vec::new();
        let found: Vec<_> = rays
            .iter()
            .map(|ray| {
                let first = chords.len();
                let kernel_sphere = self.tree.chords(ray, &mut stack, &mut chords);
                (Intervals::new(&chords[first..], ray, kernel_sphere), first..chords.len())
            })
            .collect();
        let traversal = start.elapsed();

        let start = Instant::now();
        let mut traced = Traced::nothing();
        for ((intervals, range), ray) in found.iter().zip(rays) {
            let chords: &[Chord] = &chords[range.clone()];
            let hit = self.first_hit(intervals, chords, ray, &mut traced);
            traced.hits.push(hit);
        }
        traced.traversal = traversal;
        traced.isosurface = start.elapsed();
        traced
    }

    fn first_hit(
        &self,
        intervals: &Intervals,
        chords: &[Chord],
        ray: &Ray,
        traced: &mut Traced,
    ) -> Hit {
        let mut search = clipping::Search::new(self.threshold);
        let found = intervals.first_hit(self.scene, chords, &mut search);
        traced.searches += search.searches;
        traced.iterations += search.iterations;
        traced.most_iterations = traced.most_iterations.max(search.most_iterations);
        let Some(t) = found else { return Hit::MISS };
        let verdict = if t > f64::from(ray.t_min) { Verdict::Hit } else { Verdict::Inside };
        let t = t as f32;
        Hit { verdict, fallback: false, t, normal: normal(self.scene, chords, ray, t) }
    }
}

/// The baseline among other methods.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    name: &'static str,
    threshold: f64,
}

impl Method {
    /// The baseline with the threshold of [`Baseline::build`], under a name for reports and errors.
    pub const fn new(name: &'static str, threshold: f64) -> Self {
        Self { name, threshold }
    }
}

impl HostMethod for Method {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build<'s>(&self, scene: &'s Scene) -> Result<Box<dyn HostRenderer + 's>, HostError> {
        let baseline = Baseline::build(scene, self.threshold).map_err(|refusal| {
            HostError::Unsupported { method: self.name, reason: refusal.to_string() }
        })?;
        Ok(Box::new(baseline))
    }
}

impl HostRenderer for Baseline<'_> {
    fn picture_hits(&self, rays: &[Ray], _width: usize) -> Vec<Hit> {
        self.trace(rays).hits
    }

    fn bytes(&self) -> u64 {
        self.tree.bytes() as u64
    }
}

impl Traced {
    fn nothing() -> Self {
        Self {
            hits: Vec::new(),
            traversal: Duration::ZERO,
            isosurface: Duration::ZERO,
            searches: 0,
            iterations: 0,
            most_iterations: 0,
        }
    }

    fn followed_by(mut self, mut next: Self) -> Self {
        self.hits.append(&mut next.hits);
        self.traversal += next.traversal;
        self.isosurface += next.isosurface;
        self.searches += next.searches;
        self.iterations += next.iterations;
        self.most_iterations = self.most_iterations.max(next.most_iterations);
        self
    }
}
