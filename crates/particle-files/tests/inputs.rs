//! The files that a path stands for.

use std::fs;
use std::path::Path;

use particle_files::inputs;

#[test]
fn every_file_that_is_read_is_named() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inputs");
    fs::create_dir_all(&folder).expect("the target folder is writable");
    let at = |name: &str| folder.join(name);
    for name in ["p1.xyz", "p3.xyz", "q.xyz"] {
        fs::write(at(name), "1\n\nC 0 0 0\n").expect("writable");
    }
    fs::write(at("one.toml"), "particles = 'q.xyz'").expect("writable");
    fs::write(at("many.toml"), "particles = 'p%d.xyz'").expect("writable");
    assert_eq!(inputs(at("q.xyz")), [at("q.xyz")]);
    assert_eq!(inputs(at("one.toml")), [at("one.toml"), at("q.xyz")]);
    assert_eq!(inputs(at("p%d.xyz")), [at("p%d.xyz"), at("p1.xyz"), at("p3.xyz")]);
    let many = ["many.toml", "p%d.xyz", "p1.xyz", "p3.xyz"].map(at);
    assert_eq!(inputs(at("many.toml")), many);
    assert_eq!(inputs(at("missing.toml")), [at("missing.toml")]);
}
