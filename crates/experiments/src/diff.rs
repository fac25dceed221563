//! The command `diff`: what changed between two files of records, by more than the spread.

use std::collections::{BTreeMap, VecDeque};
use std::path::Path;

use anyhow::{Context, ensure};
use harness::machine::Machine;
use harness::numbers::{decimal, grouped};
use harness::record::{Measured, Record};
use serde_json::Value;

use crate::console::{self, table};

/// A file of records, of `compare` or `chart`.
struct File {
    commit: String,
    machine: Option<Machine>,
    records: Vec<Record>,
}

/// What makes two records ones of the same thing.
type Key = (String, String, String, u32, u32, String, String, usize);

/// Prints what became faster, slower, right, wrong, larger or smaller from one file to the other, and
/// what is in one alone.
///
/// # Errors
/// When a file cannot be read or holds no records.
pub fn diff(before: &Path, after: &Path) -> anyhow::Result<()> {
    let (before, after) = (read(before)?, read(after)?);
    console::line(&format!("from commit {} to {}", before.commit, after.commit));
    for remark in remarks(&before, &after) {
        console::note(&remark);
    }
    let Changes { rows, unchanged, in_both, alone } = changes(&before.records, &after.records);
    if !rows.is_empty() {
        let headings = ["scene", "method", "size", "change", "before", "after", "ratio"];
        console::line(&table(&headings, &rows));
    }
    let [unchanged, in_both] = [unchanged, in_both].map(grouped);
    console::line(&format!("{unchanged} of {in_both} records in both without a change"));
    for line in alone {
        console::line(&line);
    }
    Ok(())
}

fn read(path: &Path) -> anyhow::Result<File> {
    let name = path.display();
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
    let json: Value =
        serde_json::from_str(&text).with_context(|| format!("{name}: needed JSON"))?;
    let mut records = Vec::new();
    collect(&json, &mut records)
        .with_context(|| format!("{name}: needed records of compare or chart"))?;
    ensure!(
        !records.is_empty(),
        "{name}: needed records of compare or chart, such as out/compare/records.json, found none"
    );
    let commit = json.get("commit").and_then(Value::as_str).unwrap_or("unknown").to_owned();
    let machine = json.get("machine").cloned().map(serde_json::from_value).transpose()?;
    Ok(File { commit, machine, records })
}

/// Records are in a list in compare's files, and in groups in chart's.
fn collect(json: &Value, records: &mut Vec<Record>) -> serde_json::Result<()> {
    match json {
        Value::Array(values) => values.iter().try_for_each(|value| collect(value, records)),
        Value::Object(object) if object.contains_key("method") && object.contains_key("status") => {
            records.push(serde_json::from_value(json.clone())?);
            Ok(())
        }
        Value::Object(object) => object.values().try_for_each(|value| collect(value, records)),
        _ => Ok(()),
    }
}

fn key(record: &Record) -> Key {
    let options = record.options.iter().map(|(name, value)| format!("{name} {value}"));
    (
        record.scene.clone(),
        record.method.clone(),
        options.collect::<Vec<_>>().join(", "),
        record.width,
        record.height,
        record.kernel.clone(),
        record.threshold.to_string(),
        record.balls,
    )
}

/// What keeps times from being compared.
fn remarks(before: &File, after: &File) -> Vec<String> {
    let mut remarks = Vec::new();
    if before.machine != after.machine {
        remarks.push("The machines differ: times cannot be compared.".to_owned());
    }
    let adapter = |file: &File, method: &str| {
        let is_of = |record: &&Record| record.method == method && record.measured.is_some();
        file.records.iter().find(is_of).map(|record| record.adapter.clone())
    };
    let differs = |record: &Record| {
        let both = adapter(before, &record.method).zip(adapter(after, &record.method));
        both.is_some_and(|(then, now)| !then.is_same(&now))
    };
    if after.records.iter().any(differs) {
        remarks.push("The adapters or their drivers differ: times cannot be compared.".to_owned());
    }
    remarks
}

#[derive(Debug, PartialEq)]
struct Changes {
    /// For the table.
    rows: Vec<Vec<String>>,
    /// Records in both files about which nothing changed.
    unchanged: usize,
    /// Records in both files.
    in_both: usize,
    /// Records in one file.
    alone: Vec<String>,
}

fn changes(before: &[Record], after: &[Record]) -> Changes {
    // Of several records of the same thing, as in a chart, the first belongs to the first.
    let mut earlier: BTreeMap<Key, VecDeque<&Record>> = BTreeMap::new();
    for record in before {
        earlier.entry(key(record)).or_default().push_back(record);
    }
    let mut changes = Changes { rows: Vec::new(), unchanged: 0, in_both: 0, alone: Vec::new() };
    for record in after {
        match earlier.get_mut(&key(record)).and_then(VecDeque::pop_front) {
            None => changes.alone.push(format!("{}: only after", name(record))),
            Some(old) => {
                let found = changes_of(old, record);
                changes.unchanged += usize::from(found.is_empty());
                changes.in_both += 1;
                let size = format!("{} × {}", record.width, record.height);
                changes.rows.extend(found.into_iter().map(|change| {
                    let first = [record.scene.clone(), method(record), size.clone()];
                    first.into_iter().chain(change).collect()
                }));
            }
        }
    }
    let gone = earlier.into_values().flatten();
    changes.alone.extend(gone.map(|record| format!("{}: only before", name(record))));
    changes
}

fn method(record: &Record) -> String {
    let options = record.options.iter().map(|(name, value)| format!(", {name} {value}"));
    record.method.clone() + &options.collect::<String>()
}

