//! Slices of rays through a cut solid on one thread, as light sends them.

use metaball_core::{HostTracer, Ray, RayQuery, Section, SurfaceHit};

use super::ClippedTracer;
use crate::Field;
use crate::trace::clearance::rounding_at;
use crate::trace::host_tracer::TraceScratch;

/// What a thread keeps from call to call of a [`ClippedTracer`](HostTracer::answer), for its memory.
pub struct ClippedScratch {
    tracer: TraceScratch,
    sections: Vec<Section>,
    rays: Vec<Ray>,
}

impl<F: Field> HostTracer for ClippedTracer<'_, F> {
    type Scratch = ClippedScratch;

    fn scratch(&self) -> ClippedScratch {
        ClippedScratch { tracer: self.tracer.scratch(), sections: Vec::new(), rays: Vec::new() }
    }

    fn answers(&self, query: RayQuery) -> bool {
        self.tracer.answers(query)
    }

    fn answer(
        &self,
        query: RayQuery,
        rays: &[Ray],
        scratch: &mut ClippedScratch,
        answers: &mut [SurfaceHit],
    ) {
        let ClippedScratch { tracer, sections, rays: parts } = scratch;
        if self.clip.is_all() {
            return self.tracer.answer(query, rays, tracer, answers);
        }
        sections.clear();
        sections.extend(rays.iter().map(|ray| self.clip.section(ray)));
        parts.clear();
        parts.extend(sections.iter().map(|section| section.ray));
        self.tracer.answer(query, parts, tracer, answers);
        for ((ray, section), answer) in rays.iter().zip(sections).zip(answers) {
            *answer = closed(query, ray, section, *answer);
        }
    }

    /// On a face, which is where the ray was cut: what rounding does to its point. The cut itself is
    /// rounded once, in t, which that bounds too; a start so far along the face's normal is out of the
    /// region, or in it, for certain.
    fn clearance(&self, ray: &Ray, found: &SurfaceHit) -> f32 {
        if self.clip.section(ray).has_on_face(&found.hit) {
            return rounding_at(ray, found.hit.t);
        }
        self.tracer.clearance(ray, found)
    }

    fn balls_near(&self, found: &SurfaceHit) -> &[u32] {
        self.tracer.balls_near(found)
    }
}

/// What is found along the section of a ray, made an answer about the cut solid. A place that the tracer
/// found is kept while the hit is there.
fn closed(query: RayQuery, ray: &Ray, section: &Section, found: SurfaceHit) -> SurfaceHit {
    let SurfaceHit { mut hit, place } = found;
    match query {
        RayQuery::FirstHit => SurfaceHit { hit: section.first_hit(hit), place },
        RayQuery::AnyHit => {
            hit.verdict = section.any_hit(hit.verdict);
            SurfaceHit { hit, place }
        }
        RayQuery::Exit => match section.first_exit(ray, hit) {
            same if same == hit => found,
            hit => SurfaceHit { hit, ..SurfaceHit::MISS },
        },
    }
}
