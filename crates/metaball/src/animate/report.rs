//! What became of the frames of a run, and how long they took.

use std::time::Duration;

use serde::Serialize;

use particle_files::AnimatedScene;

use super::AnimateOptions;
use crate::backend::Opened;

/// A run of [`animate`](super::animate()); the file beside the frames.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct AnimationReport {
    /// What moves.
    pub scene: String,
    /// What was read of the first frame's file, guessed and left out.
    pub notes: Vec<String>,
    /// Name of the method.
    pub method: String,
    /// What computed, in words.
    #[serde(rename = "device")]
    pub computed_by: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Whether each frame was built only after the one before was drawn.
    pub in_turn: bool,
    /// How many frames were drawn.
    pub drawn: usize,
    /// Frames that were there already.
    #[serde(rename = "there")]
    pub kept: Vec<u32>,
    /// Numbers that were asked for and that the scene has no frame for, or, where none were asked for, those
    /// that miss between its first and its last: the first and the last of each row of them.
    pub absent: Vec<[u32; 2]>,
    /// Rays that the adapter could not tell in f32, and that the CPU was asked instead, of all frames drawn.
    pub asked_again: u64,
    /// From the start of the first frame to the end of the last file.
    pub wall_ms: f64,
    /// Medians over the drawn frames; `None` where there is none.
    pub median: Option<FrameTimes>,
    /// The share of loading and building, over all frames but the first, for which nothing waited.
    pub hidden: Option<f64>,
    /// What keeps `hidden` from being time saved, if anything does.
    pub caveat: Option<String>,
    /// The frames that were not there already.
    pub frames: Vec<FrameReport>,
}

/// A frame and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameReport {
    /// Its number.
    pub number: u32,
    /// What became of it.
    #[serde(flatten)]
    pub outcome: FrameOutcome,
}

/// What became of a frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum FrameOutcome {
    /// Its picture is written, or about to be.
    Drawn {
        /// How long it took.
        #[serde(flatten)]
        times: FrameTimes,
        /// Rays that the adapter could not tell in f32, and that the CPU was asked instead.
        asked_again: u64,
    },
    /// Its particles could not be used.
    Broken {
        /// Why, with all causes.
        error: String,
        /// Whether it is worth while to [try again](crate::is_trouble).
        trouble: bool,
    },
}

/// Milliseconds of a frame's stages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameTimes {
    /// To make or read the balls.
    pub load_ms: f64,
    /// To build for them: the structure, its upload, and in a renderer's first frame its pipelines.
    pub build_ms: f64,
    /// The drawing thread stood still for want of the two above.
    pub waited_ms: f64,
    /// From the start of encoding to the adapter's fence.
    pub draw_ms: f64,
    /// To shade the picture, with all effects of light, and to read it back.
    pub shade_ms: f64,
}

pub(super) fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

impl AnimationReport {
    pub(super) fn new(
        (scene, opened): (&dyn AnimatedScene, &Opened),
        options: &AnimateOptions,
        (kept, absent): (Vec<u32>, Vec<[u32; 2]>),
        frames: Vec<FrameReport>,
        wall: Duration,
    ) -> Self {
        let (times, asked_again): (Vec<_>, Vec<_>) =
            frames.iter().filter_map(FrameReport::drawn).unzip();
        let shared = opened.gpu.as_ref().is_some_and(|gpu| gpu.report().is_software());
        let caveat = (shared && !options.in_turn).then(|| {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            format!(
                "the adapter computes on the same {cores} processor threads that build: what is \
                 hidden slows the drawing down"
            )
        });
        Self {
            scene: scene.name().to_owned(),
            notes: scene.notes().into_iter().flatten().map(ToString::to_string).collect(),
            method: options.draw.method.name().to_owned(),
            computed_by: opened.describe(),
            size: options.draw.size,
            in_turn: options.in_turn,
            drawn: times.len(),
            kept,
            absent,
            asked_again: asked_again.into_iter().sum(),
            wall_ms: milliseconds(wall),
            median: medians(&times),
            hidden: hidden(&times),
            caveat,
            frames,
        }
    }

    /// Frames whose particles could not be used: number and reason.
    pub fn broken(&self) -> impl Iterator<Item = (u32, &str)> {
        self.frames.iter().filter_map(|frame| match &frame.outcome {
            FrameOutcome::Drawn { .. } => None,
            FrameOutcome::Broken { error, .. } => Some((frame.number, error.as_str())),
        })
    }

    /// Whether a frame is missing by [trouble of the machine](crate::is_trouble).
    pub fn is_trouble(&self) -> bool {
        let is_trouble = |frame: &FrameReport| {
            matches!(frame.outcome, FrameOutcome::Broken { trouble: true, .. })
        };
        self.frames.iter().any(is_trouble)
    }
}

impl FrameReport {
    /// Its times, and the rays that were asked again.
    fn drawn(&self) -> Option<(FrameTimes, u64)> {
        match self.outcome {
            FrameOutcome::Drawn { times, asked_again } => Some((times, asked_again)),
            FrameOutcome::Broken { .. } => None,
        }
    }
}

fn medians(times: &[FrameTimes]) -> Option<FrameTimes> {
    let of = |stage: fn(&FrameTimes) -> f64| median(times.iter().map(stage).collect());
    Some(FrameTimes {
        load_ms: of(|times| times.load_ms)?,
        build_ms: of(|times| times.build_ms)?,
        waited_ms: of(|times| times.waited_ms)?,
        draw_ms: of(|times| times.draw_ms)?,
        shade_ms: of(|times| times.shade_ms)?,
    })
}

/// The middle, or the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    let lower = if values.len().is_multiple_of(2) { values[middle - 1] } else { upper };
    Some(0.5 * (lower + upper))
}

/// Nothing can hide the first frame's building.
fn hidden(times: &[FrameTimes]) -> Option<f64> {
    let later = times.get(1..)?;
    let prepared = |times: &FrameTimes| times.load_ms + times.build_ms;
    let total: f64 = later.iter().map(prepared).sum();
    let waited: f64 = later.iter().map(|times| times.waited_ms.min(prepared(times))).sum();
    (total > 0.0).then(|| 1.0 - waited / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_waited_for_was_hidden() {
        let frame = |waited_ms| FrameTimes {
            load_ms: 1.0,
            build_ms: 9.0,
            waited_ms,
            draw_ms: 5.0,
            shade_ms: 1.0,
        };
        assert_eq!(hidden(&[frame(10.0)]), None);
        assert_eq!(hidden(&[]), None);
        assert_eq!(hidden(&[frame(10.0), frame(0.0)]), Some(1.0));
        assert_eq!(hidden(&[frame(10.0), frame(5.0)]), Some(0.5));
        // The thread had to be woken, too: no more than all was waited for.
        assert_eq!(hidden(&[frame(10.0), frame(11.0)]), Some(0.0));
        assert_eq!(medians(&[frame(1.0), frame(3.0), frame(2.0)]), Some(frame(2.0)));
        assert_eq!(medians(&[frame(1.0), frame(3.0)]), Some(frame(2.0)));
        assert_eq!(medians(&[]), None);
    }
}
