//! The thread that holds a picture against the reference.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::thread;

use harness::score::{Finding, Judgement};
use metaball::{Hit, Model, View};
use metaball_core::reference::Oracle;

use crate::Viewer;
use crate::events::Post;
use crate::painter::{Painting, Stage};

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

/// Holds the latest picture against the reference, when that is asked for.
#[derive(Debug, Default)]
pub struct Judge {
    judging: Option<Judging>,
}

/// A picture that is being judged, or has been.
#[derive(Debug)]
struct Judging {
    /// Of the pictures of other rays, the one that it is ([`Viewer::sights`]).
    sight: u64,
    verdicts: Verdicts,
    judged: Receiver<Vec<Judgement>>,
    stopped: Arc<AtomicBool>,
}

impl Judge {
    /// Whether the latest picture can be judged: it is sharp, and of the whole solid, since the
    /// reference knows no cuts.
    pub fn is_able(viewer: &Viewer) -> bool {
        let is_sharp = |it: &Painting| it.stage != Stage::Coarse;
        viewer.look().clip.is_all() && viewer.painting().is_some_and(is_sharp)
    }

    /// Holds its rays against the reference, beside all else.
    pub fn judge(&mut self, viewer: &Viewer) {
        if let Some(painting) = viewer.painting().filter(|_| Self::is_able(viewer)) {
            let (view, hits) = (painting.view.clone(), painting.shown.hits.clone());
            let rays = (painting.model.clone(), view, hits);
            self.judging = Some(Judging::new(viewer, rays));
        }
    }

    /// Ends that, and forgets what has been found.
    pub fn forget(&mut self) {
        self.judging = None;
    }

    /// What has been found of the picture that is shown.
    pub fn verdicts(&self) -> Option<&Verdicts> {
        Some(&self.judging.as_ref()?.verdicts)
    }

    /// Takes what has been found; what was found of other rays does not hold for the latest picture.
    pub(crate) fn hear(&mut self, viewer: &Viewer) {
        self.judging.take_if(|judging| judging.sight != viewer.sights());
        if let Some(Judging { verdicts, judged, .. }) = &mut self.judging {
            judged.try_iter().for_each(|judgements| verdicts.add(judgements));
        }
    }
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

    fn add(&mut self, judgements: Vec<Judgement>) {
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
    /// Begins with the latest picture, which is of a whole solid.
    fn new(viewer: &Viewer, (model, view, hits): (Arc<Model>, View, Vec<Hit>)) -> Self {
        let (post, judged) = Post::new(viewer.wake().clone());
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
                post.send(judgements.collect());
            }
        });
        Self { sight: viewer.sights(), verdicts, judged, stopped }
    }
}

impl Drop for Judging {
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}
