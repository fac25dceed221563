//! What tests share.

use harness::record::Record;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{from_value, json};

/// What the JSON of a file reads back as.
pub(crate) fn read_back<F: Serialize + DeserializeOwned>(file: &F) -> F {
    let text = serde_json::to_string(file).expect("JSON");
    serde_json::from_str(&text).expect("as written")
}

/// A page needs no other file and no network, is filled in and whole, and has nothing forbidden in it.
pub(crate) fn assert_stands_alone(page: &str, forbidden: &[&str]) {
    for forbidden in ["<script", "http", "url(", "{{"].iter().chain(forbidden) {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    assert!(page.ends_with("</html>\n"));
}

/// A record of four rays with that frame time and so many of them wrong.
pub(crate) fn measured_as(scene: &str, method: &str, ms: f64, wrong: usize) -> Record {
    let samples = [0.99 * ms, ms, 1.01 * ms];
    let quartile = |share: f64| (1.0 + 0.01 * share) * ms;
    from_value(json!({
        "scene": scene, "balls": 5_547, "kernel": "power-2", "threshold": 0.25,
        "method": method, "options": {}, "width": 640, "height": 480,
        "adapter": {"name": "llvmpipe", "backend": "vulkan", "driver": "mesa"},
        "status": "ok",
        "build_ms": 1.5, "upload_bytes": 10, "device_bytes": 20,
        "frame_ms": {"median": ms, "p25": quartile(-0.5), "p75": quartile(0.5), "samples": samples},
        "passes": {"trace": 0.5}, "fallback_pixels": 0, "undecided_pixels": 0,
        "accuracy": {
            "rays": 4, "oracle_hits": 2, "false_negative": 0, "false_positive": 0,
            "wrong_front": wrong, "ambiguous": 1, "rel_rms_t": 1e-6,
            "t_error_over_radius": {"p50": 1e-7, "p99": 1e-6, "max": 1e-5},
            "normal_degrees": {"mean": 0.01, "p99": 0.1, "max": 0.2}, "subset": "every pixel"
        }
    }))
    .expect("a record")
}
