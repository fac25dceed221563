//! The command `device` as a process: it is rehearsed, and what fails in it is seen to fail.

use std::process::Command;

use experiments::device::record::{DeviceRecord, Outcome};

fn rehearse(arguments: &[&str]) -> (bool, DeviceRecord, String) {
    let out = tempfile::tempdir().expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_metaball"))
        .args(["device", "--rehearse", "--out"])
        .arg(out.path())
        .args(arguments)
        .output()
        .expect("started");
    let read = |name: &str| std::fs::read_to_string(out.path().join(name)).expect("written");
    let (record, summary) = (read("device.json"), read("summary.txt"));
    (output.status.success(), serde_json::from_str(&record).expect("a record"), summary)
}

#[test]
fn every_part_is_rehearsed_and_the_canaries_end_none_but_themselves() {
    let (is_good, record, summary) = rehearse(&[]);
    assert!(is_good, "{summary}");
    let outcomes = |canary: bool| -> Vec<_> {
        let parts = record.parts.iter().filter(|part| part.is_canary == canary);
        parts.map(|part| (part.name.as_str(), part.outcome)).collect()
    };
    assert_eq!(outcomes(true), [("panic", Outcome::Failed), ("hang", Outcome::CutShort)]);
    let is_over = match &record.adapter {
        Some(_) => |outcome: Outcome| outcome == Outcome::Done,
        None => |outcome| matches!(outcome, Outcome::Done | Outcome::NotBegun),
    };
    let others = outcomes(false);
    assert!(others.len() == 8 && others.iter().all(|(_, outcome)| is_over(*outcome)), "{summary}");

    let panic = record.parts.iter().find(|part| part.name == "panic").expect("there");
    assert!(panic.log.contains("the canary of a rehearsal"), "{}", panic.log);
    for part in record.parts.iter().filter(|part| part.outcome == Outcome::Done) {
        assert!(!part.records.is_empty() && !part.output.is_empty(), "{}", part.name);
        assert!(summary.contains(&format!("## {}: ", part.name)), "{summary}");
    }
    if record.adapter.is_some() {
        let adapter = |part: &str| {
            let part = record.parts.iter().find(|found| found.name == part).expect("there");
            let records = part.records["records.json"]["records"].as_array().expect("a list");
            records[0]["adapter"]["unchecked_shaders"].as_bool()
        };
        assert_eq!((adapter("compare"), adapter("unchecked")), (None, Some(true)));
    }
}

/// A machine without an adapter that has this in its name stands for one without any.
#[test]
fn without_an_adapter_the_cpu_measures_what_it_can() {
    let (_, record, summary) = rehearse(&["--adapter", "Voodoo"]);
    assert_eq!(record.adapter, None);
    let with = |outcome: Outcome| -> Vec<_> {
        let parts = record.parts.iter().filter(|part| part.outcome == outcome);
        parts.map(|part| part.name.as_str()).collect()
    };
    assert_eq!(with(Outcome::NotBegun), ["light", "unchecked", "effects"]);
    assert_eq!(with(Outcome::Done), ["agreement", "certify", "compare", "sizes", "density"]);
    assert!(summary.contains("Measured without a graphics adapter"), "{summary}");
}
