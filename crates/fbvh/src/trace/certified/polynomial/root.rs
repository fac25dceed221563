//! Newton's steps to the only root of an interval, in f64 on the field itself.

use glam::DVec3;

use super::super::kernel::value_and_slope;
use super::super::lanes::{Lanes, array_of};
use super::super::query::{Answer, Query};
use super::blocks::{Blocks, RelativeRay};
use crate::trace::counter::Counter;

/// The root near a guess between `start` and `end`, and the field's gradient there. `interval` is the
/// ray's in the leaf.
#[inline(always)]
pub(super) fn refine<const N: usize>(
    query: &Query,
    blocks: &Blocks,
    ray: &RelativeRay,
    guess: f64,
    (start, end): (f32, f32),
    interval: (f64, f64),
    counter: &mut impl Counter,
) -> Answer {
    const MOST_STEPS: usize = 6;
    let mut t = guess;
    for _ in 0..MOST_STEPS {
        counter.iteration();
        let (excess, gradient) = excess_and_gradient::<N>(query, blocks, ray, t);
        let step = excess / gradient.dot(ray.direction);
        t -= step;
        if !(t >= f64::from(start) && t <= f64::from(end)) {
            return Answer::Undecided;
        }
        // An f32 holds no more. Not sooner: behind the rim of a support slopes may differ, and
        // then the next error is as large as the step.
        if step.abs() <= 1e-8 * f64::from(ray.half) {
            let t = ray.base + t;
            // Past the ray's end by a rounding: too close to decide here.
            return if t <= interval.1 {
                Answer::Root(t.max(interval.0), gradient)
            } else {
                Answer::Undecided
            };
        }
    }
    Answer::Undecided
}

/// F − T and the gradient of F, 1/scene unit.
#[inline(always)]
fn excess_and_gradient<const N: usize>(
    query: &Query,
    blocks: &Blocks,
    ray: &RelativeRay,
    t: f64,
) -> (f64, DVec3) {
    let point = (ray.origin + t * ray.direction).to_array();
    let zero = Lanes::splat(0.0f64);
    let (mut sum, mut gradient) = (zero, [zero; 3]);
    for block in &blocks.blocks {
        let [x, y, z] = array_of(|axis| block.exact[axis] - Lanes::splat(point[axis]));
        let v = (x * x + y * y + z * z)
            .zip(block.inverse_square, |distance, inverse| (1.0 - distance * inverse).max(0.0));
        let strength = block.strength.map(f64::from);
        let (value, slope) = value_and_slope::<N>(query.kernel, v);
        sum += value * strength;
        let pull = slope * strength * block.inverse_square * 2.0;
        for (sum, offset) in gradient.iter_mut().zip([x, y, z]) {
            *sum += offset * pull;
        }
    }
    let gradient = DVec3::from(array_of(|axis| gradient[axis].sum()));
    (sum.sum() - query.threshold, gradient)
}