fn name(record: &Record) -> String {
    format!("{}, {}", record.scene, method(record))
}

/// Change, before, after, ratio.
fn changes_of(before: &Record, after: &Record) -> Vec<[String; 4]> {
    let mut changes = Vec::new();
    if before.status != after.status {
        changes.push(change("status", &before.status, &after.status, None));
    }
    if let (Some(old), Some(new)) = (before.accuracy(), after.accuracy()) {
        let (was, is) = (old.wrong_verdicts(), new.wrong_verdicts());
        if was != is {
            let what = if is > was { "more wrong rays" } else { "fewer wrong rays" };
            changes.push(change(what, &was, &is, None));
        }
    }
    if let (Some(old), Some(new)) = (&before.measured, &after.measured) {
        changes.extend(measured_changes(old, new));
    }
    changes
}

fn measured_changes(old: &Measured, new: &Measured) -> Vec<[String; 4]> {
    let mut changes = Vec::new();
    let ratio = |was: f64, is: f64| (was > 0.0).then(|| is / was);
    // The quartiles of one lie beyond those of the other.
    let (was, is) = (&old.frame_ms, &new.frame_ms);
    let what = if is.p75 < was.p25 {
        Some("faster")
    } else if is.p25 > was.p75 {
        Some("slower")
    } else {
        None
    };
    if let Some(what) = what {
        let [before, after] = [was, is].map(|of| format!("{} ms", decimal(of.median)));
        changes.push(change(what, &before, &after, ratio(was.median, is.median)));
    }
    if old.undecided_pixels != new.undecided_pixels {
        let (was, is) = (old.undecided_pixels, new.undecided_pixels);
        changes.push(change("undecided pixels", &was, &is, None));
    }
    if old.device_bytes != new.device_bytes {
        let what = if new.device_bytes > old.device_bytes { "larger" } else { "smaller" };
        let [before, after] =
            [old, new].map(|of| format!("{} B", grouped(of.device_bytes as usize)));
        let ratio = ratio(old.device_bytes as f64, new.device_bytes as f64);
        changes.push(change(what, &before, &after, ratio));
    }
    changes
}

fn change(
    what: &str,
    before: &impl ToString,
    after: &impl ToString,
    ratio: Option<f64>,
) -> [String; 4] {
    let ratio = ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
    [what.to_owned(), before.to_string(), after.to_string(), ratio]
}

#[cfg(test)]
mod tests {
    use harness::record::{Adapter, Processor, Status};

    use super::*;
    use crate::testing::measured_as;

    #[test]
    fn only_what_is_beyond_the_spread_has_changed() {
        let before = [measured_as("one", "fbvh", 10.0, 3), measured_as("one", "bvh", 20.0, 0)];
        assert_eq!(
            changes(&before, &before),
            Changes { rows: vec![], unchanged: 2, in_both: 2, alone: vec![] }
        );
        let within = [measured_as("one", "fbvh", 10.04, 3), before[1].clone()];
        assert_eq!(changes(&before, &within).unchanged, 2);
        let faster = [measured_as("one", "fbvh", 5.0, 0), measured_as("two", "bvh", 20.0, 0)];
        let found = changes(&before, &faster);
        let texts: Vec<_> = found.rows.iter().map(|row| row[3..].join(" ")).collect();
        assert_eq!(texts, ["fewer wrong rays 3 0 –", "faster 10.0 ms 5.00 ms 0.50"]);
        assert_eq!(found.alone, ["two, bvh: only after", "one, bvh: only before"]);
        let slower = changes(&faster[..1], &before[..1]);
        assert!(slower.rows.iter().any(|row| row[3] == "slower" && row[6] == "2.00"));
        let mut refused = before[1].clone();
        (refused.status, refused.measured) = (Status::Unsupported, None);
        let rows = changes(&before[1..], &[refused]).rows;
        assert_eq!(rows[0][3..6].join(" "), "status ok unsupported");
    }

    #[test]
    fn times_by_another_adapter_are_not_compared() {
        let file = |record: &Record| File {
            commit: "abc".to_owned(),
            machine: None,
            records: vec![record.clone()],
        };
        let llvmpipe = measured_as("one", "fbvh", 10.0, 0);
        // A file that says what the adapter computes on, and one that does not yet.
        let mut told = llvmpipe.clone();
        told.adapter.processor = Some(Processor::Software);
        assert!(remarks(&file(&llvmpipe), &file(&told)).is_empty());
        let mut other = told.clone();
        other.adapter.driver = "another".to_owned();
        assert_eq!(remarks(&file(&told), &file(&other)).len(), 1);
        // Without an adapter there are no times to compare.
        let mut left_out = llvmpipe.clone();
        (left_out.adapter, left_out.measured) = (Adapter::none(), None);
        assert!(remarks(&file(&llvmpipe), &file(&left_out)).is_empty());
    }

    #[test]
    fn records_are_found_in_files_of_either_kind() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file.json");
        let record = serde_json::to_value(measured_as("one", "fbvh", 1.0, 0)).expect("JSON");
        let write = |json: &Value| std::fs::write(&path, json.to_string()).expect("written");
        write(&serde_json::json!({"commit": "abc", "records": [record]}));
        let file = read(&path).expect("records");
        assert_eq!((file.commit.as_str(), file.records.len()), ("abc", 1));
        write(&serde_json::json!({"groups": [{"records": [record, record]}, {"records": []}]}));
        assert_eq!(read(&path).expect("records").records.len(), 2);
        write(&serde_json::json!({"tables": []}));
        assert!(read(&path).err().expect("refused").to_string().contains("needed records of"));
    }
}
