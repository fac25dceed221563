//! A tracer that can be told to stop.

use std::fmt;

use fbvh::ClippedTracer;
use metaball_core::{Hit, HostTracer, Ray, RayQuery, Scene, SurfaceHit};

/// A tracer as long as its answers are wanted. Later it leaves rays unanswered, so that whatever waits for
/// them ends soon, with a picture of nothing that must not be shown.
pub(crate) struct Interruptible<'a> {
    tracer: Inner<'a>,
    goes_on: GoesOn<'a>,
}

type Inner<'a> = ClippedTracer<'a, Scene>;

/// Whether a computation is still wanted; asked on any thread. Once it is not, it stays so.
pub(crate) type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

impl<'a> Interruptible<'a> {
    pub(crate) fn new(tracer: Inner<'a>, goes_on: GoesOn<'a>) -> Self {
        Self { tracer, goes_on }
    }

    /// One whose answers are always wanted.
    pub(crate) fn never(tracer: Inner<'a>) -> Self {
        Self::new(tracer, &|| true)
    }

    /// Whether its answers are wanted.
    pub(crate) fn goes_on(&self) -> bool {
        (self.goes_on)()
    }

    /// [`ClippedTracer::first_hit`].
    pub(crate) fn first_hit(&self, ray: &Ray) -> Hit {
        self.tracer.first_hit(ray)
    }

    /// [`ClippedTracer::picture_hits`]; they are answered all together.
    pub(crate) fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit> {
        self.tracer.picture_hits(rays, width)
    }
}

impl fmt::Debug for Interruptible<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Interruptible").field(&self.tracer).finish()
    }
}

impl<'a> HostTracer for Interruptible<'a> {
    type Scratch = <Inner<'a> as HostTracer>::Scratch;

    fn scratch(&self) -> Self::Scratch {
        self.tracer.scratch()
    }

    fn answers(&self, query: RayQuery) -> bool {
        self.tracer.answers(query)
    }

    fn answer(
        &self,
        query: RayQuery,
        rays: &[Ray],
        scratch: &mut Self::Scratch,
        answers: &mut [SurfaceHit],
    ) {
        if self.goes_on() {
            self.tracer.answer(query, rays, scratch, answers);
        } else {
            answers.fill(SurfaceHit::MISS);
        }
    }

    fn clearance(&self, ray: &Ray, found: &SurfaceHit) -> f32 {
        self.tracer.clearance(ray, found)
    }

    fn balls_near(&self, found: &SurfaceHit) -> &[u32] {
        self.tracer.balls_near(found)
    }
}
