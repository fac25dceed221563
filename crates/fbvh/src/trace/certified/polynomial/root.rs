//! Newton's steps to the only root of an interval, in f64 on the field itself.

use glam::DVec3;
use metaball_core::Ray;

use super::super::kernel::LaneKernel;
use super::super::lanes::{Lanes, array_of};
use super::super::nearest_float::{Excess, MOST_LOOKS, NearestFloat, Next};
use super::super::query::{Answer, Query};
use super::blocks::Blocks;
use crate::trace::counter::Counter;

/// The float nearest to the root near a guess, which has to lie between the ends, all in the ray's t.
#[inline(always)]
pub(super) fn nearest_float<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, blocks): (&Query, &Blocks),
    ray: &Ray,
    guess: f64,
    ends: (f64, f64),
    counter: &mut impl Counter,
) -> Answer {
    let origin = ray.origin.as_dvec3() - blocks.middle;
    let direction = ray.direction.as_dvec3();
    let limits = (ray.t_min, ray.t_max);
    let (radius, kink) = (blocks.least_radius, kernel.has_kink());
    let mut search = NearestFloat::new(guess, ends, limits, radius, kink);
    for _ in 0..MOST_LOOKS {
        counter.iteration();
        let point = origin + search.at * direction;
        match search.look(excess(kernel, (query, blocks), point, direction)) {
            Next::Another => {}
            Next::Found(t, gradient) => return Answer::Root(t, gradient),
            Next::Lost => break,
        }
    }
    Answer::Undecided
}

/// The field at a point, relative to the middle of the leaf's box. Each ball's part is what
/// `trace/certified/packet/root.rs` makes of it, and they are added up in the same order.
#[inline(always)]
fn excess<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, blocks): (&Query, &Blocks),
    point: DVec3,
    direction: DVec3,
) -> Excess {
    let (mut value, mut gradient) = (-query.threshold, DVec3::ZERO);
    for block in &blocks.blocks {
        let offset: [_; 3] =
            array_of(|axis| block.exact[axis] - Lanes::splat(point.to_array()[axis]));
        let [x, y, z] = offset;
        let v = (x * x + y * y + z * z)
            .zip(block.inverse_square, |distance, inverse| (1.0 - distance * inverse).max(0.0));
        let strength = block.strength.map(f64::from);
        let (values, slopes) = kernel.value_and_slope(v);
        let values = values * strength;
        let pull = slopes * (strength * block.inverse_square * 2.0);
        let pulls: [_; 3] = array_of(|axis| offset[axis] * pull);
        for (lane, part) in values.0.into_iter().enumerate() {
            value += part;
            gradient += DVec3::from(array_of(|axis| pulls[axis].0[lane]));
        }
    }
    let [x, y, z] = (gradient * direction).to_array();
    Excess { value, gradient, slope: x + y + z }
}
