//! Rays from arrays, and what they meet as arrays.

use glam::{DVec3, Vec3};
use metaball_core::{Hit, HostTracer, NO_LIMIT, Ray, RayQuery, SurfaceHit, Verdict};
use numpy::ndarray::Array2;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use particle_files::Positions;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{NumberArray, Numbers, PointArray, Points, Rows};
use crate::errors::refused;
use crate::watch::Watched;

/// Rays that are made and traced together: enough for all threads, few enough to stay near.
const TOGETHER: usize = 1 << 17;

/// Rays that are made for the reference, which takes thousands of times as long for each.
const FEW_TOGETHER: usize = 1 << 12;

/// The arrays of rays: origins, directions, least and greatest t; all but the directions one for all, or one for
/// each.
#[derive(FromPyObject)]
pub(crate) struct RayArrays<'py>(
    PointArray<'py>,
    PointArray<'py>,
    NumberArray<'py>,
    NumberArray<'py>,
);

impl RayArrays<'_> {
    /// The rays, for threads that do not hold the interpreter.
    pub(crate) fn rays(&self, scene_origin: DVec3) -> Rays<'_> {
        let Self(origins, directions, t_min, t_max) = self;
        Rays {
            origins: origins.points(),
            directions: directions.points(),
            t_min: t_min.numbers(),
            t_max: t_max.numbers(),
            scene_origin,
        }
    }
}

/// Rays of arrays, relative to a scene's origin.
#[derive(Clone, Copy)]
pub(crate) struct Rays<'a> {
    origins: Points<'a>,
    directions: Points<'a>,
    t_min: Numbers<'a>,
    t_max: Numbers<'a>,
    scene_origin: DVec3,
}

impl Rays<'_> {
    pub(crate) fn count(&self) -> usize {
        self.directions.count()
    }

    /// So many rays from an index on, into a buffer.
    ///
    /// # Errors
    /// Names the first that has no direction, or does not start at a point.
    fn make(&self, first: usize, count: usize, rays: &mut Vec<Ray>) -> PyResult<()> {
        rays.clear();
        rays.resize(count, Ray::new(Vec3::ZERO, Vec3::ZERO));
        // Column by column: of which sort an array is, is asked once.
        let origin = self.scene_origin;
        each_point(self.origins, first, rays, |ray, at| ray.origin = (at - origin).as_vec3());
        each_point(self.directions, first, rays, |ray, at| ray.direction = unit(at));
        let (t_min, t_max) = (self.t_min, self.t_max);
        for (index, ray) in rays.iter_mut().enumerate() {
            ray.t_min = t_min.at(one(t_min.count(), first + index));
            ray.t_max = t_max.at(one(t_max.count(), first + index)).min(NO_LIMIT);
        }
        let is_broken = |ray: &Ray| !(ray.direction.is_finite() && ray.origin.is_finite());
        match rays.iter().position(is_broken) {
            None => Ok(()),
            Some(index) if rays[index].origin.is_finite() => {
                let found = self.directions.at(first + index);
                let what = format!("directions, ray {}", first + index);
                Err(refused(&what, "a finite vector with a length above 0", found))
            }
            Some(index) => {
                let found = one(self.origins.count(), first + index);
                let what = format!("origins, ray {}", first + index);
                Err(refused(&what, "a finite point", self.origins.at(found)))
            }
        }
    }
}

/// Sets something of each ray by its point: those of an array from an index on, or the one for all.
fn each_point(points: Points<'_>, first: usize, rays: &mut [Ray], set: impl Fn(&mut Ray, DVec3)) {
    fn each<P: Positions>(
        points: &P,
        first: usize,
        rays: &mut [Ray],
        set: impl Fn(&mut Ray, DVec3),
    ) {
        let count = points.count();
        for (index, ray) in rays.iter_mut().enumerate() {
            set(ray, points.at(one(count, first + index)));
        }
    }
    match points {
        Points::SingleRows(rows) => each(&Rows(rows), first, rays, set),
        Points::DoubleRows(rows) => each(&Rows(rows), first, rays, set),
        points => each(&points, first, rays, set),
    }
}

/// The index of what is one for all, or one for each.
#[inline]
fn one(count: usize, index: usize) -> usize {
    if count == 1 { 0 } else { index }
}

/// The unit vector of a direction, in f32: its own numbers where it is unit to rounding, NaN where it has no
/// direction.
#[inline]
fn unit(direction: DVec3) -> Vec3 {
    /// Three roundings to f32, of 6e-8 each, on the square of the length.
    const ROUNDING: f64 = 4e-7;
    let squared = direction.length_squared();
    if (squared - 1.0).abs() <= ROUNDING {
        return direction.as_vec3();
    }
    (direction / squared.sqrt()).as_vec3()
}

/// What rays meet, as arrays.
pub(crate) type HitArrays<'py> =
    (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray2<f32>>, Bound<'py, PyArray1<u8>>);

/// Hits of anyone, as arrays: t, normals and verdicts.
#[derive(FromPyObject)]
pub(crate) struct HitColumns<'py>(
    PyReadonlyArray1<'py, f32>,
    PyReadonlyArray2<'py, f32>,
    PyReadonlyArray1<'py, u8>,
);

