//! What a method promises of a ray, by its own paper.
//!
//! A published method may be wrong where its paper says so, and nowhere else. Whether it may
//! be wrong on a ray is decided here from the scene and the truth alone, never from what the method drew.

use illes_fraglist::Piece;
use metaball_core::reference::Truth;
use metaball_core::{Metaball, Ray, Scene};

use super::points::Points;
use super::stand_in::{StandIn, may_overflow};

/// When a method must be right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Promise {
    /// Gourmel et al. 2010, section 3: the ray's first interval inside the solid holds the projection
    /// of a centre. It must be that of a ball whose support holds the projection, or the leaf that
    /// holds the interval does not list it.
    Projection,
    /// The same for the modified BVH, whose lists are complete only inside the supports of a leaf's
    /// own balls: the support must hold the hit, too.
    ProjectionOfCover,
    /// Kanamori et al. 2008, section 7: up to the hit, no two points at which the ray enters or
    /// leaves supports may coincide, or one is lost; nor may more supports overlap than the list of
    /// a ray holds.
    Peeling {
        /// K, the balls that a list holds.
        list_capacity: usize,
    },
    /// Illés and Szécsi: rays whose truth is clearer than the cubic is near the kernel (section 3), and
    /// than the rounding of a running sum (section 4); with exact polynomials every ray. Section 6: more separators than a ray's array holds are
    /// passed too early.
    Fragments {
        /// The polynomial between two separators.
        piece: Piece,
        /// Separators that the array holds.
        array_capacity: u32,
    },
    /// Every ray.
    Always,
    /// No ray: it may miss any hit or be late. A hit before the surface, or where there is none, is wrong
    /// all the same.
    Never,
}

impl Promise {
    /// Whether the method must find the first hit of this ray. For rays that hit.
    pub fn holds(self, scene: &Scene, ray: &Ray, truth: &Truth) -> bool {
        if let Self::Peeling { list_capacity } = self {
            let points = Points::up_to(truth.t, scene, ray);
            return points.coincident == 0 && points.overlap <= list_capacity;
        }
        if let Self::Fragments { .. } = self {
            let stand_in = self.stand_in(scene, ray);
            return stand_in.is_none_or(|field| field.keeps(truth, scene.threshold()));
        }
        if self == Self::Never {
            return false;
        }
        // A start inside needs no projection: the first evaluation decides.
        if truth.t == 0.0 || self == Self::Always {
            return true;
        }
        scene.balls().any(|ball| {
            let along = Along::new(&ball, ray);
            let covers_hit = self == Self::Projection || along.chord_start() <= truth.t;
            along.half_chord_squared > 0.0
                && covers_hit
                && along.projection - along.rounding > truth.t
                && along.projection + along.rounding < truth.exit
        })
    }

    /// The field that the method searches instead of the scene's, if it does.
    pub fn stand_in(self, scene: &Scene, ray: &Ray) -> Option<StandIn> {
        let Self::Fragments { piece, .. } = self else { return None };
        StandIn::new(piece, scene, ray)
    }

    /// Whether the method may draw what its paper puts instead of the surface: by peeling, where
    /// a list is too short, and a point that is lost leaves its ball on the list for good; with
    /// fragment lists, where the array of separators is.
    pub fn allows_fallback(self, scene: &Scene, ray: &Ray, truth: &Truth) -> bool {
        if let Self::Fragments { array_capacity, .. } = self {
            return may_overflow(array_capacity as usize, scene, ray);
        }
        let Self::Peeling { list_capacity } = self else { return false };
        let points = Points::up_to(truth.t, scene, ray);
        points.overlap + points.coincident > list_capacity
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
