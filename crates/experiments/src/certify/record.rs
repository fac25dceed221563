//! `certify.json`: what was counted, and whether it is enough.

use std::ops::Range;
use std::path::Path;

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use super::ray_distribution::RayDistribution;
use super::tally::{Category, Count, ErrorClass, Errors, Query, Tally, Tracer, Wrong};
use crate::unfinished;
use harness::machine::Provenance;
use harness::output::write_json;
use harness::record::Adapter;

/// Name and version of the format of [`Certificate`].
pub const SCHEMA: &str = "metaball-certificate/2";

/// The most clear rays without an answer: one in so many.
pub const UNDECIDED_ONE_IN: u64 = 10_000;

/// The largest relative RMS error of t.
pub const LARGEST_RMS: f64 = 1e-5;

/// One ray in so many must be near tangency or a box's face.
pub const NEAR_ONE_IN: u64 = 10;

/// Scales, and distances in radii, at which the error is held: powers of ten, the last ones not included.
pub const SCALES: Range<i32> = -4..8;
/// See [`SCALES`].
pub const DISTANCES: Range<i32> = 0..4;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What ran the shaders; `null` where only the CPU's tracer was held.
    pub adapter: Option<Adapter>,
    /// Different rays held against the oracle.
    pub rays: u64,
    /// Scenes that are done, of [`test_scenes`](super::test_scene::test_scenes).
    #[serde(alias = "shards")]
    pub test_scenes: usize,
    /// Seconds that it took, interruptions left out.
    pub seconds: f64,
    /// Counts, by tracer, query and distribution of rays.
    pub counts: Vec<CountRow>,
    /// Relative errors of t, by tracer, scale and distance.
    pub errors: Vec<ErrorRow>,
    /// Hits, by tracer and size of the relative error.
    pub histogram: Vec<HistogramBin>,
    /// The first wrong answers in full.
    pub wrong: Vec<Wrong>,
}

/// A count of answers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CountRow {
    /// Of what.
    #[serde(flatten)]
    pub category: Category,
    /// How many.
    #[serde(flatten)]
    pub count: Count,
}

/// Errors of one class.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorRow {
    /// Where.
    #[serde(flatten)]
    pub class: ErrorClass,
    /// How large.
    #[serde(flatten)]
    pub errors: Errors,
}

/// Hits with errors of one size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HistogramBin {
    /// Whose.
    pub tracer: Tracer,
    /// The power of ten at or below |t − t*|/t*; the least one holds all smaller errors.
    pub decade: i32,
    /// How many.
    pub hits: u64,
}

impl Certificate {
    /// Of nothing yet, made by this program and command.
    pub fn fresh(gpu: Option<&Gpu>) -> Self {
        Self {
            provenance: Provenance::here(SCHEMA),
            adapter: gpu.map(|gpu| gpu.report().into()),
            rays: 0,
            test_scenes: 0,
            seconds: 0.0,
            counts: Vec::new(),
            errors: Vec::new(),
            histogram: Vec::new(),
            wrong: Vec::new(),
        }
    }

    /// Takes what was counted into the record.
    pub fn take(&mut self, tally: &Tally) {
        let count = |(&category, &count)| CountRow { category, count };
        self.counts = tally.counts.iter().map(count).collect();
        let error = |(&class, &errors)| ErrorRow { class, errors };
        self.errors = tally.errors.iter().map(error).collect();
        let bin = |(&(tracer, decade), &hits)| HistogramBin { tracer, decade, hits };
        self.histogram = tally.histogram.iter().map(bin).collect();
        self.wrong = tally.wrong.clone();
        self.rays = self.distinct().map(|row| row.count.rays).sum();
    }

    /// What was counted, to continue from.
    pub fn tally(&self) -> Tally {
        Tally {
            counts: self.counts.iter().map(|row| (row.category, row.count)).collect(),
            errors: self.errors.iter().map(|row| (row.class, row.errors)).collect(),
            histogram: self
                .histogram
                .iter()
                .map(|bin| ((bin.tracer, bin.decade), bin.hits))
                .collect(),
            wrong: self.wrong.clone(),
        }
    }

    /// The rows in which every ray is counted once: the CPU finds the first hit of each.
    fn distinct(&self) -> impl Iterator<Item = &CountRow> {
        let is_one = |row: &&CountRow| {
            row.category.tracer == Tracer::Cpu && row.category.query == Query::FirstHit
        };
        self.counts.iter().filter(is_one)
    }

    /// Rays near to tangency or to a face of a box.
    pub fn near(&self) -> u64 {
        self.distinct().map(|row| row.count.near).sum()
    }

    /// A sum over a tracer's rows.
    pub fn sum(&self, tracer: Tracer, of: impl Fn(&Count) -> u64) -> u64 {
        let rows = self.counts.iter().filter(|row| row.category.tracer == tracer);
        rows.map(|row| of(&row.count)).sum()
    }

    /// Rays that a tracer could not decide though they are clear to the oracle, and the rays that they are
    /// held to be few of: all of the CPU's. The shaders have no f64 to continue in, so those along the
    /// surface are counted, but not held.
    fn undecided(&self, tracer: Tracer) -> (u64, u64) {
        let is_held = |row: &&CountRow| {
            let Category { tracer: whose, distribution, .. } = row.category;
            whose == tracer && (tracer == Tracer::Cpu || distribution != RayDistribution::Tangent)
        };
        let held = self.counts.iter().filter(is_held).map(|row| row.count);
        held.fold((0, 0), |sum, count| (sum.0 + count.undecided_clear, sum.1 + count.rays))
    }

