//! `records.json`: one record for each scene and method, with raw samples and where they come
//! from.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use metaball_core::Work;
use metaball_core::gpu::{AdapterReport, Gpu, ShaderChecks};
use serde::{Deserialize, Serialize};

use crate::machine::{Machine, Provenance};
use crate::output::write_json;
use crate::score::Accuracy;
use crate::stats::{quantile, sorted};

/// Name and version of the format that [`Records`] describes. It changes with the meaning or the
/// name of any key.
pub const SCHEMA: &str = "metaball-records/1";

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Records {
    /// Where it comes from; its format is [`SCHEMA`].
    #[serde(flatten)]
    pub provenance: Provenance,
    /// In the order of scenes, then methods.
    pub records: Vec<Record>,
}

impl Records {
    /// Writes the file.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        write_json(path, self)
    }
}

/// One method on one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the scene.
    pub scene: String,
    /// Number of balls.
    pub balls: usize,
    /// Kernel: `power-2`, `wyvill`, `perlin`.
    pub kernel: String,
    /// T.
    pub threshold: f32,
    /// Name of the method.
    pub method: String,
    /// What of the method was set otherwise than by default.
    pub options: BTreeMap<String, String>,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// What drew.
    pub adapter: Adapter,
    /// Whether there is a result.
    pub status: Status,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The result; its keys are beside those above, and missing when there is none.
    #[serde(flatten)]
    pub measured: Option<Measured>,
    /// The comparison of another program's hits, which were not drawn here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scored: Option<Scored>,
}

/// Another program's hits, compared with the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scored {
    /// The file that they are from.
    pub file: String,
    /// Comparison with the reference.
    pub accuracy: Accuracy,
}

impl Record {
    /// The comparison with the reference, of methods and other programs alike; `None` where there is no result.
    pub fn accuracy(&self) -> Option<&Accuracy> {
        let measured = self.measured.as_ref().map(|measured| &measured.accuracy);
        measured.or_else(|| self.scored.as_ref().map(|scored| &scored.accuracy))
    }
}

/// Whether a method has a result on a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Drawn whole, compared and timed.
    Ok,
    /// Another program's hits, compared.
    Scored,
    /// A frame stayed incomplete however large the method made its buffers.
    Incomplete,
    /// The method or the adapter cannot do this scene.
    Unsupported,
    /// Not tried: it was too slow on an easier scene.
    Skipped,
}

impl fmt::Display for Status {
    /// As in the file.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Ok => "ok",
            Self::Scored => "scored",
            Self::Incomplete => "incomplete",
            Self::Unsupported => "unsupported",
            Self::Skipped => "skipped",
        })
    }
}

/// What drew: a graphics adapter, or the CPU.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Adapter {
    /// As the driver names it; the model of the CPU.
    pub name: String,
    /// `vulkan`, `metal`, `dx12`; `cpu` without any of them.
    pub backend: String,
    /// Driver and version; of the CPU how many threads.
    pub driver: String,
    /// What it computes on; missing where nothing was drawn, and in files of programs that did not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub processor: Option<Processor>,
    /// Whether its shaders check neither indices nor loops; missing where they do.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unchecked_shaders: bool,
}

/// What computes a picture in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Processor {
    /// A graphics processor.
    Gpu,
    /// The CPU, behind the interface of a graphics adapter.
    Software,
    /// The CPU, without any graphics interface.
    Cpu,
}

impl Adapter {
    /// The CPU with the threads of rayon's current pool.
    pub fn cpu() -> Self {
        Self {
            name: Machine::here().cpu,
            backend: "cpu".to_owned(),
            driver: format!("{} threads", rayon::current_num_threads()),
            processor: Some(Processor::Cpu),
            unchecked_shaders: false,
        }
    }

    /// Where nothing was drawn.
    pub fn none() -> Self {
        let none = || "none".to_owned();
        let (name, backend, driver) = (none(), none(), none());
        Self { name, backend, driver, processor: None, unchecked_shaders: false }
    }

    /// The adapter, or where there is none the CPU.
    pub fn of(gpu: Option<&Gpu>) -> Self {
        gpu.map_or_else(Self::cpu, |gpu| Self::from(gpu.report()))
    }

    /// Whether it is the same one, of two files of which one may not say what it computes on.
    pub fn is_same(&self, other: &Self) -> bool {
        let processor = self.processor;
        *self == Self { processor, ..other.clone() }
    }

    /// What computes, in a word or two; a dash where that is not known.
    pub fn short(&self) -> String {
        match self.processor {
            Some(Processor::Gpu) => "GPU".to_owned(),
            Some(Processor::Software) => format!("CPU, software {}", self.backend),
            Some(Processor::Cpu) => "CPU".to_owned(),
            None => "–".to_owned(),
        }
    }
}

