//! The reference: exact first hits in f64, on the CPU, independent of every method.
//!
//! [`Oracle`] takes the stored f32 scene and the given f32 ray as exact numbers: its answers are those
//! of the points `origin + t * direction` with the direction as stored.
//!
//! # Theory
//! Along a ray each ball's v = 1 − r²/R² is a parabola, positive on the ball's *chord*. The ends of
//! all chords cut the ray into *segments* with a fixed set of balls. There the field is one
//! polynomial for the kernels that have [coefficients](crate::Kernel::coefficients), and twice
//! continuously differentiable for the others. A segment is halved until each *piece* is certainly
//! below T, certainly above, or monotonic:
//!
//! - polynomials in Bernstein form (Farouki 2012, "The Bernstein polynomial basis: a centennial
//!   retrospective"), whose coefficients enclose the values and whose differences enclose the slope;
//! - the others by the exact range of each ball, which rises and then falls along the ray,
//!   and by bounds of the second derivative.
//!
//! The crossing in a monotonic piece is then found on the field itself. Pieces are visited front to
//! back, and the walk ends where the first sheet is left.
//!
//! # Practice
//! Distance costs no digits: each ball is measured from a nearby point of the ray, and each segment has
//! an origin of its own. What remains is the rounding of f64, n·2e-16 of the summed field for
//! n balls that overlap, or where balls are negative, of what adds and what takes away together. That moves a crossing by as much divided by the slope there, beyond the
//! 1e-12 relative that t is otherwise good for: where a ray grazes, t is known to the square root
//! only, and [`Truth::margin`] says so.
//!
//! [`march`] is a second oracle, slow and plain, which shares no code with the first; tests compare the
//! two.
//!
//! ```
//! use glam::Vec3;
//! use metaball_core::reference::Oracle;
//! use metaball_core::{Kernel, Metaball, Ray, Scene};
//!
//! let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(Vec3::X, 1.0)];
//! let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
//! let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::X * 5.0, Vec3::NEG_X));
//! println!("{:?} at t = {:.3}, out at {:.3}", truth.verdict, truth.t, truth.exit);
//! # assert_eq!(format!("{:.3} {:.3}", truth.t, truth.exit), "3.293 5.707");
//! # Ok::<(), metaball_core::SceneError>(())
//! ```

mod bernstein;
mod chord;
mod curvature;
mod curved;
mod interval;
mod marching;
mod piece;
mod sweep;
#[cfg(test)]
mod tests;
mod tree;
mod walk;

use glam::DVec3;
use rayon::prelude::*;

pub use marching::{March, march};

use self::{
    chord::{Chord, Line},
    sweep::sweep,
    tree::Tree,
    walk::Walk,
};
use crate::{Metaball, Ray, Scene, Verdict};

/// A scene prepared for exact queries.
#[derive(Debug)]
pub struct Oracle<'a> {
    scene: &'a Scene,
    tree: Tree,
}

/// The exact first hit of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// `Miss`, `Hit` or `Inside`; never `Undecided`.
    pub verdict: Verdict,
    /// The t of the first hit, in scene units; the ray's `t_min` inside, +∞ for a miss.
    pub t: f64,
    /// The t after that at which the field falls below T again; `t_max` where the ray ends first, +∞ for
    /// a miss.
    pub exit: f64,
    /// Unit vector out of the solid, against the gradient; zero for a miss, and where the gradient
    /// vanishes (as in the middle of a lone ball).
    pub normal: DVec3,
    /// How clear the verdict is: the least |F − T|/T, good to 1e-9, over
    ///
    /// - the field where the ray starts,
    /// - every local maximum before the hit, or of the whole ray for a miss,
    /// - the maximum from the hit to where the field falls below T again,
    /// - the field where the ray ends, if it ends before the hit.
    ///
    /// Raising or lowering the whole field by less than this share of T gives the same first sheet.
    pub margin: f64,
    /// Least support radius, scene units, among the balls whose support holds the hit; 0 for a miss.
    pub smallest_radius: f32,
}

impl Truth {
    /// The margin up to which a ray is called ambiguous: the relative error to which f32 arithmetic sums
    /// some tens of balls.
    pub const AMBIGUOUS: f64 = 1e-5;

