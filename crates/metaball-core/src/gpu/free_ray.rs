//! Rays with a start of their own, and what each queries.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::Ray;

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

    /// Key of the override constant, its `@id`, that holds the query of a pass composed with
    /// `shaders/wgsl/batch/list_rays.wgsl` or `shaders/wgsl/ray/free.wgsl`: `query as u32`.
    pub const CONSTANT: &str = "2";
}

/// A ray of a batch, 32 bytes: WGSL's `FreeRay` of `shaders/wgsl/batch/free_ray.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FreeRay {
    /// Start, world space, scene units.
    pub origin: Vec3,
    /// Greatest t, scene units, or [`NO_LIMIT`](crate::NO_LIMIT).
    pub t_max: f32,
    /// Direction, unit to rounding.
    pub direction: Vec3,
    /// Number of the [`RayQuery`]; 0 for a ray without one, which is not traced. Plus
    /// [`FreeRay::ANSWERED`] once its answer has been read.
    pub query: u32,
}

impl FreeRay {
    /// Added to a query whose answer has been read: the ray is not traced again.
    pub const ANSWERED: u32 = 1 << 8;

    /// A ray that is not traced.
    pub const NONE: Self = Self { origin: Vec3::ZERO, t_max: 0.0, direction: Vec3::ZERO, query: 0 };

    /// The ray with its query.
    pub fn new(ray: &Ray, query: RayQuery) -> Self {
        let Ray { origin, direction, t_max } = *ray;
        Self { origin, t_max, direction, query: query as u32 }
    }

    /// The points that it covers.
    pub fn ray(&self) -> Ray {
        Ray { origin: self.origin, direction: self.direction, t_max: self.t_max }
    }

    /// Its query, answered or not; `None` for a ray without one.
    pub fn query(&self) -> Option<RayQuery> {
        let number = self.query & !Self::ANSWERED;
        RayQuery::ALL.into_iter().find(|query| *query as u32 == number)
    }
}
