//! `chart.json`: what was measured.

use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::plan::{Planned, Purpose};
use harness::machine::Provenance;
use harness::output::write_json;
use harness::record::{Adapter, Record};

/// Name and version of the format of `chart.json`.
pub const SCHEMA: &str = "metaball-chart/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Chart {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew.
    pub adapter: Adapter,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Whether everything planned was measured.
    pub complete: bool,
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// One for each scene and purpose, in the order measured.
    pub groups: Vec<Group>,
    /// How this run compares with the one before it in the same folder, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moved: Option<Moved>,
}

/// One scene, measured for one purpose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// What for.
    pub purpose: Purpose,
    /// What was loaded.
    pub spec: String,
    /// Number of balls.
    pub balls: usize,
    /// Mean number of other balls' supports that hold a ball's centre.
    pub density: f64,
    /// Mean number of supports that a ray meets.
    pub supports_per_ray: f64,
    /// What a reader should know.
    pub remarks: Vec<String>,
    /// One for each configuration.
    pub records: Vec<Record>,
}

/// How the times of two runs compare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moved {
    /// Points that both runs have.
    pub points: usize,
    /// Those whose median moved by more than the spread of either run, the distance between its
    /// quartiles.
    pub moved: Vec<Move>,
}

/// A point that moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Move {
    /// The scene.
    pub scene: String,
    /// The method, with its options.
    #[serde(rename = "setting")]
    pub configuration: String,
    /// Median of the earlier run, milliseconds.
    pub before_ms: f64,
    /// Median of the later run, milliseconds.
    pub after_ms: f64,
}

impl Chart {
    /// Reads the file of an earlier run, where there is one.
    ///
    /// # Errors
    /// When it is there and cannot be read.
    pub fn read(path: &Path) -> anyhow::Result<Option<Self>> {
        if !path.exists() {
            return Ok(None);
        }
        let text =
            fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        // A file of another kind or version is no earlier run; it is written over.
        Ok(serde_json::from_str(&text).ok())
    }

    /// Whether two runs measured the same, up to the program.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.provenance.is_like(&other.provenance)
            && self.adapter == other.adapter
            && (self.width, self.height) == (other.width, other.height)
    }

    /// The records of the charts of error, scene by scene.
    pub(super) fn error_records(&self) -> Vec<&[Record]> {
        let errors = self.groups.iter().filter(|group| group.purpose == Purpose::Error);
        errors.map(|group| group.records.as_slice()).collect()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        write_json(path, self)
    }
}

impl Group {
    /// Whether it is the result of what was planned.
    pub(super) fn is_of(&self, planned: &Planned) -> bool {
        (&self.purpose, &self.spec) == (&planned.purpose, &planned.spec)
    }
}

/// One sentence.
impl fmt::Display for Moved {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} of {} points moved by more than their spread since the run before.",
            self.moved.len(),
            self.points
        )
    }
}