    /// Of a ray without points: a miss, whatever the field.
    const NOTHING: Self = Self {
        verdict: Verdict::Miss,
        t: f64::INFINITY,
        exit: f64::INFINITY,
        normal: DVec3::ZERO,
        margin: f64::INFINITY,
        smallest_radius: 0.0,
    };

    /// Whether f32 arithmetic may rightly end at another verdict: the margin is at most
    /// [`Truth::AMBIGUOUS`].
    pub fn is_ambiguous(&self) -> bool {
        self.margin <= Self::AMBIGUOUS
    }
}

impl<'a> Oracle<'a> {
    /// Builds the search tree of the balls: O(n log n) for n balls.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, tree: Tree::new(scene.supports()) }
    }

    /// The first hit. A ray without a direction, which is zero or not finite, is the point of its origin.
    /// A ray [without points](Ray::is_empty) is a miss.
    pub fn first_hit(&self, ray: &Ray) -> Truth {
        let threshold = f64::from(self.scene.threshold());
        if ray.is_empty() {
            return Truth::NOTHING;
        }
        let line = Line::new(ray);
        let mut walk = Walk::new(threshold, line.start, self.field(line.at(line.start)));
        sweep(&self.chords(&line), &line, self.scene.kernel(), &mut walk);
        walk.end(line.end, self.field(line.at(line.end)));

        let (verdict, t) = walk.first_hit();
        let (normal, smallest_radius) = if verdict == Verdict::Miss {
            (DVec3::ZERO, 0.0)
        } else {
            (self.normal(line.at(t)), self.smallest_radius(line.at(t)))
        };
        Truth { verdict, t, exit: walk.exit(), normal, margin: walk.margin(), smallest_radius }
    }

    /// The first hit of each ray, in the order of the rays, on all cores.
    pub fn first_hits(&self, rays: &[Ray]) -> Vec<Truth> {
        rays.par_iter().map(|ray| self.first_hit(ray)).collect()
    }

    /// The field at a point in world space.
    pub fn field(&self, point: DVec3) -> f64 {
        let mut sum = 0.0;
        self.for_each_ball_at(point, |ball, _, squared_ratio| {
            sum += f64::from(ball.strength) * self.scene.kernel().value(squared_ratio);
        });
        sum
    }

    /// The field's gradient at a point in world space, per scene unit.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        let mut gradient = DVec3::ZERO;
        self.for_each_ball_at(point, |ball, offset, squared_ratio| {
            let radius = f64::from(ball.radius);
            let slope = f64::from(ball.strength) * self.scene.kernel().slope(squared_ratio);
            gradient += 2.0 * slope / (radius * radius) * offset;
        });
        gradient
    }

    /// The unit vector against the field's gradient at a point in world space; zero where the
    /// gradient vanishes.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        (-self.gradient(point)).normalize_or_zero()
    }

    /// The least radius of the supports that hold the point; 0 when none does.
    fn smallest_radius(&self, point: DVec3) -> f32 {
        let mut smallest = f32::INFINITY;
        self.for_each_ball_at(point, |ball, _, _| smallest = smallest.min(ball.radius));
        if smallest.is_finite() { smallest } else { 0.0 }
    }

    /// Visits the balls whose support holds the point, with the offset of the point from the centre
    /// and r²/R².
    fn for_each_ball_at(&self, point: DVec3, mut visit: impl FnMut(&Metaball, DVec3, f64)) {
        let holds = |min: DVec3, max: DVec3| point.cmpge(min).all() && point.cmple(max).all();
        self.tree.for_each(holds, |index| {
            let ball = self.scene.ball(index);
            let offset = point - ball.center.as_dvec3();
            let squared_ratio = offset.length_squared() / f64::from(ball.radius).powi(2);
            if squared_ratio < 1.0 {
                visit(&ball, offset, squared_ratio);
            }
        });
    }

    /// The chords of all balls that the line crosses between its start and its end, those of negative balls
    /// first.
    fn chords(&self, line: &Line) -> Vec<Chord> {
        let mut chords = Vec::new();
        self.tree.for_each(
            |min, max| line.meets(min, max),
            |index| chords.extend(Chord::new(line, &self.scene.ball(index))),
        );
        chords.sort_by_key(|chord| !chord.is_negative());
        chords
    }
}
