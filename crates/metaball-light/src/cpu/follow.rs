//! Paths of light, followed together in waves: all their rays of one kind are answered, and what they
//! find makes the next ones.

use std::ops::Add;

use glam::Vec3;
use metaball_core::{HostTracer, Ray, RayQuery, Verdict};

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
}

impl<T: HostTracer> PathTracer<'_, T> {
    /// Follows the paths to their ends.
    pub(super) fn follow(&self, sample: Sample<'_>, scratch: &mut Scratch<T::Scratch>) {
        let paths = 0..sample.pixels.len() as u32;
        scratch.paths.clear();
        scratch.paths.resize(paths.len(), Path::START);
        let start = |path| (path, self.lighting.eye_ray(&self.view, sample.at(path)));
        scratch.outside.clear();
        scratch.outside.extend(paths.map(start));
        scratch.within.clear();
        while !(scratch.outside.is_empty() && scratch.within.is_empty()) {
            scratch.lit.clear();
            let waves = [
                (RayQuery::FirstHit, std::mem::take(&mut scratch.outside)),
                (RayQuery::Exit, std::mem::take(&mut scratch.within)),
            ];
            for (query, sent) in waves {
                self.meet_surfaces(query, &sent, sample, scratch);
            }
            self.light_surfaces(sample, scratch);
            let Scratch { paths, lit, outside, within, .. } = scratch;
            for (index, ray) in lit {
                let path = &mut paths[*index as usize];
                go_on(*index, self.lighting.onward(path, ray.direction), outside, within);
            }
        }
        let undecided = scratch.paths.iter().map(|path| u64::from(path.undecided));
        scratch.rays.undecided += undecided.sum::<u64>();
    }

    /// Answers the paths' own rays.
    fn meet_surfaces(
        &self,
        query: RayQuery,
        sent: &[(u32, Ray)],
        sample: Sample<'_>,
        scratch: &mut Scratch<T::Scratch>,
    ) {
        let Scratch { tracer, paths, wave, outside, within, lit, rays, .. } = scratch;
        rays.paths += sent.len() as u64;
        wave.clear();
        wave.rays.extend(sent.iter().map(|(_, ray)| ray));
        if paths.iter().all(|path| path.bounces == 0) {
            wave.answer(self.tracer, query, tracer);
        } else {
            wave.answer_by_direction(self.tracer, query, tracer);
        }
        for ((index, ray), found) in sent.iter().zip(&wave.answers) {
            let path = &mut paths[*index as usize];
            let read = || (self.tracer.clearance(ray, found), self.color(ray, found));
            if !self.lighting.meet(path, ray, found, read) {
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
