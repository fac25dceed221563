//! The roots that a packet's search has isolated: first in f32, then to the nearest float.

use glam::DVec3;

use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, Mask, WIDTH, array_of, lanes_of};
use super::super::nearest_float::{Excess, MOST_LOOKS, NearestFloat, Next};
use super::super::parabolas::Parabolas;
use super::super::query::Query;
use super::balls::{Balls, RelativePacket};
use super::rays::{ExactPacket, Packet};

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
    pub(super) roots: [(f32, DVec3); WIDTH],
}

impl Roots {
    pub(super) const NONE: Self = Self { lanes: 0, roots: [(0.0, DVec3::ZERO); WIDTH] };
}

/// A step in f32 that is short enough for f64, in lengths of the interval: the next error is its square.
const NEAR: f32 = 3e-3;

/// The roots, roughly: Newton's steps, kept between the ends.
#[inline(always)]
pub(super) fn approach<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, balls): (&Query, &Balls),
    isolated: &Isolated,
) -> Lanes<f32> {
    const MOST_STEPS: usize = 12;
    let zero = Lanes::splat(0.0f32);
    let Isolated { found, start: mut low, end: mut high, guess: mut t } = *isolated;
    let near = (high - low) * NEAR;
    for _ in 0..MOST_STEPS {
        let mut excess = Lanes::splat(-query.threshold as f32);
        let mut rise = zero;
        let parts = |ball: &Parabolas, t: Lanes<f32>| {
            let v = ball.constant + (ball.linear - ball.square * t) * t;
            let v = v.max(zero);
            let along = ball.linear - ball.square * t * 2.0;
            (ball.strength * kernel.value(v), ball.strength * kernel.slope(v) * along)
        };
        for ball in &balls.parabolas.positive {
            let (value, slope) = parts(ball, t);
            excess += value;
            rise += slope;
        }
        for ball in &balls.parabolas.negative {
            let (value, slope) = parts(ball, zero - t);
            excess = excess - value;
            rise += slope;
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

/// The roots, roughly, from guesses near them: Newton's steps on the balls themselves.
#[inline(always)]
pub(super) fn approach_from_nearby<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, balls): (&Query, &Balls),
    (packet, relative): (&Packet, &RelativePacket),
    isolated: &Isolated,
    guess: Lanes<f32>,
) -> Lanes<f32> {
    const MOST_STEPS: usize = 3;
    let zero = Lanes::splat(0.0f32);
    let Isolated { found, start, end, .. } = *isolated;
    let mut t = guess;
    let near = relative.half * NEAR;
    for _ in 0..MOST_STEPS {
        let mut point = packet.direction;
        for (coordinate, origin) in point.iter_mut().zip(&relative.origin) {
            *coordinate = origin.map(|x| x as f32) + t * *coordinate;
        }
        let mut excess = Lanes::splat(-query.threshold as f32);
        let mut rise = zero;
        for &at in &balls.kept {
            let ball = &balls.balls[at as usize];
            let (mut square, mut along) = (zero, zero);
            for (axis, direction) in packet.direction.iter().enumerate() {
                let offset = Lanes::splat(ball.center[axis]) - point[axis];
                square += offset * offset;
                along += offset * *direction;
            }
            let v = (square * ball.inverse_square_f32).map(|square| 1.0 - square).max(zero);
            excess += kernel.value(v) * ball.strength;
            let weight = 2.0 * ball.strength * ball.inverse_square_f32;
            rise += kernel.slope(v) * along * weight;
        }
        let next = (t - excess.zip(rise, |excess, rise| excess / rise)).min(end).max(start);
        let moves = near.is_less((next - t).map(f32::abs));
        t = next;
        if !(moves & found).any() {
            break;
        }
    }
    t
}

/// The floats nearest to the roots near the guesses, and the field's gradients there. The rays leave the
/// leaf at `end`. They are added to `roots`.
#[inline(always)]
pub(super) fn refine<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, balls): (&Query, &Balls),
    (packet, exact, relative): (&Packet, &ExactPacket, &RelativePacket),
    isolated: &Isolated,
    guess: Lanes<f32>,
    end: Lanes<f64>,
    roots: &mut Roots,
) {
    let origin = array_of(|axis| exact.origin[axis] - Lanes::splat(balls.middle[axis]));
    let direction = array_of(|axis| packet.direction[axis].map(f64::from));
    let guess = relative.base + guess.map(f64::from);
    let mut searches: [_; WIDTH] = array_of(|lane| {
        let from_base = |t: &Lanes<f32>| relative.base.0[lane] + f64::from(t.0[lane]);
        // Past the interval's end by a rounding: too close to decide here.
        let last = from_base(&isolated.end).min(end.0[lane]);
        let ends = (from_base(&isolated.start), last);
        let limits = (packet.t_min.0[lane], packet.t_max.0[lane]);
        NearestFloat::new(guess.0[lane], ends, limits, balls.least_radius, kernel.has_kink())
    });
    let mut open = isolated.found.bits();
    for _ in 0..MOST_LOOKS {
        let t = Lanes(array_of(|lane| searches[lane].at));
        let field = excess(kernel, (query, balls), &origin, &direction, t);
        for lane in lanes_of(open) {
            match searches[lane].look(field.lane(lane)) {
                Next::Another => continue,
                Next::Found(t, gradient) => {
                    roots.lanes |= 1 << lane;
                    roots.roots[lane] = (t, gradient);
                }
                Next::Lost => {}
            }
            open &= !(1 << lane);
        }
        if open == 0 {
            break;
        }
    }
}

/// [`Excess`], lane by lane.
struct Excesses {
    value: Lanes<f64>,
    gradient: [Lanes<f64>; 3],
    slope: Lanes<f64>,
}

impl Excesses {
    #[inline(always)]
    fn lane(&self, lane: usize) -> Excess {
        let gradient = DVec3::from(array_of(|axis| self.gradient[axis].0[lane]));
        Excess { value: self.value.0[lane], gradient, slope: self.slope.0[lane] }
    }
}

/// The field at points of the rays, by the balls that are kept: the others add nothing, not even a
/// rounding.
#[inline(always)]
fn excess<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, balls): (&Query, &Balls),
    origin: &[Lanes<f64>; 3],
    direction: &[Lanes<f64>; 3],
    t: Lanes<f64>,
) -> Excesses {
    let point: [_; 3] = array_of(|axis| origin[axis] + t * direction[axis]);
    let mut value = Lanes::splat(-query.threshold);
    let mut gradient = [Lanes::splat(0.0f64); 3];
    for &at in &balls.kept {
        let ball = &balls.balls[at as usize];
        let [x, y, z] = array_of(|axis| Lanes::splat(ball.exact[axis]) - point[axis]);
        let v =
            (x * x + y * y + z * z).map(|distance| (1.0 - distance * ball.inverse_square).max(0.0));
        let strength = f64::from(ball.strength);
        let (part, slope) = kernel.value_and_slope(v);
        value += part * strength;
        let pull = slope * (strength * ball.inverse_square * 2.0);
        for (sum, offset) in gradient.iter_mut().zip([x, y, z]) {
            *sum += offset * pull;
        }
    }
    let [x, y, z] = array_of(|axis| gradient[axis] * direction[axis]);
    Excesses { value, gradient, slope: x + y + z }
}
