//! The thread that holds a picture against the reference.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use harness::score::{Finding, Judgement};
use metaball::{Hit, Model, View};
use metaball_core::reference::Oracle;

use crate::events::Post;

/// Pixels that are judged between two reports.
const BAND_PIXELS: u32 = 1 << 13;

/// What the reference says of a picture's rays, so far.
#[derive(Debug, Clone, Default)]
pub struct Verdicts {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Of the rays of the uppermost rows, row by row from the left.
    pub judgements: Vec<Judgement>,
    /// Rays that hit and were called a miss.
    pub missed: usize,
    /// Rays that miss and were called a hit.
    pub invented: usize,
    /// Rays that hit, and were given another sheet of the surface.
    pub wrong_front: usize,
    /// Rays that the reference calls too close to tell; they are in none of the others.
    pub ambiguous: usize,
    /// Rays that were left undecided.
    pub undecided: usize,
    /// The largest error of a hit that is not wrong, in support radii of the smallest ball there.
    pub largest_error: f64,
}

/// Some more judgements of the picture of that number.
#[derive(Debug)]
pub(crate) struct Judged {
    pub(crate) picture: u64,
    pub(crate) judgements: Vec<Judgement>,
}

/// A picture that is being judged, or has been.
#[derive(Debug)]
pub(crate) struct Judging {
    pub(crate) picture: u64,
    pub(crate) verdicts: Verdicts,
    stopped: Arc<AtomicBool>,
}

impl Verdicts {
    /// The share of the rays that is judged, 0 to 1.
    pub fn progress(&self) -> f32 {
        let (width, height) = self.size;
        self.judgements.len() as f32 / (f64::from(width) * f64::from(height)).max(1.0) as f32
    }

    /// Missed, invented and of a wrong front.
    pub fn wrong(&self) -> usize {
        self.missed + self.invented + self.wrong_front
    }

    pub(crate) fn add(&mut self, judgements: Vec<Judgement>) {
        for judgement in &judgements {
            match judgement.finding {
                _ if judgement.ambiguous => self.ambiguous += 1,
                Finding::FalseNegative => self.missed += 1,
                Finding::FalsePositive => self.invented += 1,
                Finding::Undecided => self.undecided += 1,
                Finding::Hit { .. } if judgement.is_wrong() => self.wrong_front += 1,
                Finding::Hit { error } => self.largest_error = self.largest_error.max(error),
                Finding::Miss => {}
            }
        }
        self.judgements.extend(judgements);
    }
}

impl Judging {
    /// Begins with the picture of that number, which is of a whole solid.
    pub(crate) fn new(
        picture: u64,
        (model, view, hits): (Arc<Model>, View, Vec<Hit>),
        post: Post<Judged>,
    ) -> Self {
        let stopped = Arc::new(AtomicBool::new(false));
        let size = (view.width(), view.height());
        let verdicts = Verdicts { size, ..Verdicts::default() };
        let stops = stopped.clone();
        thread::spawn(move || {
            let oracle = Oracle::new(model.scene());
            let rows = (BAND_PIXELS / view.width()).max(1);
            for row in (0..view.height()).step_by(rows as usize) {
                if stops.load(Ordering::Relaxed) {
                    return;
                }
                let rays = view.rays_of_rows(row..row + rows);
                let hits = &hits[(row * view.width()) as usize..];
                let truths = oracle.first_hits(&rays);
                let judgements =
                    truths.iter().zip(hits).map(|(truth, hit)| Judgement::new(truth, hit));
                post.send(Judged { picture, judgements: judgements.collect() });
            }
        });
        Self { picture, verdicts, stopped }
    }
}

impl Drop for Judging {
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}
