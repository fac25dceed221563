//! Paths of light, followed together in waves: all their rays of one kind are answered, and what they
//! find makes the next ones.

use std::mem::take;
use std::ops::Add;

use glam::Vec3;
use metaball_core::{HostTracer, Ray, RayQuery, SurfaceHit, Verdict};

use super::path_tracer::PathTracer;
use super::scatter::Sent;
use super::wave::Wave;
use crate::path::Path;

/// Shadow and occlusion rays that are answered together: their rays and answers fit a core's cache.
const TOGETHER: usize = 1 << 14;

/// What a thread keeps from call to call, for its memory.
pub(super) struct Scratch<S> {
    tracer: S,
    pub(super) paths: Vec<Path>,
    wave: Wave,
    /// Paths whose next ray runs outside of the solid, and inside.
    outside: Vec<(u32, Ray)>,
    within: Vec<(u32, Ray)>,
    /// Paths at a surface that is lit, with the ray that met it.
    lit: Vec<(u32, Ray)>,
    /// For each ray of a wave of shadow rays: its path, and the light that it brings; none for an
    /// occlusion ray, whose light is looked up only where it hits nothing.
    pending: Vec<(u32, Option<Vec3>)>,
    pub(super) rays: Rays,
}

/// How many rays were traced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rays {
    /// From the eye, mirrored and refracted.
    pub paths: u64,
    /// To lamps and to the surroundings.
    pub shadows: u64,
    /// Of all these, those that the method left undecided.
    pub undecided: u64,
}

/// Which paths are followed.
#[derive(Clone, Copy)]
pub(super) struct Sample<'a> {
    /// One path through each.
    pub(super) pixels: &'a [u32],
    /// Index of the sample.
    pub(super) index: u32,
    /// What their eye rays find, where that is known.
    pub(super) first_hits: Option<&'a [SurfaceHit]>,
}

impl Sample<'_> {
    /// Pixel and sample of a path.
    fn at(&self, path: u32) -> (u32, u32) {
        (self.pixels[path as usize], self.index)
    }
}

impl Add for Rays {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            paths: self.paths + other.paths,
            shadows: self.shadows + other.shadows,
            undecided: self.undecided + other.undecided,
        }
    }
}

impl<S> Scratch<S> {
    pub(super) fn new(tracer: S) -> Self {
        Self {
            tracer,
            paths: Vec::new(),
            wave: Wave::default(),
            outside: Vec::new(),
            within: Vec::new(),
            lit: Vec::new(),
            pending: Vec::new(),
            rays: Rays::default(),
        }
    }

    /// What some eye rays find.
    pub(super) fn first_hits<T: HostTracer<Scratch = S>>(
        &mut self,
        tracer: &T,
        rays: impl Iterator<Item = Ray>,
    ) -> &[SurfaceHit] {
        self.wave.clear();
        self.wave.rays.extend(rays);
        self.wave.answer(tracer, RayQuery::FirstHit, &mut self.tracer);
        &self.wave.answers
    }
}

