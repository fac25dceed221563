//! The search for an entry in one leaf on eight rays at a time, in f32: what
//! `trace/certified/polynomial.rs` does for one ray and eight balls, ball by ball with the rays side by
//! side.
//!
//! Each lane has an interval of its own and the margins of its own ray, and depends on no other. What
//! differs is what saves passes over the balls:
//! - A ball that reaches no ray's interval is left out, and where the greatest values that positive balls
//!   have on an interval do not sum up to T, nothing crosses.
//! - Where a ball reaches T alone, the first interval ends just before its projection.
//! - An interval holds one crossing also where the field is below T at its start and above at its
//!   end, and no ball's part that reaches it decreases on it: the field rises there, whatever rims there are.

use std::mem;

use pulp::{Arch, Simd, WithSimd};

use super::super::bernstein::value_and_rise;
use super::super::kernel::{ByKernel, LaneKernel, by_kernel, has_bounds};
use super::super::lanes::{Lanes, Mask, WIDTH, lanes_of};
use super::super::leaf_polynomial::LeafPolynomial;
use super::super::parabolas::UNIT;
use super::super::polynomial::MOST_INTERVALS;
use super::super::query::{Crossing, Query};
use super::balls::{Balls, RelativePacket};
use super::enclosure::{Encloses, OfBalls};
use super::polynomial::AlongRays;
use super::rays::{ExactPacket, Packet};
use super::root::{Isolated, Roots, approach, approach_from_nearby, refine};

/// Whether packets can be searched for it: for an entry, by bounds of the kernel.
pub(super) fn is_searched_in_packets(query: &Query) -> bool {
    query.crossing == Crossing::Entry && has_bounds(query.kernel)
}

/// What is found, lane by lane; lanes in none of the three f32 cannot decide.
pub(super) struct Found {
    /// Lanes without a crossing.
    pub(super) nothing: Mask,
    /// Lanes with a crossing, for a query that any will do for.
    pub(super) somewhere: Mask,
    /// Lanes whose first crossings are known.
    pub(super) roots: Roots,
}

/// What a leaf is searched by.
pub(super) struct Leaf<'a> {
    pub(super) balls: &'a mut Balls,
    pub(super) polynomial: Option<&'a LeafPolynomial>,
}

/// Searches a leaf that has been loaded, over the intervals of some of the packet's rays.
pub(super) fn search(
    query: &Query,
    arch: Arch,
    leaf: Leaf<'_>,
    (packet, exact): (&Packet, &ExactPacket),
    interval: &(Lanes<f64>, Lanes<f64>),
    lanes: u32,
) -> Found {
    let (nothing, somewhere, roots) = (Mask::NONE, Mask::NONE, Roots::NONE);
    let mut found = Found { nothing, somewhere, roots };
    let (lanes, results) = (Mask::from_bits(lanes), &mut found);
    by_kernel(query.kernel, Search { query, arch, leaf, packet, exact, interval, lanes, results });
    found
}

struct Search<'a> {
    query: &'a Query,
    arch: Arch,
    leaf: Leaf<'a>,
    packet: &'a Packet,
    exact: &'a ExactPacket,
    interval: &'a (Lanes<f64>, Lanes<f64>),
    lanes: Mask,
    results: &'a mut Found,
}

impl ByKernel for Search<'_> {
    type Output = ();

    fn run<K: LaneKernel<N>, const N: usize>(mut self, kernel: K) {
        let arch = self.arch;
        if let Some(polynomial) = self.leaf.polynomial {
            self.lanes = arch.dispatch(ByPolynomial { kernel, search: &mut self, polynomial });
        }
        if self.lanes.any() {
            arch.dispatch(ByBalls { kernel, search: self });
        }
    }
}

/// The search by the leaf's polynomial, as `pulp` compiles it for wider vectors. Its output are the lanes
/// that it leaves open.
struct ByPolynomial<'a, 'b, K, const N: usize> {
    kernel: K,
    search: &'a mut Search<'b>,
    polynomial: &'b LeafPolynomial,
}

impl<K: LaneKernel<N>, const N: usize> WithSimd for ByPolynomial<'_, '_, K, N> {
    type Output = Mask;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Mask {
        let Self { kernel, search, polynomial } = self;
        let Search { packet, exact, interval, .. } = *search;
        let relative = search.leaf.balls.relative(packet, exact, *interval);
        search.by_polynomial(kernel, polynomial, &relative)
    }
}

