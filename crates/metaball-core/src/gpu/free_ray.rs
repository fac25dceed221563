//! Rays with a start and a query of their own.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::{Ray, RayQuery};

impl RayQuery {
    /// Key of the override constant, its `@id`, that holds the query of a pass composed with
    /// `shaders/wgsl/batch/list_rays.wgsl` or `shaders/wgsl/ray/free.wgsl`: `query as u32`.
    pub const CONSTANT: &str = "2";
}

/// A ray of a batch, 32 bytes: WGSL's `FreeRay` of `shaders/wgsl/batch/free_ray.wgsl`. It starts at its
/// origin.
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

    /// The ray with its query; `None` for a ray that starts anywhere but at its origin, `t_min` other than
    /// 0, which shaders do not have.
    pub fn new(ray: &Ray, query: RayQuery) -> Option<Self> {
        let Ray { origin, direction, t_min, t_max } = *ray;
        (t_min == 0.0).then_some(Self { origin, t_max, direction, query: query as u32 })
    }

    /// The points that it covers.
    pub fn ray(&self) -> Ray {
        Ray { t_max: self.t_max, ..Ray::new(self.origin, self.direction) }
    }

    /// Its query, answered or not; `None` for a ray without one.
    pub fn query(&self) -> Option<RayQuery> {
        let number = self.query & !Self::ANSWERED;
        RayQuery::ALL.into_iter().find(|query| *query as u32 == number)
    }
}
