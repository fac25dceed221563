//! What is said of a picture, while it is drawn and after.

use std::ops::{AddAssign, ControlFlow};
use std::time::Duration;

use metaball_core::{Hit, ValueRange, Verdict};

use crate::Error;

/// How far a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// What is done.
    pub stage: Stage,
    /// Parts of this stage that are done: samples of light where an adapter draws, else rows.
    pub done: u32,
    /// All parts.
    pub of: u32,
    /// Those of the done that an interrupted run did.
    pub resumed: u32,
}

/// What is done for a picture, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Its rays are followed.
    Drawing,
    /// Its files are written.
    Writing,
}

/// Whether to go on.
pub(crate) fn asked(flow: ControlFlow<()>) -> Result<(), Error> {
    match flow {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Error::Interrupted),
    }
}

/// What is to be said of a picture.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Summary {
    /// What became of its rays.
    pub tally: Tally,
    /// What black and white stand for in pictures of a number.
    pub range: Option<ValueRange>,
    /// Paths of light a pixel, where there is ray traced light.
    pub samples: Option<u32>,
    /// The method, or what was chosen and why, as names and texts.
    pub account: Vec<(&'static str, String)>,
    /// What computed, in words.
    pub computed_by: String,
    /// Time for the structure.
    pub build: Duration,
}

/// Numbers of a picture's rays, and the time that they took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Tally {
    /// Rays through the middles of pixels that hit the surface from outside.
    pub hits: u64,
    /// Those that hit nothing.
    pub misses: u64,
    /// Those that start inside the solid.
    pub inside: u64,
    /// Those that the method could not tell.
    pub undecided: u64,
    /// Rays of ray traced light that the method could not tell, all samples.
    pub undecided_light: u64,
    /// Rays through the middles of pixels, and lit pixels, that an adapter could not tell in f32, and
    /// that the CPU was asked instead.
    pub asked_again: u64,
    /// Time for the rays through the middles of pixels; on an adapter that of a second frame, since
    /// shaders are compiled with the first.
    pub frame: Duration,
    /// Wall time of all samples of ray traced light.
    pub light: Duration,
}

impl Tally {
    pub(crate) fn of(hits: &[Hit]) -> Self {
        let count = |verdict| hits.iter().filter(|hit| hit.verdict == verdict).count() as u64;
        Self {
            hits: count(Verdict::Hit),
            misses: count(Verdict::Miss),
            inside: count(Verdict::Inside),
            undecided: count(Verdict::Undecided),
            ..Self::default()
        }
    }

    /// Rays through the middles of pixels: as many as pixels.
    pub fn pixels(&self) -> u64 {
        self.hits + self.misses + self.inside + self.undecided
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.hits += other.hits;
        self.misses += other.misses;
        self.inside += other.inside;
        self.undecided += other.undecided;
        self.undecided_light += other.undecided_light;
        self.asked_again += other.asked_again;
        self.frame += other.frame;
        self.light += other.light;
    }
}
