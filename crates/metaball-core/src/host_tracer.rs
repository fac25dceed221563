//! Tracers on the CPU: rays from anywhere, and what each queries.

use crate::{Hit, Ray};

/// What a ray queries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum RayQuery {
    /// The smallest t at which the field rises to T; a start at T or above is
    /// [`Inside`](crate::Verdict::Inside).
    FirstHit = 1,
    /// Whether the field is T or more anywhere on the ray, for shadow and occlusion rays. Any such t
    /// will do, and no normal is found.
    AnyHit = 2,
    /// For a ray that starts in the solid, the smallest t at which the field falls below T. A start
    /// below T is [`Inside`](crate::Verdict::Inside) at t = 0: it is outside the solid already.
    Exit = 3,
}

impl RayQuery {
    /// Every query, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::FirstHit, Self::AnyHit, Self::Exit];
}

/// What a [`HostTracer`] found along a ray, so that light can go on from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceHit {
    /// The hit.
    pub hit: Hit,
    /// Where in the tracer's structure it is: a number that only the tracer can read.
    pub place: u32,
}

impl SurfaceHit {
    /// A ray that hits nothing.
    pub const MISS: Self = Self { hit: Hit::MISS, place: u32::MAX };
}

/// A method that traces any ray on the CPU. Light effects are made of such rays.
pub trait HostTracer: Sync {
    /// What a thread keeps from call to call, for its memory.
    type Scratch: Send;

    /// A scratch that no call has used yet.
    fn scratch(&self) -> Self::Scratch;

    /// Whether the method answers this query.
    fn answers(&self, query: RayQuery) -> bool;

    /// Answers rays with one query, which the method [answers](HostTracer::answers), on the calling
    /// thread: one answer a ray, in their order. Fastest where neighbours in the slice are neighbours
    /// in space and direction. Of [`RayQuery::AnyHit`] only the verdict is right.
    ///
    /// # Panics
    /// When there are not as many answers as rays.
    fn answer(
        &self,
        query: RayQuery,
        rays: &[Ray],
        scratch: &mut Self::Scratch,
        answers: &mut [SurfaceHit],
    );

    /// How far from the hit of a ray, along its normal, a secondary ray must start to be certainly on
    /// its side of the surface: scene units.
    fn clearance(&self, ray: &Ray, found: &SurfaceHit) -> f32;

    /// Balls, by index, among which are all that add to the field at a hit; none where the structure
    /// knows only that the hit is deep in the solid.
    fn balls_near(&self, found: &SurfaceHit) -> &[u32];
}
