//! What a run of `animate` says of its times.

use std::time::Duration;

use serde::Serialize;

use super::pipeline::{Frame, Job, Times};
use crate::console;
use crate::numbers::decimal;
use crate::stats::median;

/// The file beside the frames.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    scene: String,
    method: &'static str,
    device: String,
    size: (u32, u32),
    /// Whether each frame was built only after the one before was drawn.
    in_turn: bool,
    /// Frames that were there already.
    there: Vec<u32>,
    /// From the start of the first frame to the end of the last file.
    wall_ms: f64,
    /// Medians over the drawn frames; `None` where there is none.
    median: Option<Times>,
    /// The share of loading and building, over all frames but the first, for which nothing waited.
    hidden: Option<f64>,
    /// What keeps `hidden` from being time saved, if anything does.
    caveat: Option<String>,
    pub(super) frames: Vec<Frame>,
}

impl Report {
    pub(super) fn new(
        job: &Job<'_>,
        in_turn: bool,
        there: Vec<u32>,
        frames: Vec<Frame>,
        wall: Duration,
    ) -> Self {
        let times: Vec<Times> =
            frames.iter().filter_map(|frame| frame.outcome.times().copied()).collect();
        let shared = job.gpu.is_some_and(|gpu| gpu.report().is_software());
        let caveat = (shared && !in_turn).then(|| {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            format!(
                "the adapter computes on the same {cores} processor threads that build: what is \
                 hidden slows the drawing down"
            )
        });
        Self {
            scene: job.moving.name.clone(),
            method: job.drawing.method.name,
            device: job.drawing.device_name(job.gpu),
            size: job.drawing.size,
            in_turn,
            there,
            wall_ms: 1e3 * wall.as_secs_f64(),
            median: medians(&times),
            hidden: hidden(&times),
            caveat,
            frames,
        }
    }

    /// Tells the person at the terminal.
    pub(super) fn print(&self) {
        let ms = |value: f64| format!("{} ms", decimal(value));
        let mut facts = vec![
            ("scene", self.scene.clone()),
            ("method", self.method.to_owned()),
            ("adapter", self.device.clone()),
            ("drawn", format!("{} frames in {}", self.frames.len(), ms(self.wall_ms))),
        ];
        if let Some(median) = &self.median {
            facts.extend([
                ("load", ms(median.load_ms)),
                ("build", ms(median.build_ms)),
                ("draw", ms(median.draw_ms)),
                ("shade", ms(median.shade_ms)),
            ]);
        }
        if let Some(hidden) = self.hidden {
            let text = format!("{:.0} % of loading and building, behind drawing", 100.0 * hidden);
            facts.push(("hidden", text));
        }
        facts.extend(self.caveat.clone().map(|caveat| ("but", caveat)));
        for (name, value) in facts {
            console::line(&format!("{name:<10} {value}"));
        }
    }
}

fn medians(times: &[Times]) -> Option<Times> {
    let of = |stage: fn(&Times) -> f64| median(&times.iter().map(stage).collect::<Vec<_>>());
    Some(Times {
        load_ms: of(|times| times.load_ms)?,
        build_ms: of(|times| times.build_ms)?,
        waited_ms: of(|times| times.waited_ms)?,
        draw_ms: of(|times| times.draw_ms)?,
        shade_ms: of(|times| times.shade_ms)?,
    })
}

/// Nothing can hide the first frame's building.
fn hidden(times: &[Times]) -> Option<f64> {
    let later = times.get(1..)?;
    let prepared = |times: &Times| times.load_ms + times.build_ms;
    let total: f64 = later.iter().map(prepared).sum();
    let waited: f64 = later.iter().map(|times| times.waited_ms.min(prepared(times))).sum();
    (total > 0.0).then(|| 1.0 - waited / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_waited_for_was_hidden() {
        let frame = |waited_ms| Times {
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
    }
}
