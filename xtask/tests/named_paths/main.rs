//! Every path that a comment or a text names is there.
//!
//! Comments of Rust, WGSL and TOML and the texts in Markdown are searched for two kinds of names:
//!
//! - *Source files*: whatever ends in `.rs`, `.wgsl` or `.md`. Such a name is a path from the root of the
//!   repository, from the root of the file's own package or its `src`, from the shaders' `wgsl` folder, or, in
//!   Markdown, from the text's own folder. A bare name is that of a file in the same folder, or of the only
//!   such file in the package, or among the shaders.
//! - *Rooted paths*, of any file or folder, in code spans and code blocks: their first part is a folder at the
//!   root of the repository.
//!
//! Links in Markdown are paths too. Names of users' own files have neither form, and names with a placeholder
//! (`NN`, `*`, `…`, `<name>`) are no paths. Change logs and recorded measurements describe the past and are not
//! searched.

mod names;
mod prose;
mod tree;

use std::fmt;

use crate::tree::Tree;

/// A name without a file.
#[derive(Debug, PartialEq, Eq)]
struct Offender {
    file: String,
    line: usize,
    name: String,
}

impl fmt::Display for Offender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, name } = self;
        write!(f, "{file}:{line}: {name}")
    }
}

/// What a file's text names and the tree does not have.
fn offenders(tree: &Tree, file: &str, text: &str) -> Vec<Offender> {
    let mut found = Vec::new();
    for line in prose::of(file, text) {
        for name in names::in_line(tree, file, &line) {
            if !tree.has(file, &name) {
                let name = name.path;
                found.push(Offender { file: file.to_owned(), line: line.number, name });
            }
        }
    }
    found.dedup();
    found
}

/// Whether a file describes the past.
fn is_history(file: &str) -> bool {
    file.ends_with("CHANGELOG.md") || file.split('/').any(|folder| folder == "runs")
}

#[test]
fn every_named_path_exists() {
    let tree = Tree::of_repository();
    let mut searched = 0;
    let mut found = Vec::new();
    for file in tree.files().filter(|file| prose::is_known(file) && !is_history(file)) {
        found.extend(offenders(&tree, file, &tree.read(file)));
        searched += 1;
    }
    assert!(searched > 100, "searched {searched} files alone");
    let list: Vec<_> = found.iter().map(Offender::to_string).collect();
    assert!(list.is_empty(), "{} names without a file:\n{}", list.len(), list.join("\n"));
}

fn example() -> Tree {
    Tree::new(&[
        "Cargo.toml",
        "README.md",
        "docs/one.md",
        "crates/sphere/Cargo.toml",
        "crates/sphere/src/lib.rs",
        "crates/sphere/src/gpu/mod.rs",
        "crates/sphere/src/trace/mod.rs",
        "crates/sphere/src/trace/leaf.rs",
        "shaders/Cargo.toml",
        "shaders/wgsl/sphere/trace.wgsl",
        "shaders/wgsl/sphere/leaf.wgsl",
        "shaders/wgsl/kernel/power.wgsl",
        "shaders/wgsl/peel/power.wgsl",
    ])
}

/// Names reported for a text in a file.
fn reported(file: &str, text: &str) -> Vec<String> {
    offenders(&example(), file, text).into_iter().map(|offender| offender.name).collect()
}

/// The canary.
#[test]
fn wrong_names_are_reported() {
    let rust = "crates/sphere/src/lib.rs";
    assert_eq!(reported(rust, "//! As in `suspend.wgsl`."), ["suspend.wgsl"]);
    assert_eq!(reported(rust, "let x = 1; // see nodes/node.rs"), ["nodes/node.rs"]);
    assert_eq!(reported(rust, "/* as trace/node.rs has it */"), ["trace/node.rs"]);
    // There are two.
    assert_eq!(reported(rust, "/// The other `mod.rs`."), ["mod.rs"]);
    assert_eq!(reported(rust, "// WGSL's is power.wgsl."), ["power.wgsl"]);
    // From another package it names nothing.
    assert_eq!(reported("shaders/src/lib.rs", "// gpu/mod.rs has it"), ["gpu/mod.rs"]);
    assert_eq!(reported("shaders/wgsl/sphere/leaf.wgsl", "// from walk.wgsl"), ["walk.wgsl"]);
    assert_eq!(reported("Cargo.toml", "a = 1 # as `docs/two.md` says"), ["docs/two.md"]);

    let text = "docs/one.md";
    assert_eq!(
        reported(text, "[here](two.md), and [there](../crates/cube)"),
        ["two.md", "../crates/cube"]
    );
    assert_eq!(reported(text, "The records in `crates/sphere/runs/`."), ["crates/sphere/runs"]);
    assert_eq!(reported(text, "```sh\ncargo install --path crates/cube\n```"), ["crates/cube"]);
    assert_eq!(reported(text, "`sphere/{leaf,walk}.wgsl`"), ["sphere/walk.wgsl"]);

    let twice = offenders(&example(), rust, "fn a() {}\n\n// a.rs\n// b.rs\n");
    let lines: Vec<_> = twice.iter().map(Offender::to_string).collect();
    assert_eq!(lines, ["crates/sphere/src/lib.rs:3: a.rs", "crates/sphere/src/lib.rs:4: b.rs"]);
}

#[test]
fn right_names_pass() {
    let rust = "crates/sphere/src/trace/mod.rs";
    let names = "crates/sphere/src/gpu/mod.rs, src/trace/leaf.rs, gpu/mod.rs, leaf.rs, lib.rs, \
        shaders/wgsl/kernel/power.wgsl, kernel/power.wgsl, trace.wgsl, README.md, docs/one.md";
    assert_eq!(reported(rust, &format!("//! {names}")), [""; 0]);
    assert_eq!(reported("shaders/wgsl/kernel/any.wgsl", "// v as in power.wgsl"), [""; 0]);
    let text = "[one.md](one.md#part), [`lib.rs`](../crates/sphere/src/lib.rs), `../README.md`, `crates/sphere/`, `sphere/{leaf,trace}.wgsl`";
    assert_eq!(reported("docs/one.md", text), [""; 0]);
}

#[test]
fn users_files_patterns_and_code_pass() {
    let text = "`protein.pdb`, `pool.csv`, `out/compare/index.html`, `frame-%04d.xyz`, `pool.toml`, \
        https://example.org/a/b.md, /usr/share/vulkan/icd.d, `docs/NN-title.md`, `crates/*/src/lib.rs`, \
        `<name>.rs`, and docs/tests in words.\n\n```rust\nmod walk; // src/walk.rs\n```\n";
    assert_eq!(reported("README.md", text), [""; 0]);
    let code = "const A: &str = \"// walk.rs\";\nconst B: &str = r#\"\" // walk.rs\"#;\nlet c = '\"'; f::<'a>()";
    assert_eq!(reported("crates/sphere/src/lib.rs", code), [""; 0]);
    let example = "/// ```\n/// include!(\"walk.rs\");\n/// ```\n";
    assert_eq!(reported("crates/sphere/src/lib.rs", example), [""; 0]);
}
