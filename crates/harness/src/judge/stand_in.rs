//! A field that a method searches instead of the scene's: how far from it, along one ray.
//!
//! A hit of the stand-in τ is no root of the field F. But where τ is within δ of F all along a ray, a
//! root of τ is a point where F is within δ of the threshold, and where the truth has a margin above
//! δ the two have the same verdict, on the same front.

use illes_fraglist::{Deviation, Piece, cubic_deviation};
use metaball_core::reference::Truth;
use metaball_core::{Kernel, Metaball, Ray, Scene};

/// The chords of one ray, and what a cubic may differ on each.
#[derive(Debug)]
pub struct StandIn {
    chords: Vec<Chord>,
    deviation: Deviation,
    is_running: bool,
}

/// A ball's interval of a ray.
#[derive(Debug)]
struct Chord {
    middle: f64,
    half: f64,
    /// The ball's field at the middle.
    peak: f64,
    /// Distance from the eye to the support sphere.
    effective_distance: f64,
}

impl StandIn {
    /// Piecewise cubics; `None` where the piece is the field itself.
    pub fn new(piece: Piece, scene: &Scene, ray: &Ray) -> Option<Self> {
        (!piece.is_exact()).then(|| Self {
            chords: chords(scene, ray),
            deviation: cubic_deviation(scene.kernel()),
            is_running: piece == Piece::Running,
        })
    }

    /// Bounds on F − τ at t.
    pub fn at(&self, t: f64) -> (f64, f64) {
        // A ball that rounding puts on the other side of its rim adds nothing there, but it may be
        // the one whose γ another rounding took: count it.
        let covering = |chord: &&Chord| (t - chord.middle).abs() <= 1.001 * chord.half;
        let peaks: f64 = self.chords.iter().filter(covering).map(|chord| chord.peak).sum();
        let rounding = self.rounding_at(t);
        (self.deviation.least * peaks - rounding, self.deviation.greatest * peaks + rounding)
    }

    /// Whether the stand-in must have the field's verdict, on the field's first front.
    pub fn keeps(&self, truth: &Truth, threshold: f32) -> bool {
        // Both bounds only grow where a chord begins.
        let starts = self.chords.iter().map(|chord| (chord.middle - chord.half).max(0.0));
        let before = starts.filter(|&start| start <= truth.exit);
        let greatest = before.map(|start| {
            let (least, greatest) = self.at(start);
            greatest.max(-least)
        });
        truth.margin * f64::from(threshold) > greatest.fold(0.0, f64::max)
    }

    /// A coefficient of Δw is γ/Q³ times up to 12s³, made in about ten operations from an s that is
    /// itself off by a few: the sum of the four loses below 600 roundings of 2⁻²⁴ times γ(s/Q)³ for
    /// each of a ball's three Δw, and what is lost stays.
    fn rounding_at(&self, t: f64) -> f64 {
        if !self.is_running {
            return 0.0;
        }
        let before = self.chords.iter().filter(|chord| chord.middle - 1.001 * chord.half <= t);
        let powers = before.map(|chord| {
            let ratio = (chord.middle.abs() + chord.half) / chord.half;
            chord.peak * ratio.powi(3)
        });
        3.0 * 600.0 * 0.5 * f64::from(f32::EPSILON) * powers.sum::<f64>()
    }
}

/// Whether a ray's separators may be more than the capacity of its array. The array holds at most three
/// of each ball that is taken from the list and not left behind; the balls up to one are taken when
/// the ray is passed up to its effective distance.
pub fn may_overflow(capacity: usize, scene: &Scene, ray: &Ray) -> bool {
    let mut chords = chords(scene, ray);
    chords.sort_by(|a, b| a.effective_distance.total_cmp(&b.effective_distance));
    chords.iter().enumerate().any(|(index, next)| {
        let kept = |chord: &&Chord| chord.middle + 1.001 * chord.half > next.effective_distance;
        3 * chords[..index].iter().filter(kept).count() + 3 > capacity
    })
}

fn chords(scene: &Scene, ray: &Ray) -> Vec<Chord> {
    let all = scene.balls().filter_map(|ball| Chord::new(&ball, scene.kernel(), ray));
    all.collect()
}

impl Chord {
    fn new(ball: &Metaball, kernel: Kernel, ray: &Ray) -> Option<Self> {
        let to_center = ball.center.as_dvec3() - ray.origin.as_dvec3();
        let direction = ray.direction.as_dvec3();
        let middle = to_center.dot(direction) / direction.length_squared();
        let off_axis = (to_center - middle * direction).length_squared();
        let radius = f64::from(ball.radius);
        let half_squared = radius * radius - off_axis;
        if half_squared <= 0.0 || middle + half_squared.sqrt() < 0.0 {
            return None;
        }
        Some(Self {
            middle,
            half: half_squared.sqrt(),
            peak: f64::from(ball.strength) * kernel.value(off_axis / (radius * radius)),
            effective_distance: to_center.length() - radius,
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn scene(count: usize) -> Scene {
        let ball = Metaball::new(Vec3::new(0.0, 0.0, 5.0), 1.0);
        Scene::new(vec![ball; count], Kernel::QUARTIC, 0.5).expect("legal")
    }

    #[test]
    fn an_array_of_96_holds_32_balls() {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        assert!(!may_overflow(96, &scene(32), &ray));
        assert!(may_overflow(96, &scene(33), &ray));
    }

    /// The quartic's cubic is below it by at most a sixteenth of the midpoint's value, and the bound
    /// is rounded up by 1e-3.
    #[test]
    fn deviations_add_up() {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        let stand_in = StandIn::new(Piece::Rebuilt, &scene(3), &ray).expect("a cubic");
        let (least, greatest) = stand_in.at(4.5);
        assert!((-0.01..=0.0).contains(&least), "{least}");
        assert!((greatest - 3.0 / 16.0).abs() < 4e-3, "{greatest}");
        assert_eq!(stand_in.at(7.0), (0.0, 0.0));
        assert!(StandIn::new(Piece::Exact, &scene(3), &ray).is_none());
    }
}