/// The search by the leaf's balls.
struct ByBalls<'a, K, const N: usize> {
    kernel: K,
    search: Search<'a>,
}

impl<K: LaneKernel<N>, const N: usize> WithSimd for ByBalls<'_, K, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { kernel, mut search } = self;
        let Search { packet, exact, interval, lanes, .. } = search;
        let relative = search.leaf.balls.relative(packet, exact, *interval);
        search.by_balls(kernel, &relative, lanes);
    }
}

/// Intervals of a ray that are searched by the leaf's polynomial: where it decides, two are typical.
const MOST_BY_POLYNOMIAL: usize = 6;

impl Search<'_> {
    /// Searches by the polynomial; the lanes that it leaves open.
    #[inline(always)]
    fn by_polynomial<K: LaneKernel<N>, const N: usize>(
        &mut self,
        kernel: K,
        polynomial: &LeafPolynomial,
        relative: &RelativePacket,
    ) -> Mask {
        let along = AlongRays::new(polynomial, self.packet, self.exact, relative);
        let lanes = self.lanes;
        let isolated =
            self.isolate(&along, relative.half, (lanes, relative.half), MOST_BY_POLYNOMIAL);
        if isolated.found.any() {
            let guess = along.approach(&isolated);
            let part = (isolated.start, isolated.end);
            let Self { packet, exact, .. } = *self;
            let near = relative.surroundings(packet, exact, part, isolated.found);
            self.leaf.balls.keep(&near);
            let balls = &*self.leaf.balls;
            let rays = (packet, relative);
            let guess = approach_from_nearby(kernel, (self.query, balls), rays, &isolated, guess);
            self.finish(kernel, relative, &isolated, guess);
        }
        let Found { nothing, somewhere, roots } = &*self.results;
        lanes & !(*nothing | *somewhere | Mask::from_bits(roots.lanes))
    }

    /// Searches by the balls of the list.
    #[inline(always)]
    fn by_balls<K: LaneKernel<N>, const N: usize>(
        &mut self,
        kernel: K,
        relative: &RelativePacket,
        lanes: Mask,
    ) {
        let back = Lanes::splat(0.0f32) - relative.half;
        let Projected { is_below, end } =
            self.project(kernel, relative, (back, relative.half), lanes);
        self.results.nothing = self.results.nothing | lanes & is_below;
        let open = lanes & !is_below;
        if !open.any() {
            return;
        }
        let end = back.is_less(end).select(end, relative.half);
        let parabolas = mem::take(&mut self.leaf.balls.parabolas);
        let along = OfBalls { kernel, query: self.query, parabolas: &parabolas };
        let isolated = self.isolate::<N>(&along, relative.half, (open, end), MOST_INTERVALS);
        self.leaf.balls.parabolas = parabolas;
        if isolated.found.any() {
            let guess = approach(kernel, (self.query, &*self.leaf.balls), &isolated);
            self.finish(kernel, relative, &isolated, guess);
        }
    }

    /// Finds the roots that are isolated near a guess, by the balls that are kept.
    #[inline(always)]
    fn finish<K: LaneKernel<N>, const N: usize>(
        &mut self,
        kernel: K,
        relative: &RelativePacket,
        isolated: &Isolated,
        guess: Lanes<f32>,
    ) {
        let Self { query, packet, exact, interval, .. } = *self;
        let (rays, roots) = ((packet, exact, relative), &mut self.results.roots);
        let leaf = (query, &*self.leaf.balls);
        refine(kernel, leaf, rays, isolated, guess, interval.1, roots);
    }
}

/// What the balls' projections show.
struct Projected {
    /// Where the field reaches T nowhere.
    is_below: Mask,
    /// Where the first interval is best ended.
    end: Lanes<f32>,
}

