//! Every WGSL file, under every variant that can choose it.

use std::collections::{BTreeMap, HashSet};

use metaball_shaders::{
    ComposeError, MODULES, Module, Variant, compose, compose_module, struct_layout,
};

/// Modules that a pipeline chooses by name, by the import path they share.
fn choices() -> Vec<Vec<&'static str>> {
    let mut by_path: BTreeMap<&str, Vec<&'static str>> = BTreeMap::new();
    for module in MODULES {
        let path = module.source.lines().find_map(|line| line.strip_prefix("#define_import_path "));
        if let Some(path) = path {
            by_path.entry(path.trim()).or_default().push(module.name);
        }
    }
    let by_variant = ["kernel", "strength", "color", "base", "work"];
    by_path.retain(|path, modules| {
        modules.len() > 1 && !by_variant.iter().any(|name| *path == format!("metaball::{name}"))
    });
    by_path.into_values().collect()
}

/// Every variant with the first of all choices, and with each other choice in turn.
fn variants() -> Vec<Variant> {
    let first: Vec<_> = choices().iter().map(|alternatives| alternatives[0]).collect();
    let mut combinations = vec![first.clone()];
    for (index, alternatives) in choices().iter().enumerate() {
        for other in &alternatives[1..] {
            let mut chosen = first.clone();
            chosen[index] = other;
            combinations.push(chosen);
        }
    }
    let chosen: Vec<&'static [&'static str]> =
        combinations.into_iter().map(|chosen| &*chosen.leak()).collect();
    let all = Variant::all();
    all.flat_map(|variant| chosen.iter().map(move |&chosen| Variant { chosen, ..variant }))
        .collect()
}

/// Number of entry points that the composed module has.
fn entry_points(module: &Module, variant: &Variant) -> usize {
    compose(module.name, variant)
        .unwrap_or_else(|error| panic!("{} under {variant:?}: {error}", module.name))
        .entry_points
        .len()
}

#[test]
fn every_entry_composes_and_validates_under_every_variant() {
    let variants = variants();
    let check = |module: &Module| {
        let counts = variants.iter().map(|variant| entry_points(module, variant));
        counts
            .inspect(|&found| assert!(found > 0, "{} has no entry point", module.name))
            .sum::<usize>()
    };
    let found: usize = std::thread::scope(|scope| {
        let entries = MODULES.iter().filter(|module| module.is_entry);
        let checks: Vec<_> = entries.map(|module| scope.spawn(move || check(module))).collect();
        checks.into_iter().map(|check| check.join().expect("checks")).sum()
    });
    assert!(found >= variants.len(), "found {found} entry points");
}

#[test]
fn every_import_composes_alone_and_has_no_entry() {
    let variants = variants();
    for module in MODULES.iter().filter(|module| !module.is_entry) {
        assert_eq!(entry_points(module, &variants[0]), 0, "{} has entry points", module.name);
    }
}

#[test]
fn every_file_is_in_the_table_once() {
    let names: HashSet<_> = MODULES.iter().map(|module| module.name).collect();
    assert_eq!(names.len(), MODULES.len());
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("wgsl");
    let mut files = HashSet::new();
    for folder in std::fs::read_dir(&root).expect("wgsl folder") {
        let folder = folder.expect("entry").path();
        for file in std::fs::read_dir(&folder).expect("a folder of modules") {
            let path = file.expect("entry").path().with_extension("");
            let name = path.strip_prefix(&root).expect("below the root");
            files.insert(name.to_str().expect("UTF-8").replace('\\', "/"));
        }
    }
    assert_eq!(files, names.into_iter().map(str::to_owned).collect());
}

#[test]
fn wgsl_stays_wgsl() {
    for Module { name, source, .. } in MODULES {
        let directives = source.lines().filter(|line| line.starts_with('#'));
        for line in directives {
            let known = line.starts_with("#import ") || line.starts_with("#define_import_path ");
            assert!(known, "{name}: {line}");
        }
    }
}

#[test]
fn unknown_names_are_named() {
    let variant = Variant::all().next().expect("there are variants");
    let error = compose("core/nonsense", &variant).expect_err("not in the table");
    assert_eq!(error, ComposeError::Unknown { name: "core/nonsense".to_owned() });
}

#[test]
fn layouts_are_reflected() {
    let variant = Variant::all().next().expect("there are variants");
    let module = compose("core/view", &variant).expect("composes");
    let layout = struct_layout(&module, "Ray").expect("core/view has rays");
    let members = [("direction".to_owned(), 0), ("t_max".to_owned(), 12)];
    assert_eq!((layout.members.as_slice(), layout.size), (&members[..], 16));
    assert_eq!(struct_layout(&module, "Nonsense"), None);
}

/// The message of a module made of these lines.
fn message(source: &'static str) -> String {
    let variant = Variant::all().next().expect("there are variants");
    let module = Module { name: "test/broken", source, is_entry: true };
    compose_module(&module, &variant).expect_err("broken").to_string()
}

#[test]
fn errors_show_file_and_line() {
    let text = message("fn fine() {}\nfn broken() -> u32 {\n    return nonsense;\n}\n");
    assert!(text.contains("wgsl/test/broken.wgsl:3:12"), "{text}");
    assert!(text.contains("return nonsense;"), "{text}");

    let invalid = message("fn broken() -> u32 {\n    return 1.5f;\n}\n");
    assert!(invalid.contains("wgsl/test/broken.wgsl"), "{invalid}");
}

#[test]
fn imports_without_one_provider_are_named() {
    let nobody = message("#import metaball::nobody\n");
    assert_eq!(
        nobody,
        "shader module test/broken imports metaball::nobody: needed one module to provide it, \
         found none"
    );
    let unchosen = message("#import metaball::opaque::opaque_distance\n");
    assert!(unchosen.ends_with("found opaque/none and opaque/image"), "{unchosen}");
}
