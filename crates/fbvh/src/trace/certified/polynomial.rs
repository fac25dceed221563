//! The search for a crossing in one leaf on one ray, in f32, eight balls at a time, by Bernstein
//! coefficients. What it cannot decide is left to `trace/certified/ranges.rs`.

mod blocks;
mod enclosure;
mod root;

use glam::DVec3;
use metaball_core::Ray;
use pulp::{Arch, Simd, WithSimd};

pub(super) use self::blocks::Blocks;
use self::blocks::RelativeRay;
use self::enclosure::Enclosure;
use super::bernstein::{negative_until, only_root, value_and_slope};
use super::kernel::{ByKernel, LaneKernel, by_kernel};
use super::query::{Answer, Query};
use crate::trace::counter::Counter;

/// Intervals examined before the search gives up: two are typical.
pub(super) const MOST_INTERVALS: usize = 24;

/// Searches a leaf that has been loaded, over the ray's interval in it.
pub(super) fn search(
    query: &Query,
    arch: Arch,
    blocks: &mut Blocks,
    (ray, interval): (&Ray, (f64, f64)),
    counter: &mut impl Counter,
) -> Answer {
    let search = Search { query, arch, blocks, ray, interval, counter };
    by_kernel(query.kernel, search).unwrap_or(Answer::Undecided)
}

/// The float nearest to a root that is known to be near a guess, and the gradient there, by the balls of
/// a leaf that has been loaded; `None` for a kernel that lanes do not have, or where Newton's steps lead
/// elsewhere.
pub(super) fn nearest_float(
    query: &Query,
    blocks: &Blocks,
    ray: &Ray,
    guess: f64,
) -> Option<(f32, DVec3)> {
    match by_kernel(query.kernel, Nearest { query, blocks, ray, guess })? {
        Answer::Root(t, gradient) => Some((t, gradient)),
        _ => None,
    }
}

struct Nearest<'a> {
    query: &'a Query,
    blocks: &'a Blocks,
    ray: &'a Ray,
    guess: f64,
}

impl ByKernel for Nearest<'_> {
    type Output = Answer;

    fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Answer {
        let Self { query, blocks, ray, guess } = self;
        let gap = 2.0 * f64::from(f32::EPSILON) * guess.abs();
        let ends = (guess - gap, guess + gap);
        root::nearest_float(kernel, (query, blocks), ray, guess, ends, &mut ())
    }
}

struct Search<'a, C> {
    query: &'a Query,
    arch: Arch,
    blocks: &'a mut Blocks,
    ray: &'a Ray,
    interval: (f64, f64),
    counter: &'a mut C,
}

impl<C: Counter> ByKernel for Search<'_, C> {
    type Output = Answer;

    fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Answer {
        self.arch.dispatch(SearchOfKernel::<K, N, C> { kernel, search: self })
    }
}

/// The search, as `pulp` compiles it for wider vectors.
struct SearchOfKernel<'a, K, const N: usize, C> {
    kernel: K,
    search: Search<'a, C>,
}

impl<K: LaneKernel<N>, const N: usize, C: Counter> WithSimd for SearchOfKernel<'_, K, N, C> {
    type Output = Answer;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Answer {
        let Self { kernel, search: Search { query, blocks, ray, interval, counter, .. } } = self;
        let relative = blocks.relative(ray, interval);
        blocks.project(ray, &relative);
        search_by_bounds(kernel, (query, blocks), (ray, &relative), interval, counter)
    }
}

/// Front to back: nothing crosses before `start`.
#[inline(always)]
fn search_by_bounds<K: LaneKernel<N>, const N: usize>(
    kernel: K,
    (query, blocks): (&Query, &Blocks),
    (ray, relative): (&Ray, &RelativeRay),
    interval: (f64, f64),
    counter: &mut impl Counter,
) -> Answer {
    let last = relative.half;
    let (mut start, mut end) = (-last, last);
    for count in 0..MOST_INTERVALS {
        counter.evaluation();
        let Some(bounds) = Enclosure::new(kernel, query, &blocks.parabolas, (start, end)) else {
            return Answer::Undecided;
        };
        if count == 0 && relative.starts && bounds.start >= 0.0 {
            let is_beyond = bounds.ends[0] > 0.0;
            return if is_beyond { Answer::StartsBeyond } else { Answer::Undecided };
        }
        if query.any && (bounds.ends[0] > 0.0 || bounds.ends[1] > 0.0) {
            return Answer::Somewhere;
        }
        if bounds.upper.iter().all(|&most| most < 0.0) {
            if end >= last {
                return Answer::Nothing;
            }
            (start, end) = (end, (end + 2.0 * (end - start)).min(last));
            continue;
        }
        if bounds.start >= 0.0 {
            return Answer::Undecided;
        }
        let width = f64::from(end) - f64::from(start);
        if bounds.is_exact && bounds.changes_sign_once() || bounds.increases && bounds.ends[1] > 0.0
        {
            let x = only_root(&bounds.middle());
            let from_base = |t: f64| relative.base + t;
            let guess = from_base(f64::from(start) + x * width);
            // Past the interval's end by a rounding: too close to decide here.
            let end = from_base(f64::from(end)).min(interval.1);
            let ends = (from_base(f64::from(start)), end);
            return root::nearest_float(kernel, (query, blocks), ray, guess, ends, counter);
        }
        // No crossing before `clear`; nor a little short of it, where the field is clear of T.
        let begins_above = bounds.upper[0] >= 0.0;
        let clear = if begins_above { 0.0 } else { negative_until(bounds.upper).unwrap_or(1.0) };
        let beyond = [1.0 / 32.0, 1.0 / 8.0, 0.5]
            .map(|part| clear + part * (1.0 - clear))
            .into_iter()
            .find(|&x| value_and_slope(bounds.lower, x).0 > 0.0);
        if query.any && beyond.is_some() {
            return Answer::Somewhere;
        }
        let clear = clear * (15.0 / 16.0);
        let until = beyond.unwrap_or(if clear > 0.25 { 1.0 } else { 0.5 + 0.5 * clear });
        let next = ((f64::from(start) + clear * width) as f32).max(start);
        end = ((f64::from(start) + until * width) as f32).next_up().min(end);
        start = next;
        if start >= end {
            return Answer::Undecided;
        }
    }
    Answer::Undecided
}