impl Search<'_> {
    /// Projects the balls on the rays of some lanes and keeps those that reach an interval.
    #[inline(always)]
    fn project<K: LaneKernel<N>, const N: usize>(
        &mut self,
        kernel: K,
        relative: &RelativePacket,
        (first, last): (Lanes<f32>, Lanes<f32>),
        lanes: Mask,
    ) -> Projected {
        let zero = Lanes::splat(0.0f32);
        let inverse_square_length = self.exact.square.map(|square| (square as f32).recip());
        let threshold = Lanes::splat(self.query.threshold as f32);
        let (mut upper_bound, mut end) = (zero, last);
        let surroundings = relative.surroundings(self.packet, self.exact, (first, last), lanes);
        let Balls { balls, blocks, kept, parabolas, .. } = &mut *self.leaf.balls;
        kept.clear();
        parabolas.clear();
        for (at, block) in blocks.iter().enumerate() {
            for lane in lanes_of(block.near(&surroundings)) {
                let at = WIDTH * at + lane;
                let ball = &balls[at];
                let (parabola, along) = ball.along(self.packet, self.exact, relative);
                let t = (along * inverse_square_length).min(last).max(first);
                let v = parabola.constant + (parabola.linear - parabola.square * t) * t;
                let top = v + parabola.margin;
                if !(lanes & !top.is_at_most(zero)).any() {
                    continue;
                }
                let is_negative = ball.strength < 0.0;
                if !is_negative {
                    // NaN stays NaN.
                    let most = kernel.value(zero.max(top)) * ball.strength;
                    upper_bound += most;
                    // Slope margins before the projection it certainly rises still.
                    let before = t - parabola.margin * ball.radius;
                    end = threshold.is_less(most).select(before.min(end), end);
                }
                kept.push(at as u32);
                parabolas.push(parabola, is_negative);
            }
        }
        let rounding = (parabolas.len() + 34) as f32 * UNIT;
        Projected { is_below: (upper_bound * (1.0 + rounding)).is_less(threshold), end }
    }

    /// Front to back, each lane on its own: nothing crosses before `start`. Lanes that cannot decide
    /// are in no mask. The first interval ends at `end`, and at most so many are searched.
    #[inline(always)]
    fn isolate<const N: usize>(
        &mut self,
        along: &impl Encloses<N>,
        last: Lanes<f32>,
        (mut open, mut end): (Mask, Lanes<f32>),
        most_intervals: usize,
    ) -> Isolated {
        let zero = Lanes::splat(0.0f32);
        let mut start = zero - last;
        let mut isolated = Isolated { found: Mask::NONE, start: zero, end: zero, guess: zero };
        // A step this long exceeds the rounding of a sum.
        let step = last * (4.0 * UNIT);
        for _ in 0..most_intervals {
            let bounds = along.enclosure(start, end);
            // Not where a ray starts inside, nor where rounding is as large as T.
            open = open & bounds.is_known & bounds.start.is_less(zero);
            if self.query.any {
                let inside = zero.is_less(bounds.ends[0]) | zero.is_less(bounds.ends[1]);
                self.results.somewhere = self.results.somewhere | open & inside;
                open = open & !inside;
            }
            let is_below = bounds.upper.iter().fold(open, |below, c| below & c.is_less(zero));
            let is_last = last.is_at_most(end);
            self.results.nothing = self.results.nothing | is_below & is_last;
            let rises = bounds.increases & zero.is_less(bounds.ends[1]);
            let once = open & (rises | bounds.is_exact & bounds.changes_sign_once());
            if once.any() {
                isolated.found = isolated.found | once;
                isolated.start = once.select(start, isolated.start);
                isolated.end = once.select(end, isolated.end);
                let guess = start + (end - start) * bounds.polygon_crossing();
                isolated.guess = once.select(guess, isolated.guess);
            }
            open = open & !once & !(is_below & is_last);
            if !open.any() {
                break;
            }
            let width = end - start;
            // No crossing before `clear`; nor a little short of it, where the field is clear of T.
            let clear = bounds.negative_until();
            let mut until = clear.map(|clear| {
                if clear * (15.0 / 16.0) > 0.25 { 1.0 } else { 0.5 + 0.5 * clear * (15.0 / 16.0) }
            });
            let may_be_above =
                bounds.lower.iter().fold(Mask::NONE, |may, &c| may | zero.is_less(c));
            if (open & may_be_above).any() {
                for part in [0.5, 1.0 / 8.0, 1.0 / 32.0] {
                    let x = clear + (Lanes::splat(1.0) - clear) * part;
                    let is_above = zero.is_less(value_and_rise(bounds.lower, x).0);
                    until = is_above.select(x, until);
                }
            }
            let ahead = start + (width * clear * (15.0 / 16.0) - step).max(zero);
            let beyond = (start + width * until + step).min(end);
            let far = (end + width * 2.0).min(last);
            start = is_below.select(end, ahead);
            end = is_below.select(far, beyond);
            open = open & start.is_less(end);
        }
        isolated
    }
}
