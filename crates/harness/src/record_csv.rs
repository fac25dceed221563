//! Records as a table of comma-separated values, for spreadsheets and data frames: a row for each
//! record, empty where there is no value.

use std::path::Path;

use anyhow::Context;
use picture_files::write_atomically;

use crate::record::Record;

/// A heading, and its value of a record.
type Column = (&'static str, fn(&Record) -> String);

/// The columns, each with its value of a record. Raw samples of frame times have spaces between them.
const COLUMNS: &[Column] = &[
    ("scene", |record| record.scene.clone()),
    ("balls", |record| record.balls.to_string()),
    ("kernel", |record| record.kernel.clone()),
    ("threshold", |record| record.threshold.to_string()),
    ("method", |record| record.method.clone()),
    ("options", |record| {
        let options = record.options.iter().map(|(name, value)| format!("{name}={value}"));
        options.collect::<Vec<_>>().join(" ")
    }),
    ("width", |record| record.width.to_string()),
    ("height", |record| record.height.to_string()),
    ("adapter", |record| record.adapter.name.clone()),
    ("driver", |record| record.adapter.driver.clone()),
    ("status", |record| record.status.to_string()),
    ("reason", |record| record.reason.clone().unwrap_or_default()),
    ("build_ms", |record| text(record.measured.as_ref().map(|of| of.build_ms))),
    ("upload_bytes", |record| text(record.measured.as_ref().map(|of| of.upload_bytes))),
    ("device_bytes", |record| text(record.measured.as_ref().map(|of| of.device_bytes))),
    ("frame_ms_median", |record| text(record.measured.as_ref().map(|of| of.frame_ms.median))),
    ("frame_ms_p25", |record| text(record.measured.as_ref().map(|of| of.frame_ms.p25))),
    ("frame_ms_p75", |record| text(record.measured.as_ref().map(|of| of.frame_ms.p75))),
    ("frame_ms_samples", |record| {
        let samples = record.measured.iter().flat_map(|of| &of.frame_ms.samples);
        samples.map(f64::to_string).collect::<Vec<_>>().join(" ")
    }),
    ("fallback_pixels", |record| text(record.measured.as_ref().map(|of| of.fallback_pixels))),
    ("undecided_pixels", |record| text(record.measured.as_ref().map(|of| of.undecided_pixels))),
    ("rays", |record| text(record.accuracy().map(|of| of.rays))),
    ("oracle_hits", |record| text(record.accuracy().map(|of| of.oracle_hits))),
    ("false_negative", |record| text(record.accuracy().map(|of| of.false_negative))),
    ("false_positive", |record| text(record.accuracy().map(|of| of.false_positive))),
    ("wrong_front", |record| text(record.accuracy().map(|of| of.wrong_front))),
    ("ambiguous", |record| text(record.accuracy().map(|of| of.ambiguous))),
    ("rel_rms_t", |record| text(record.accuracy().and_then(|of| of.rel_rms_t))),
    ("t_error_over_radius_p50", |record| {
        text(record.accuracy().and_then(|of| of.t_error_over_radius).map(|of| of.p50))
    }),
    ("t_error_over_radius_p99", |record| {
        text(record.accuracy().and_then(|of| of.t_error_over_radius).map(|of| of.p99))
    }),
    ("t_error_over_radius_max", |record| {
        text(record.accuracy().and_then(|of| of.t_error_over_radius).map(|of| of.max))
    }),
    ("normal_degrees_mean", |record| {
        text(record.accuracy().and_then(|of| of.normal_degrees).map(|of| of.mean))
    }),
    ("normal_degrees_p99", |record| {
        text(record.accuracy().and_then(|of| of.normal_degrees).map(|of| of.p99))
    }),
    ("nodes_per_ray", |record| text(work(record).map(|of| of.nodes_per_ray))),
    ("leaf_tests_per_ray", |record| text(work(record).map(|of| of.leaf_tests_per_ray))),
    ("balls_per_ray", |record| text(work(record).map(|of| of.balls_per_ray))),
    ("evaluations_per_ray", |record| text(work(record).map(|of| of.evaluations_per_ray))),
];

fn work(record: &Record) -> Option<crate::record::WorkPerRay> {
    record.measured.as_ref().and_then(|measured| measured.work)
}

fn text(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Writes the table.
///
/// # Errors
/// When the file cannot be written.
pub fn write_csv<'a>(
    path: &Path,
    records: impl IntoIterator<Item = &'a Record>,
) -> anyhow::Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS.iter().map(|(name, _)| name))?;
    for record in records {
        writer.write_record(COLUMNS.iter().map(|(_, value)| value(record)))?;
    }
    let bytes = writer.into_inner().with_context(|| format!("no CSV for {}", path.display()))?;
    Ok(write_atomically(path, &bytes)?)
}

#[cfg(test)]
mod tests {
    use serde_json::{from_value, json};

    use super::*;

    #[test]
    fn every_record_has_a_row_and_every_number_a_column() {
        let record = json!({
            "scene": "a, b", "balls": 2, "kernel": "power-2", "threshold": 0.25, "method": "fbvh",
            "options": {"tolerance": "1e-3"}, "width": 4, "height": 3,
            "adapter": {"name": "llvmpipe", "backend": "vulkan", "driver": "mesa"}, "status": "ok",
            "build_ms": 1.5, "upload_bytes": 10, "device_bytes": 20,
            "frame_ms": {"median": 2.0, "p25": 1.0, "p75": 3.0, "samples": [3.0, 1.0, 2.0]},
            "passes": {}, "fallback_pixels": 0, "undecided_pixels": 1,
            "accuracy": {
                "rays": 12, "oracle_hits": 5, "false_negative": 1, "false_positive": 0,
                "wrong_front": 0, "ambiguous": 0, "rel_rms_t": 1e-6, "t_error_over_radius": null,
                "normal_degrees": null, "subset": "every pixel"
            }
        });
        let mut failed = record.clone();
        let object = failed.as_object_mut().expect("an object");
        object.remove("accuracy");
        object.insert("status".to_owned(), json!("unsupported"));
        object.insert("reason".to_owned(), json!("needs \"more\""));
        let records: Vec<Record> =
            [record, failed].map(|record| from_value(record).expect("a record")).into();
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("records.csv");
        write_csv(&path, &records).expect("written");

        let mut reader = csv::Reader::from_path(&path).expect("readable");
        let header = reader.headers().expect("a header").clone();
        let column = |name: &str| header.iter().position(|found| found == name).expect("a column");
        let rows: Vec<_> = reader.records().map(|row| row.expect("a row")).collect();
        assert_eq!((rows.len(), rows[0].len()), (2, COLUMNS.len()));
        let cell = |row: usize, name| &rows[row][column(name)];
        assert_eq!((cell(0, "scene"), cell(0, "options")), ("a, b", "tolerance=1e-3"));
        assert_eq!((cell(0, "frame_ms_samples"), cell(0, "rays")), ("3 1 2", "12"));
        assert_eq!((cell(0, "nodes_per_ray"), cell(1, "frame_ms_median")), ("", ""));
        assert_eq!(cell(1, "reason"), "needs \"more\"");
    }
}