impl<T: HostTracer> PathTracer<'_, T> {
    /// Follows the paths to their ends.
    pub(super) fn follow(&self, sample: Sample<'_>, scratch: &mut Scratch<T::Scratch>) {
        self.meet_first_surfaces(sample, scratch);
        loop {
            self.light_surfaces(sample, scratch);
            self.leave_surfaces(scratch);
            let Scratch { outside, within, .. } = scratch;
            if outside.is_empty() && within.is_empty() {
                break;
            }
            let waves = [(RayQuery::FirstHit, take(outside)), (RayQuery::Exit, take(within))];
            for (query, sent) in waves {
                let Scratch { wave, tracer, .. } = scratch;
                wave.send(&sent);
                wave.answer_by_direction(self.tracer, query, tracer);
                self.meet_surfaces(&sent, sample, scratch);
            }
        }
        let undecided = scratch.paths.iter().map(|path| u64::from(path.undecided));
        scratch.rays.undecided += undecided.sum::<u64>();
    }

    /// Begins the paths at the eye.
    fn meet_first_surfaces(&self, sample: Sample<'_>, scratch: &mut Scratch<T::Scratch>) {
        let paths = 0..sample.pixels.len() as u32;
        let Scratch { tracer, paths: begun, wave, lit, .. } = scratch;
        begun.clear();
        begun.resize(paths.len(), Path::START);
        lit.clear();
        let sent: Vec<_> = paths.map(|path| (path, self.eye_ray(sample.at(path)))).collect();
        wave.send(&sent);
        match sample.first_hits {
            Some(first_hits) => wave.take(first_hits),
            None => wave.answer(self.tracer, RayQuery::FirstHit, tracer),
        }
        self.meet_surfaces(&sent, sample, scratch);
    }

    /// Sends the paths' next rays.
    fn leave_surfaces(&self, scratch: &mut Scratch<T::Scratch>) {
        let Scratch { paths, lit, outside, within, .. } = scratch;
        for (index, ray) in lit.drain(..) {
            let path = &mut paths[index as usize];
            go_on(index, self.lighting.onward(path, ray.direction), outside, within);
        }
    }

    /// Takes the answers to the paths' own rays.
    fn meet_surfaces(
        &self,
        sent: &[(u32, Ray)],
        sample: Sample<'_>,
        scratch: &mut Scratch<T::Scratch>,
    ) {
        let Scratch { paths, wave, outside, within, lit, rays, .. } = scratch;
        rays.paths += sent.len() as u64;
        for ((index, ray), found) in sent.iter().zip(&wave.answers) {
            let path = &mut paths[*index as usize];
            let clearance = || self.tracer.clearance(ray, found);
            if !self.lighting.meet(path, ray, found, clearance, || self.color(ray, found)) {
                continue;
            }
            if !self.lighting.is_clear(path) {
                self.lighting.light_without_rays(path, ray.direction);
                lit.push((*index, *ray));
                continue;
            }
            let next = self.lighting.pass_through(path, sample.at(*index), ray.direction);
            go_on(*index, next, outside, within);
        }
    }

    /// Sends the shadow and occlusion rays of all lit surfaces, and adds the light that arrives.
    fn light_surfaces(&self, sample: Sample<'_>, scratch: &mut Scratch<T::Scratch>) {
        scratch.wave.clear();
        scratch.pending.clear();
        for at in 0..scratch.lit.len() {
            let (index, ray) = scratch.lit[at];
            let path = &scratch.paths[index as usize];
            for sent in self.lighting.sent(path, sample.at(index), ray.direction) {
                let (ray, light) = match sent {
                    Sent::Shadow(ray, light) => (ray, Some(light)),
                    Sent::Occlusion(ray) => (ray, None),
                };
                scratch.wave.rays.push(ray);
                scratch.pending.push((at as u32, light));
            }
            if scratch.pending.len() >= TOGETHER {
                self.resolve_shadow_rays(scratch);
            }
        }
        self.resolve_shadow_rays(scratch);
    }

    /// What is undecided casts no shadow, and is counted.
    fn resolve_shadow_rays(&self, scratch: &mut Scratch<T::Scratch>) {
        let Scratch { tracer, paths, wave, lit, pending, rays, .. } = scratch;
        rays.shadows += pending.len() as u64;
        wave.answer_by_direction(self.tracer, RayQuery::AnyHit, tracer);
        let answered = wave.rays.iter().zip(&wave.answers);
        for ((at, light), (ray, found)) in pending.iter().zip(answered) {
            let (index, incoming) = &lit[*at as usize];
            let path = &mut paths[*index as usize];
            let arriving = self.lighting.arriving(found.hit.is_hit());
            if arriving > 0.0 {
                let unoccluded = || self.lighting.unoccluded(path, incoming.direction, ray);
                let light = light.unwrap_or_else(unoccluded);
                path.radiance += arriving * light;
            }
            path.undecided += u32::from(found.hit.verdict == Verdict::Undecided);
        }
        wave.clear();
        pending.clear();
    }
}

/// Notes a path's next ray, if there is one, among those that run outside of the solid, or inside.
fn go_on(
    path: u32,
    next: Option<(Ray, RayQuery)>,
    outside: &mut Vec<(u32, Ray)>,
    within: &mut Vec<(u32, Ray)>,
) {
    match next {
        Some((ray, RayQuery::Exit)) => within.push((path, ray)),
        Some((ray, _)) => outside.push((path, ray)),
        None => (),
    }
}