impl From<&AdapterReport> for Adapter {
    fn from(report: &AdapterReport) -> Self {
        let processor = if report.is_software() { Processor::Software } else { Processor::Gpu };
        Self {
            name: report.name.clone(),
            backend: report.backend.clone(),
            driver: report.driver.clone(),
            processor: Some(processor),
            unchecked_shaders: report.shader_checks == ShaderChecks::Off,
        }
    }
}

impl fmt::Display for Adapter {
    /// With all that is known of it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, backend, driver, processor, unchecked_shaders } = self;
        let checks = if *unchecked_shaders { ", shaders unchecked" } else { "" };
        match processor {
            Some(Processor::Cpu) => write!(formatter, "{name}, {driver}, no graphics interface"),
            Some(Processor::Software) => {
                write!(
                    formatter,
                    "{name} ({backend}, {driver}{checks}), software: computes on the CPU"
                )
            }
            Some(Processor::Gpu) | None => {
                write!(formatter, "{name} ({backend}, {driver}{checks})")
            }
        }
    }
}

/// What was measured of complete frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Host time for the structure of the scene, milliseconds; pipelines, which many scenes share, are
    /// left out.
    pub build_ms: f64,
    /// Bytes sent to the adapter by the build.
    pub upload_bytes: u64,
    /// Bytes that the method holds for the scene and for its frames, on the adapter or, on the CPU, in main
    /// memory; neither the shared targets nor the scene in main memory are among them.
    pub device_bytes: u64,
    /// From the start of encoding to the fence; on the CPU for tracing the rays.
    pub frame_ms: Samples,
    /// Median milliseconds of each labelled pass, summed over its repeats in a frame; `cpu:` labels
    /// are host phases.
    pub passes: BTreeMap<String, f64>,
    /// Pixels that a published rule for trouble made.
    pub fallback_pixels: u64,
    /// Pixels that the method left undecided.
    pub undecided_pixels: u64,
    /// Comparison with the reference.
    pub accuracy: Accuracy,
    /// Work a ray, from a frame of its own that is not timed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub work: Option<WorkPerRay>,
}

/// Repeated measurements of one quantity, milliseconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// The middle.
    pub median: f64,
    /// A quarter lies below.
    pub p25: f64,
    /// Three quarters lie below.
    pub p75: f64,
    /// All, in the order taken.
    pub samples: Vec<f64>,
}

impl Samples {
    /// Summarises; zeros of no samples.
    pub fn new(samples: Vec<f64>) -> Self {
        let rising = sorted(samples.clone());
        let at = |share| quantile(&rising, share).unwrap_or(0.0);
        Self { median: at(0.5), p25: at(0.25), p75: at(0.75), samples }
    }
}

/// Work counters averaged over all rays of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WorkPerRay {
    /// Nodes of a hierarchy visited.
    pub nodes_per_ray: f64,
    /// Leaves tested for a hit.
    pub leaf_tests_per_ray: f64,
    /// Balls considered.
    pub balls_per_ray: f64,
    /// Evaluations of the field.
    pub evaluations_per_ray: f64,
}

