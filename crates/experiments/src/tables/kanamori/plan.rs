//! What is measured, in which order.

use serde::{Deserialize, Serialize};

use super::paper::{SHOWN, SMALL, TABLE_1, TotalTime};
use super::variant::Variant;
use crate::extent::Extent;

/// A part of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Table 1.
    TotalTimes,
    /// What each optimisation of section 5 brings.
    Optimizations,
    /// Time against error, by the threshold of clipping.
    Thresholds,
    /// The scenes of section 6.
    Scenes,
}

impl Part {
    /// All, in the order of the report.
    pub const ALL: [Self; 4] =
        [Self::TotalTimes, Self::Optimizations, Self::Thresholds, Self::Scenes];

    /// Its heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::TotalTimes => "Table 1: total times, GPU against CPU",
            Self::Optimizations => "Section 5: each optimisation against what it replaces",
            Self::Thresholds => "Section 5.4: the threshold of clipping, time against error",
            Self::Scenes => "Section 6: the paper's scenes",
        }
    }
}

/// Variants on one scene at one size, timed in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedScene {
    /// Where it is reported.
    pub part: Part,
    /// What to load.
    pub spec: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// The variants; the first is what the others are compared with.
    pub variants: Vec<Variant>,
    /// The paper's milliseconds: GPU, and CPU where printed.
    pub paper_ms: Option<(f64, Option<f64>)>,
}

/// Everything to measure; what matters most comes first. With `size` everything has that size, and the
/// rows of table 1 that differ in nothing else are one.
pub fn plan(extent: Extent, size: Option<(u32, u32)>) -> Vec<PlannedScene> {
    let is_quick = extent == Extent::Quick;
    let size = |own| size.unwrap_or(if is_quick { (64, 48) } else { own });
    let spec = |spec: &str, quick: &str| (if is_quick { quick } else { spec }).to_owned();
    // What is printed holds for the paper's sizes; a quick run shows the form of the rows only.
    let printed = |own, ms| (is_quick || size(own) == own).then_some(ms);
    let plain = |part, spec, variants| PlannedScene {
        part,
        spec,
        size: size(SMALL),
        variants,
        paper_ms: None,
    };

    let figure_1 = || spec("random-1k", "random:300");
    let mut plan = vec![
        plain(Part::Optimizations, figure_1(), optimizations(is_quick)),
        plain(Part::Thresholds, figure_1(), thresholds(is_quick)),
    ];
    let totals = if is_quick { &TABLE_1[..1] } else { TABLE_1 };
    let is_own = |row: &&TotalTime| size(row.size) == row.size || row.size == SMALL;
    plan.extend(totals.iter().filter(is_own).map(|row| PlannedScene {
        part: Part::TotalTimes,
        spec: spec(&format!("random:{}", row.balls), "random:500"),
        size: size(row.size),
        variants: vec![Variant::Published],
        paper_ms: printed(row.size, (row.gpu_ms, Some(row.cpu_ms))),
    }));
    let shown = if is_quick { &SHOWN[2..3] } else { SHOWN };
    plan.extend(shown.iter().map(|&(spec, fps)| PlannedScene {
        paper_ms: printed(SMALL, (1e3 / fps, None)),
        ..plain(Part::Scenes, spec.to_owned(), vec![Variant::Published, Variant::Robust])
    }));
    if !is_quick {
        plan.push(plain(Part::Optimizations, "dam-break".to_owned(), optimizations(false)));
    }
    plan
}

fn optimizations(is_quick: bool) -> Vec<Variant> {
    use Variant::{
        Iterative, Original, Published, RegisteredOnAdapter, Tessellated, Tiles, Unculled,
    };
    let one_each = [Published, Tessellated, Unculled, Tiles(1), Iterative];
    let others = [Tiles(8), Tiles(16), RegisteredOnAdapter, Original];
    one_each.into_iter().chain(others.into_iter().filter(|_| !is_quick)).collect()
}

/// Both readings of the paper's 10e−4 are among them.
fn thresholds(is_quick: bool) -> Vec<Variant> {
    let all = [1e-3, 1e-1, 1e-2, 1e-4, 1e-5];
    let taken = if is_quick { &all[..2] } else { &all[..] };
    taken.iter().map(|&threshold| Variant::Threshold(threshold)).collect()
}
