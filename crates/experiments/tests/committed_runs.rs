//! The records in `runs/` are evidence: today's program reads them, whatever was renamed since.

use std::fs;
use std::path::{Path, PathBuf};

use experiments::certify::record::Certificate;
use experiments::chart::record::Chart;
use experiments::stability::record::Stability;
use experiments::tables::gourmel::light;
use experiments::tables::{auto, gourmel, illes, kanamori, peers, specialisation};
use harness::record::Records;
use serde::de::DeserializeOwned;

/// Reads a file, or says why it is none of that kind.
fn read<F: DeserializeOwned>(path: &Path) -> Result<(), String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    serde_json::from_str::<F>(&text).map(|_| ()).map_err(|error| error.to_string())
}

fn read_as_named(path: &Path) -> Result<(), String> {
    match path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default() {
        "auto" => read::<auto::Measurements>(path),
        "certify" => read::<Certificate>(path),
        "chart" => read::<Chart>(path),
        "compare" => read::<Records>(path),
        "gourmel" => read::<gourmel::Measurements>(path),
        "gourmel-light" => read::<light::Measurements>(path),
        "illes" => read::<illes::Measurements>(path),
        "kanamori" => read::<kanamori::Measurements>(path),
        "peers" => read::<peers::Measurements>(path),
        "specialisation" => read::<specialisation::Measurements>(path),
        "stability" => read::<Stability>(path),
        other => Err(format!("no records are called {other}")),
    }
}

#[test]
fn committed_records_still_read() {
    let runs = Path::new(env!("CARGO_MANIFEST_DIR")).join("runs");
    let entries = |folder: &Path| -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).expect("a folder");
        entries.map(|entry| entry.expect("an entry").path()).collect()
    };
    let folders = entries(&runs).into_iter().filter(|entry| entry.is_dir());
    let files: Vec<_> = folders.flat_map(|run| entries(&run)).collect();
    let records: Vec<_> =
        files.iter().filter(|file| file.extension().is_some_and(|kind| kind == "json")).collect();
    assert!(records.len() >= 15, "{records:?}");
    let failures: Vec<_> = records
        .iter()
        .filter_map(|path| Some(format!("{}: {}", path.display(), read_as_named(path).err()?)))
        .collect();
    assert!(failures.is_empty(), "{failures:#?}");
}