impl WorkPerRay {
    /// The mean of the pixels' counters; zero of no pixels.
    pub fn mean(pixels: &[Work]) -> Self {
        let mean = |counter: fn(&Work) -> u32| {
            let sum: u64 = pixels.iter().map(|work| u64::from(counter(work))).sum();
            sum as f64 / pixels.len().max(1) as f64
        };
        Self {
            nodes_per_ray: mean(|work| work.nodes),
            leaf_tests_per_ray: mean(|work| work.leaf_tests),
            balls_per_ray: mean(|work| work.balls),
            evaluations_per_ray: mean(|work| work.evaluations),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::score::{NormalDegrees, RadiusError};

    fn measured() -> Measured {
        Measured {
            build_ms: 1.5,
            upload_bytes: 10,
            device_bytes: 20,
            frame_ms: Samples::new(vec![3.0, 1.0, 2.0]),
            passes: BTreeMap::from([("trace".to_owned(), 0.5)]),
            fallback_pixels: 0,
            undecided_pixels: 0,
            accuracy: Accuracy {
                rays: 4,
                oracle_hits: 2,
                false_negative: 0,
                false_positive: 0,
                wrong_front: 0,
                ambiguous: 1,
                rel_rms_t: Some(1e-6),
                t_error_over_radius: Some(RadiusError { p50: 1e-7, p99: 1e-6, max: 1e-5 }),
                normal_degrees: Some(NormalDegrees { mean: 0.01, p99: 0.1, max: 0.2 }),
                subset: "every pixel".to_owned(),
            },
            work: Some(WorkPerRay::mean(&[])),
        }
    }

    fn record(status: Status, reason: Option<&str>, measured: Option<Measured>) -> Record {
        Record {
            scene: "molecule".to_owned(),
            balls: 5_547,
            kernel: "power-2".to_owned(),
            threshold: 0.25,
            method: "bvh".to_owned(),
            options: BTreeMap::new(),
            width: 640,
            height: 480,
            adapter: Adapter {
                name: "llvmpipe".to_owned(),
                backend: "vulkan".to_owned(),
                driver: "mesa".to_owned(),
                processor: Some(Processor::Software),
                unchecked_shaders: false,
            },
            status,
            reason: reason.map(str::to_owned),
            measured,
            scored: None,
        }
    }

    fn keys(value: &Value) -> Vec<&str> {
        let mut keys: Vec<_> =
            value.as_object().expect("an object").keys().map(String::as_str).collect();
        keys.sort_unstable();
        keys
    }

    #[test]
    fn a_record_has_the_documented_keys() {
        let value = serde_json::to_value(record(Status::Ok, None, Some(measured())))
            .expect("records are JSON");
        let mut documented = vec![
            "scene",
            "balls",
            "kernel",
            "threshold",
            "method",
            "options",
            "width",
            "height",
            "adapter",
            "status",
            "build_ms",
            "upload_bytes",
            "device_bytes",
            "frame_ms",
            "passes",
            "fallback_pixels",
            "undecided_pixels",
            "accuracy",
            "work",
        ];
        documented.sort_unstable();
        assert_eq!(keys(&value), documented);
        for status in [Status::Ok, Status::Incomplete, Status::Unsupported, Status::Skipped] {
            assert_eq!(json!(status), json!(status.to_string()));
        }
        assert_eq!(value["status"], json!("ok"));
        assert_eq!(keys(&value["adapter"]), ["backend", "driver", "name", "processor"]);
        assert_eq!(keys(&value["frame_ms"]), ["median", "p25", "p75", "samples"]);
        assert_eq!(value["frame_ms"]["samples"], json!([3.0, 1.0, 2.0]));
        assert_eq!(value["passes"], json!({"trace": 0.5}));
        assert_eq!(
            keys(&value["accuracy"]),
            [
                "ambiguous",
                "false_negative",
                "false_positive",
                "normal_degrees",
                "oracle_hits",
                "rays",
                "rel_rms_t",
                "subset",
                "t_error_over_radius",
                "wrong_front",
            ]
        );
        assert_eq!(keys(&value["accuracy"]["t_error_over_radius"]), ["max", "p50", "p99"]);
        assert_eq!(keys(&value["accuracy"]["normal_degrees"]), ["max", "mean", "p99"]);
        assert_eq!(
            keys(&value["work"]),
            ["balls_per_ray", "evaluations_per_ray", "leaf_tests_per_ray", "nodes_per_ray"]
        );
    }

    #[test]
    fn the_file_reads_back() {
        let records = Records {
            provenance: Provenance::here(SCHEMA),
            records: vec![
                record(Status::Ok, None, Some(measured())),
                record(Status::Unsupported, Some("needs 2 bytes, the limit is 1"), None),
            ],
        };
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("records.json");
        records.write(&path).expect("written");
        let text = std::fs::read_to_string(&path).expect("readable");
        let back: Records = serde_json::from_str(&text).expect("as written");
        assert_eq!(back, records);

        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(keys(&value), ["command", "commit", "machine", "records", "schema"]);
        assert_eq!(value["records"][1]["status"], json!("unsupported"));
        assert_eq!(value["records"][1].get("frame_ms"), None);
    }

    #[test]
    fn what_drew_says_whether_it_is_the_cpu() {
        let json = json!({"name": "llvmpipe", "backend": "vulkan", "driver": "mesa"});
        let old: Adapter = serde_json::from_value(json).expect("of a file that did not say");
        assert_eq!(
            (old.short().as_str(), old.to_string()),
            ("–", "llvmpipe (vulkan, mesa)".into())
        );
        let software = Adapter { processor: Some(Processor::Software), ..old };
        assert_eq!(software.short(), "CPU, software vulkan");
        assert!(software.to_string().ends_with("computes on the CPU"));
        let unchecked = Adapter { unchecked_shaders: true, ..software };
        assert!(unchecked.to_string().contains("mesa, shaders unchecked)"));
        assert_eq!(json!(unchecked)["unchecked_shaders"], json!(true));
        let cpu = Adapter::of(None);
        assert_eq!((cpu.short().as_str(), cpu.processor), ("CPU", Some(Processor::Cpu)));
        assert!(cpu.to_string().contains("threads"), "{cpu}");
    }

    #[test]
    fn samples_summarise() {
        let samples = Samples::new(vec![4.0, 1.0, 3.0, 2.0, 5.0]);
        assert_eq!((samples.p25, samples.median, samples.p75), (2.0, 3.0, 4.0));
        assert!(Samples::new(Vec::new()).samples.is_empty());
    }
}