    /// The errors of a tracer where they are held: from 1 to 10,000 radii, at scales from 1e-4 to 1e7.
    pub fn held_errors(&self, tracer: Tracer) -> Errors {
        let mut sum = Errors::default();
        let is_held = |row: &&ErrorRow| {
            let ErrorClass { tracer: whose, scale, distance } = row.class;
            whose == tracer && SCALES.contains(&scale) && DISTANCES.contains(&distance)
        };
        self.errors.iter().filter(is_held).for_each(|row| sum.add(&row.errors));
        sum
    }

    /// What keeps this from being a certificate for so many rays, in words; nothing where it is one.
    pub fn shortfalls(&self, wanted: u64) -> Vec<String> {
        let mut shortfalls = Vec::new();
        if self.rays < wanted {
            shortfalls.push(format!("needed {wanted} rays, found {}", self.rays));
        }
        let near = self.near();
        if near * NEAR_ONE_IN < self.rays {
            let needed = self.rays.div_ceil(NEAR_ONE_IN);
            shortfalls.push(format!("near tangency or a face: needed {needed} rays, found {near}"));
        }
        shortfalls.extend(self.wrong_answers());
        for tracer in [Tracer::Cpu, Tracer::Adapter] {
            let (undecided, rays) = self.undecided(tracer);
            let most = rays / UNDECIDED_ONE_IN;
            if undecided > most {
                shortfalls.push(format!(
                    "{tracer}: needed at most {most} clear rays undecided, found {undecided}"
                ));
            }
            let rms = self.held_errors(tracer).rms();
            if rms.is_nan() || rms > LARGEST_RMS {
                shortfalls.push(format!(
                    "{tracer}: needed a relative RMS error of t of at most {LARGEST_RMS:e}, found \
                     {rms:.1e}"
                ));
            }
        }
        shortfalls
    }

    /// Whose answers are wrong, in words; nothing where none are.
    pub fn wrong_answers(&self) -> Vec<String> {
        let of_tracer = |tracer: Tracer| {
            let wrong = self.sum(tracer, |count| count.wrong);
            (wrong > 0).then(|| format!("{tracer}: needed no wrong answer, found {wrong}"))
        };
        [Tracer::Cpu, Tracer::Adapter].into_iter().filter_map(of_tracer).collect()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        write_json(path, self)
    }

    /// Reads what an interrupted run has left, if it is of the same program, command and adapter.
    pub fn unfinished(&self, path: &Path) -> Option<Self> {
        let left: Self = unfinished::read(path)?;
        let is_same = left.provenance == self.provenance && left.adapter == self.adapter;
        is_same.then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIRST_HITS: Category = Category {
        tracer: Tracer::Cpu,
        query: Query::FirstHit,
        distribution: RayDistribution::Tangent,
    };

    fn certificate(count: Count, rms: f64) -> Certificate {
        let class = ErrorClass { tracer: Tracer::Cpu, scale: 0, distance: 2 };
        let errors = Errors { hits: 4, squares: 4.0 * rms * rms, worst: rms };
        let mut tally = Tally::default();
        tally.counts.insert(FIRST_HITS, count);
        tally.errors.insert(class, errors);
        tally.histogram.insert((Tracer::Cpu, -8), 4);
        let mut certificate = Certificate::fresh(None);
        certificate.take(&tally);
        assert_eq!(certificate.tally(), tally);
        certificate
    }

    const GOOD: Count = Count {
        rays: 100_000,
        near: 10_000,
        hits: 50_000,
        misses: 50_000,
        ambiguous: 10,
        undecided: 20,
        undecided_clear: 1,
        wrong: 0,
    };

    #[test]
    fn shortfalls_name_what_was_needed() {
        assert_eq!(certificate(GOOD, 1e-6).shortfalls(100_000), Vec::<String>::new());
        let one = |count, rms, rays| {
            let shortfalls = certificate(count, rms).shortfalls(rays);
            assert_eq!(shortfalls.len(), 1, "{shortfalls:?}");
            shortfalls[0].clone()
        };
        assert!(one(GOOD, 1e-6, 100_001).starts_with("needed 100001 rays"));
        assert!(one(Count { near: 9_999, ..GOOD }, 1e-6, 1).contains("near tangency"));
        assert!(one(Count { wrong: 1, ..GOOD }, 1e-6, 1).contains("no wrong answer, found 1"));
        assert!(one(Count { undecided_clear: 11, ..GOOD }, 1e-6, 1).contains("at most 10 clear"));
        assert!(one(GOOD, 1.1e-5, 1).contains("RMS error of t of at most 1e-5, found 1.1e-5"));
    }

    #[test]
    fn shaders_may_leave_only_tangents_undecided() {
        let shortfalls = |distribution: RayDistribution| {
            let mut certificate = certificate(GOOD, 1e-6);
            let category = Category { tracer: Tracer::Adapter, distribution, ..FIRST_HITS };
            let count = Count { undecided_clear: 11, ..GOOD };
            certificate.counts.push(CountRow { category, count });
            certificate.shortfalls(100_000)
        };
        assert_eq!(shortfalls(RayDistribution::Tangent), Vec::<String>::new());
        assert_eq!(
            shortfalls(RayDistribution::Face),
            ["adapter: needed at most 10 clear rays undecided, found 11"]
        );
    }

    #[test]
    fn only_the_same_command_continues() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("unfinished.json");
        let run = certificate(GOOD, 1e-6);
        assert_eq!(run.unfinished(&path), None);
        run.write(&path).expect("written");
        assert_eq!(run.unfinished(&path), Some(run.clone()));
        let provenance = Provenance { commit: "d".to_owned(), ..run.provenance.clone() };
        let other = Certificate { provenance, ..run };
        assert_eq!(other.unfinished(&path), None);
    }
}
