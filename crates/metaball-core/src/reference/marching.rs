//! The second oracle: marching with interval bounds over all balls.
//!
//! Slow and plain on purpose. It uses no tree, no chords, no polynomials and no derivatives: only
//! that each ball's part of the field rises along the ray to the point nearest to the ball's centre
//! and falls from there, or the other way round if it is negative, so that its range on an interval is known
//! exactly.

use glam::DVec3;

use crate::{Metaball, Ray, Scene, Verdict};

/// Length at which intervals are no longer halved, in shares of t plus the least radius.
const RESOLUTION: f64 = 1e-10;

/// By how much, relatively, bounds are widened against rounding.
const GUARD: f64 = 1e-12;

/// What marching found along a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct March {
    /// `Undecided` when the field might reach T between `low` and `high` only.
    pub verdict: Verdict,
    /// The first hit lies between `low` and `high`, in t as for [`Hit`](crate::Hit): both `t_min`
    /// inside, both +∞ for a miss.
    pub low: f64,
    /// See `low`.
    pub high: f64,
}

/// Finds the first hit by halving the ray until every interval is certainly below T, or reaches T,
/// or is shorter than 1e-10 of t. Takes time proportional to the number of balls times the number
/// of intervals, which grows without limit where a ray grazes: a check for tests, of rays and
/// scenes that are not too large.
pub fn march(scene: &Scene, ray: &Ray) -> March {
    let threshold = f64::from(scene.threshold());
    let profiles = Profiles::new(scene, ray);
    let nothing = March { verdict: Verdict::Miss, low: f64::INFINITY, high: f64::INFINITY };
    if ray.is_empty() {
        return nothing;
    }
    let start = f64::from(ray.t_min);
    if profiles.field(start) >= threshold {
        return March { verdict: Verdict::Inside, low: start, high: start };
    }

    // Start of the undecided intervals that end where the present one begins.
    let mut undecided: Option<f64> = None;
    let mut pending = vec![(start, profiles.end)];
    while let Some((from, to)) = pending.pop() {
        if profiles.upper_bound(from, to) < threshold {
            if let Some(low) = undecided {
                return March { verdict: Verdict::Undecided, low, high: from };
            }
            continue;
        }
        let middle = 0.5 * (from + to);
        let shortest = RESOLUTION * (to + profiles.smallest_radius);
        if to - from > shortest && from < middle && middle < to {
            pending.extend([(middle, to), (from, middle)]);
        } else if profiles.field(to) >= threshold {
            return March { verdict: Verdict::Hit, low: undecided.unwrap_or(from), high: to };
        } else {
            undecided = undecided.or(Some(from));
        }
    }
    match undecided {
        Some(low) => March { verdict: Verdict::Undecided, low, high: profiles.end },
        None => nothing,
    }
}

/// All balls along a ray.
struct Profiles<'a> {
    scene: &'a Scene,
    origin: DVec3,
    direction: DVec3,
    balls: Vec<(Metaball, f64)>,
    end: f64,
    smallest_radius: f64,
}

impl<'a> Profiles<'a> {
    fn new(scene: &'a Scene, ray: &Ray) -> Self {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let nearest = |ball: &Metaball| {
            (ball.center.as_dvec3() - origin).dot(direction) / direction.length_squared()
        };
        let balls: Vec<_> = scene.balls().map(|ball| (ball, nearest(&ball))).collect();
        let reach = |(ball, nearest): &(Metaball, f64)| {
            nearest + f64::from(ball.radius) / direction.length()
        };
        Self {
            scene,
            origin,
            direction,
            end: balls.iter().map(reach).fold(ray.t_min.into(), f64::max).min(ray.t_max.into()),
            smallest_radius: scene
                .supports()
                .iter()
                .fold(f64::INFINITY, |least, support| least.min(f64::from(support.radius))),
            balls,
        }
    }

    fn value(&self, ball: &Metaball, t: f64) -> f64 {
        let offset = self.origin + t * self.direction - ball.center.as_dvec3();
        let squared_ratio = offset.length_squared() / f64::from(ball.radius).powi(2);
        f64::from(ball.strength) * self.scene.kernel().value(squared_ratio)
    }

    fn field(&self, t: f64) -> f64 {
        self.balls.iter().map(|(ball, _)| self.value(ball, t)).sum()
    }

    /// The sum of each ball's greatest value on the interval, with its guard.
    fn upper_bound(&self, from: f64, to: f64) -> f64 {
        let greatest = |(ball, nearest): &(Metaball, f64)| {
            if ball.is_negative() {
                self.value(ball, from).max(self.value(ball, to)) * (1.0 - GUARD)
            } else {
                self.value(ball, nearest.max(from).min(to)) * (1.0 + GUARD)
            }
        };
        self.balls.iter().map(greatest).sum()
    }
}
