//! Many rays in parallel, on rayon's current pool.

use metaball_core::{Hit, Ray, SurfaceHit};
use rayon::prelude::*;

/// Answers runs of rays in the order of the rays. `answer` fills one slice of answers for one slice of
/// rays, with a scratch that the runs of a task share.
pub(super) fn in_runs<T: Copy + Send + Sync, S>(
    rays: &[Ray],
    blank: T,
    scratch: impl Fn() -> S + Send + Sync,
    answer: impl Fn(&[Ray], &mut S, &mut [T]) + Sync,
) -> Vec<T> {
    /// A multiple of a packet.
    const RUN: usize = 256;
    let mut answers = blanks(rays, blank);
    let tasks = rays.par_chunks(RUN).zip(answers.par_chunks_mut(RUN));
    tasks.for_each_init(scratch, |scratch, (rays, answers)| answer(rays, scratch, answers));
    answers
}

/// Answers the rays of a picture, which lie row by row, `width` to a row, in blocks of 4 × 2 pixels:
/// closer neighbours than eight pixels of a row.
pub(super) fn in_blocks<S>(
    rays: &[Ray],
    width: usize,
    scratch: impl Fn() -> S + Send + Sync,
    answer: impl Fn(&[Ray], &mut S, &mut [SurfaceHit]) + Sync,
) -> Vec<Hit> {
    const BLOCK: (usize, usize) = (4, 2);
    /// Four rows of blocks, since neighbours share a leaf that has been loaded.
    const ROWS: usize = 4 * BLOCK.1;
    let corners = || {
        let tops = || (0..ROWS).step_by(BLOCK.1);
        (0..width).step_by(BLOCK.0).flat_map(move |left| tops().map(move |top| (left, top)))
    };
    let mut hits = blanks(rays, Hit::MISS);
    let tasks = rays.par_chunks(ROWS * width).zip(hits.par_chunks_mut(ROWS * width));
    tasks.for_each_init(scratch, |scratch, (rays, hits)| {
        let (mut pixels, mut block) = (Vec::new(), Vec::new());
        for (left, top) in corners() {
            pixels.clear();
            for row in top..top + BLOCK.1 {
                let columns = left..(left + BLOCK.0).min(width);
                let row = columns.map(|column| row * width + column);
                pixels.extend(row.filter(|&pixel| pixel < rays.len()));
            }
            block.clear();
            block.extend(pixels.iter().map(|&pixel| rays[pixel]));
            let mut answers = [SurfaceHit::MISS; BLOCK.0 * BLOCK.1];
            answer(&block, scratch, &mut answers[..block.len()]);
            for (&pixel, answer) in pixels.iter().zip(answers) {
                hits[pixel] = answer.hit;
            }
        }
    });
    hits
}

/// A blank answer for each ray. In parallel: the first touch of fresh memory is slow.
fn blanks<T: Copy + Send + Sync>(rays: &[Ray], blank: T) -> Vec<T> {
    rays.par_iter().map(|_| blank).collect()
}
