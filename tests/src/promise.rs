//! What a method promises of a ray, by its own paper.
//!
//! A published method may be wrong where its paper says so, and nowhere else. Whether a ray is such
//! a place is decided here from the scene and the truth alone, never from what the method drew.

use metaball_core::reference::Truth;
use metaball_core::{Metaball, Ray, Scene};

/// When a method must be right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Promise {
    /// Gourmel et al. 2010, section 3: the ray's first stretch inside the solid holds the projection
    /// of a centre. It must be that of a ball whose support holds the projection, or the leaf that
    /// holds the stretch does not list it.
    Projection,
    /// The same for the modified BVH, whose lists are complete only inside the supports of a leaf's
    /// own balls: the support must hold the hit, too.
    ProjectionOfCover,
}

/// The promise of a method, by name.
///
/// # Panics
/// When nobody has written down what the method promises.
pub fn promise_of(method: &str) -> Promise {
    match method {
        "fbvh" => Promise::Projection,
        "bvh" => Promise::ProjectionOfCover,
        _ => panic!("method {method}: needed a line in promise_of, found none"),
    }
}

impl Promise {
    /// Whether the method must find the first hit of this ray. For rays that hit.
    pub fn holds(self, scene: &Scene, ray: &Ray, truth: &Truth) -> bool {
        // A start inside needs no projection: the first evaluation tells.
        if truth.t == 0.0 {
            return true;
        }
        scene.balls().any(|ball| {
            let along = Along::new(&ball, ray);
            let holds_projection = along.half_chord_squared > 0.0;
            let first = match self {
                Self::Projection => truth.t,
                Self::ProjectionOfCover => truth.t.max(along.chord_start()),
            };
            let covers_hit = self == Self::Projection || along.chord_start() <= truth.t;
            holds_projection
                && covers_hit
                && along.projection - along.rounding > first
                && along.projection + along.rounding < truth.leaves
        })
    }
}

/// A ball seen along a ray.
struct Along {
    /// t of the centre's projection.
    projection: f64,
    /// R² less the squared distance of the centre from the ray.
    half_chord_squared: f64,
    /// How far an f32 projection can be from this: three products and two sums of numbers no
    /// larger than the distance from the eye, 2⁻²³ each.
    rounding: f64,
}

impl Along {
    fn new(ball: &Metaball, ray: &Ray) -> Self {
        let to_center = ball.center.as_dvec3() - ray.origin.as_dvec3();
        let direction = ray.direction.as_dvec3();
        let projection = to_center.dot(direction) / direction.length_squared();
        let off_axis = to_center - projection * direction;
        let radius = f64::from(ball.radius);
        Self {
            projection,
            half_chord_squared: radius * radius - off_axis.length_squared(),
            rounding: 5.0 * to_center.length() * f64::from(f32::EPSILON),
        }
    }

    fn chord_start(&self) -> f64 {
        self.projection - self.half_chord_squared.max(0.0).sqrt()
    }
}