impl HitColumns<'_> {
    /// The hits.
    ///
    /// # Errors
    /// When the arrays do not fit one another, or a verdict is none.
    pub(crate) fn hits(&self) -> PyResult<Vec<Hit>> {
        let Self(t, normals, verdicts) = self;
        let (t, normals, verdicts) = (t.as_array(), normals.as_array(), verdicts.as_array());
        if normals.dim() != (t.len(), 3) || verdicts.len() != t.len() {
            let found = format!("{:?} and {}", normals.dim(), verdicts.len());
            return Err(refused(
                "hits",
                "normals (n, 3) and verdicts (n,) of the same n as t",
                found,
            ));
        }
        let hit = |index: usize| {
            let verdict = match verdicts[index] {
                0 => return Ok(Hit::MISS),
                1 => Verdict::Hit,
                2 => Verdict::Inside,
                3 => Verdict::Undecided,
                other => return Err(refused("verdicts", "numbers from 0 to 3", other)),
            };
            let normal = Vec3::from_array([0, 1, 2].map(|axis| normals[[index, axis]]));
            Ok(Hit { verdict, fallback: false, t: t[index], normal })
        };
        (0..t.len()).map(hit).collect()
    }
}

/// What rays meet, column by column.
#[derive(Default)]
pub(crate) struct Columns {
    t: Vec<f32>,
    normals: Vec<[f32; 3]>,
    verdicts: Vec<u8>,
}

impl Columns {
    pub(crate) fn of(hits: &[Hit]) -> Self {
        Self {
            t: hits.iter().map(|hit| hit.t).collect(),
            normals: hits.iter().map(|hit| hit.normal.to_array()).collect(),
            verdicts: hits.iter().map(|hit| hit.verdict as u8).collect(),
        }
    }

    fn blank(count: usize) -> Self {
        Self { t: vec![0.0; count], normals: vec![[0.0; 3]; count], verdicts: vec![0; count] }
    }

    pub(crate) fn into_verdicts(self) -> Vec<u8> {
        self.verdicts
    }

    pub(crate) fn into_arrays(self, py: Python<'_>) -> PyResult<HitArrays<'_>> {
        let normals = Array2::from_shape_vec((self.t.len(), 3), self.normals.into_flattened())
            .map_err(|error| refused("normals", "three for each ray", error))?;
        Ok((
            PyArray1::from_vec(py, self.t),
            PyArray2::from_owned_array(py, normals),
            PyArray1::from_vec(py, self.verdicts),
        ))
    }
}

/// Makes all rays, a few at a time, as long as they are wanted: `answer` gets them in order.
pub(crate) fn each_batch(
    rays: &Rays<'_>,
    mut answer: impl FnMut(&[Ray]),
    watched: &Watched<'_>,
) -> PyResult<()> {
    let mut together = Vec::new();
    for first in (0..rays.count()).step_by(FEW_TOGETHER) {
        if !watched.goes_on() {
            break;
        }
        rays.make(first, FEW_TOGETHER.min(rays.count() - first), &mut together)?;
        answer(&together);
        watched.is_at(first + together.len());
    }
    Ok(())
}

/// What rays meet, as long as it is wanted. They are made, traced and written down in runs that stay in a thread's
/// caches.
pub(crate) fn traced<T: HostTracer>(
    rays: &Rays<'_>,
    tracer: &T,
    query: RayQuery,
    watched: &Watched<'_>,
) -> PyResult<Columns> {
    /// A multiple of a packet.
    const RUN: usize = 256;
    let scratch = || (tracer.scratch(), Vec::new(), Vec::new());
    let mut columns = Columns::blank(rays.count());
    for first in (0..rays.count()).step_by(TOGETHER) {
        let end = rays.count().min(first + TOGETHER);
        let Columns { t, normals, verdicts } = &mut columns;
        let runs = t[first..end].par_chunks_mut(RUN).zip(normals[first..end].par_chunks_mut(RUN));
        let runs = runs.zip(verdicts[first..end].par_chunks_mut(RUN)).enumerate();
        let refused = runs
            .map_init(scratch, |(scratch, made, found), (run, ((t, normals), verdicts))| {
                if !watched.goes_on() {
                    return Ok(());
                }
                rays.make(first + run * RUN, t.len(), made)?;
                found.resize(made.len(), SurfaceHit::MISS);
                tracer.answer(query, made, scratch, found);
                for (index, SurfaceHit { hit, .. }) in found.iter().enumerate() {
                    t[index] = hit.t;
                    normals[index] = hit.normal.to_array();
                    verdicts[index] = hit.verdict as u8;
                }
                Ok::<_, PyErr>(())
            })
            .find_first(Result::is_err);
        refused.unwrap_or(Ok(()))?;
        watched.is_at(end);
    }
    Ok(columns)
}
