//! The methods take part in every command, as those of the workspace do. One needs an adapter, one none.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Runs the binary, and returns the folder that it wrote.
fn run(name: &str, arguments: &[&str]) -> PathBuf {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&out);
    let mut command = Command::new(env!("CARGO_BIN_EXE_sphere-tracer"));
    let output = command.args(arguments).arg("--out").arg(&out).output().expect("started");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {words}");
    out
}

fn read(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).expect("written");
    serde_json::from_str(&text).expect("JSON")
}

/// Records of a method, wherever in a file they stand.
fn records<'a>(json: &'a Value, method: &str, found: &mut Vec<&'a Value>) {
    match json {
        Value::Array(values) => values.iter().for_each(|value| records(value, method, found)),
        Value::Object(object) if object.get("method").is_some_and(|name| name == method) => {
            found.push(json);
        }
        Value::Object(object) => object.values().for_each(|value| records(value, method, found)),
        _ => {}
    }
}

fn wrong(record: &Value) -> u64 {
    let count = |kind: &str| record["accuracy"][kind].as_u64().expect("a count");
    count("false_negative") + count("false_positive") + count("wrong_front")
}

#[test]
#[ignore = "needs a graphics adapter: cargo test -- --include-ignored"]
fn it_is_compared_and_right() {
    let out = run(
        "compare",
        &[
            "compare",
            "two-merging",
            "colors-100",
            "radius-ratio-1000",
            "--methods",
            "sphere-tracer,fbvh-certified",
            "--size",
            "64x48",
            "--frames",
            "1",
        ],
    );
    let file = read(&out.join("records.json"));
    let mut found = Vec::new();
    records(&file, "sphere-tracer", &mut found);
    assert_eq!(found.len(), 3);
    for record in found {
        assert_eq!(record["status"], "ok", "{record}");
        assert!(record["accuracy"]["oracle_hits"].as_u64() > Some(100));
        assert_eq!(wrong(record), 0, "{record}");
    }
    let page = std::fs::read_to_string(out.join("index.html")).expect("written");
    assert!(page.contains("Sphere tracing"));
}

#[test]
fn its_twin_on_the_cpu_is_compared_and_right_without_an_adapter() {
    let methods = ["--cpu", "--methods", "sphere-tracer,sphere-tracer-cpu,kanamori-cpu"];
    let scenes = ["compare", "two-merging", "colors-100", "--size", "64x48", "--frames", "1"];
    let out = run("compare-cpu", &[&scenes[..], &methods].concat());
    let file = read(&out.join("records.json"));
    let mut found = Vec::new();
    records(&file, "sphere-tracer-cpu", &mut found);
    assert_eq!(found.len(), 2);
    for record in found {
        assert_eq!(
            (&record["status"], &record["adapter"]["processor"]),
            (&"ok".into(), &"cpu".into())
        );
        assert!(record["accuracy"]["oracle_hits"].as_u64() > Some(100));
        assert_eq!(wrong(record), 0, "{record}");
    }
    let mut left_out = Vec::new();
    records(&file, "sphere-tracer", &mut left_out);
    assert_eq!(left_out.len(), 2);
    for record in left_out {
        assert_eq!(record["reason"], "needed a graphics adapter, found none");
    }
}

#[test]
#[ignore = "needs a graphics adapter: cargo test -- --include-ignored"]
fn it_is_tried_where_methods_fail() {
    let methods = ["--quick", "--methods", "sphere-tracer", "--cases", "neck,coincident"];
    let out = run("stability", &[&["stability"], &methods[..]].concat());
    let file = read(&out.join("records.json"));
    let mut found = Vec::new();
    records(&file, "sphere-tracer", &mut found);
    let outcomes: Vec<_> = found.iter().filter_map(|record| record.get("outcome")).collect();
    assert!(outcomes.contains(&&Value::from("right")), "{outcomes:?}");
    assert!(!outcomes.contains(&&Value::from("broken")), "{outcomes:?}");
}

#[test]
#[ignore = "needs a graphics adapter: cargo test -- --include-ignored"]
fn it_is_charted() {
    let out = run(
        "chart",
        &["chart", "two-merging", "--quick", "--methods", "sphere-tracer", "--size", "48x36"],
    );
    let file = read(&out.join("chart.json"));
    let mut found = Vec::new();
    records(&file, "sphere-tracer", &mut found);
    assert!(!found.is_empty());
    let page = std::fs::read_to_string(out.join("chart.html")).expect("written");
    assert!(page.contains("sphere-tracer"));
}
