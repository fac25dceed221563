//! The roots that a packet's search has isolated: first in f32, then by Newton's steps in f64 on the
//! field itself.

use glam::DVec3;

use super::super::kernel::{slope, value, value_and_slope};
use super::super::lanes::{Lanes, Mask, WIDTH, array_of, lanes_of};
use super::super::query::Query;
use super::balls::{Balls, RelativePacket};
use super::rays::Packet;

/// Where lanes have isolated a root: the only one of an interval.
pub(super) struct Isolated {
    pub(super) found: Mask,
    pub(super) start: Lanes<f32>,
    pub(super) end: Lanes<f32>,
    /// Somewhere near it.
    pub(super) guess: Lanes<f32>,
}

/// Roots that are known, lane by lane.
pub(super) struct Roots {
    pub(super) lanes: u32,
    /// The ray's t, and the gradient of the field there.
    pub(super) roots: [(f64, DVec3); WIDTH],
}

impl Roots {
    pub(super) const NONE: Self = Self { lanes: 0, roots: [(0.0, DVec3::ZERO); WIDTH] };
}

/// The roots to what f32 can resolve: Newton's steps, kept between the ends.
#[inline(always)]
pub(super) fn approach<const N: usize>(
    query: &Query,
    balls: &Balls,
    isolated: &Isolated,
) -> Lanes<f32> {
    const MOST_STEPS: usize = 12;
    let zero = Lanes::splat(0.0f32);
    let Isolated { found, start: mut low, end: mut high, guess: mut t } = *isolated;
    // The next error is the square of this.
    let near = (high - low) * 1e-4;
    for _ in 0..MOST_STEPS {
        let mut excess = Lanes::splat(-query.threshold as f32);
        let mut rise = zero;
        for ball in &balls.parabolas {
            let v = ball.constant + (ball.linear - ball.square * t) * t;
            let v = v.max(zero);
            excess += ball.strength * value::<N>(query.kernel, v);
            let along = ball.linear - ball.square * t * 2.0;
            rise += ball.strength * slope::<N>(query.kernel, v) * along;
        }
        let is_above = zero.is_at_most(excess);
        high = is_above.select(t, high);
        low = is_above.select(low, t);
        let newton = t - excess.zip(rise, |excess, rise| excess / rise);
        let is_between = low.is_less(newton) & newton.is_less(high);
        let next = is_between.select(newton, (low + high) * 0.5);
        let moves = near.is_less((next - t).map(f32::abs));
        t = next;
        if !(moves & found).any() {
            break;
        }
    }
    t
}

/// The roots near the guesses, and the field's gradients there. `interval` is the rays' in the leaf.
#[inline(always)]
pub(super) fn refine<const N: usize>(
    query: &Query,
    balls: &Balls,
    (packet, relative): (&Packet, &RelativePacket),
    isolated: &Isolated,
    guess: Lanes<f32>,
    interval: (Lanes<f64>, Lanes<f64>),
) -> Roots {
    const MOST_STEPS: usize = 6;
    let Isolated { found, start, end, .. } = *isolated;
    let direction: [_; 3] = array_of(|axis| packet.direction[axis].map(f64::from));
    let mut t = guess.map(f64::from);
    // A step leaves an error of its square, and the normal, from before it, is off by the step over the
    // distance from a centre. But for α = 1, whose slope jumps at a rim, it may leave as much again.
    let last = if N == 3 { 1e-8 } else { 1e-6 };
    let radii = balls.kept.iter().map(|&at| balls.balls[at as usize].radius);
    let last_step = last * f64::from(radii.fold(f32::INFINITY, f32::min));
    let (mut roots, mut open) = (Roots::NONE, found.bits());
    for _ in 0..MOST_STEPS {
        let (excess, gradient) =
            excess_and_gradient::<N>(query, balls, &relative.origin, &direction, t);
        let [x, y, z] = gradient;
        let rise = x * direction[0] + y * direction[1] + z * direction[2];
        let step = excess.zip(rise, |excess, rise| excess / rise);
        t = t - step;
        for lane in lanes_of(open) {
            let (here, step) = (t.0[lane], step.0[lane]);
            let is_between = here >= f64::from(start.0[lane]) && here <= f64::from(end.0[lane]);
            let is_close = step.abs() <= last_step.min(last * f64::from(relative.half.0[lane]));
            if is_between && !is_close {
                continue;
            }
            open &= !(1 << lane);
            let t = relative.base.0[lane] + here;
            // Past the ray's end by a rounding: too close to decide here.
            if is_between && t <= interval.1.0[lane] {
                let gradient = DVec3::from(array_of(|axis| gradient[axis].0[lane]));
                roots.lanes |= 1 << lane;
                roots.roots[lane] = (t.max(interval.0.0[lane]), gradient);
            }
        }
        if open == 0 {
            break;
        }
    }
    roots
}

/// F − T and the gradient of F, 1/scene unit.
#[inline(always)]
fn excess_and_gradient<const N: usize>(
    query: &Query,
    balls: &Balls,
    origin: &[Lanes<f64>; 3],
    direction: &[Lanes<f64>; 3],
    t: Lanes<f64>,
) -> (Lanes<f64>, [Lanes<f64>; 3]) {
    let mut point = *origin;
    for axis in 0..3 {
        point[axis] += t * direction[axis];
    }
    let mut sum = Lanes::splat(-query.threshold);
    let mut gradient = [Lanes::splat(0.0f64); 3];
    for &at in &balls.kept {
        let ball = &balls.balls[at as usize];
        let [x, y, z] = array_of(|axis| Lanes::splat(ball.exact[axis]) - point[axis]);
        let v =
            (x * x + y * y + z * z).map(|distance| (1.0 - distance * ball.inverse_square).max(0.0));
        let strength = f64::from(ball.strength);
        let (value, slope) = value_and_slope::<N>(query.kernel, v);
        sum += value * strength;
        let pull = slope * (strength * ball.inverse_square * 2.0);
        for (sum, offset) in gradient.iter_mut().zip([x, y, z]) {
            *sum += offset * pull;
        }
    }
    (sum, gradient)
}
