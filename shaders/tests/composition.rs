//! Every WGSL file, under every variant that can choose it.

use std::collections::{BTreeMap, HashSet};

use metaball_shaders::{
    ComposeError, KernelModule, MODULES, Module, Variant, code_size, compose, compose_module,
    struct_layout,
};

/// What stands behind a directive in a module's lines.
fn directives(module: &Module, keyword: &str) -> impl Iterator<Item = &'static str> {
    module.source.lines().filter_map(move |line| line.strip_prefix(keyword)).map(str::trim)
}

fn import_path(module: &Module) -> Option<&'static str> {
    directives(module, "#define_import_path ").next()
}

/// Import paths of everything that a module can be composed of, whatever is chosen.
fn reached(module: &'static Module) -> HashSet<&'static str> {
    let mut paths = HashSet::new();
    let mut names = HashSet::new();
    let mut open = vec![module];
    while let Some(importer) = open.pop() {
        for import in directives(importer, "#import ") {
            for provider in MODULES {
                // An import names a module, an item of it or a list of items.
                let rest = import_path(provider).and_then(|path| import.strip_prefix(path));
                let provides = rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("::"));
                if provides && names.insert(provider.name) {
                    paths.extend(import_path(provider));
                    open.push(provider);
                }
            }
        }
    }
    paths
}

/// Modules that a pipeline chooses by name, by the import path they share.
fn choices() -> BTreeMap<&'static str, Vec<&'static str>> {
    let mut by_path: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for module in MODULES {
        if let Some(path) = import_path(module) {
            by_path.entry(path).or_default().push(module.name);
        }
    }
    by_path.retain(|path, modules| modules.len() > 1 && !BY_VARIANT.contains(path));
    by_path
}

/// Import paths that the fields of a variant choose for.
const BY_VARIANT: [&str; 7] = [
    "metaball::kernel",
    "metaball::exponent",
    "metaball::support",
    "metaball::strength",
    "metaball::color",
    "metaball::base",
    "metaball::work",
];

/// Every variant that makes a difference to a module: with the first of all choices, and with each
/// other choice in turn. A choice for which the module reaches nothing stays as it is.
fn variants(module: &'static Module) -> Vec<Variant> {
    let reached = reached(module);
    let mut alternatives = choices();
    alternatives.retain(|path, _| reached.contains(path));
    let first: Vec<_> = alternatives.values().map(|modules| modules[0]).collect();
    let mut combinations = vec![first.clone()];
    for (index, modules) in alternatives.values().enumerate() {
        for other in &modules[1..] {
            let mut chosen = first.clone();
            chosen[index] = other;
            combinations.push(chosen);
        }
    }
    let chosen: Vec<&'static [&'static str]> =
        combinations.into_iter().map(|chosen| &*chosen.leak()).collect();
    let [kernel, exponent, support, strength, color, base, work] =
        BY_VARIANT.map(|path| reached.contains(path));
    let mut telling = Vec::new();
    for variant in Variant::trials() {
        let same_here = Variant {
            kernel: if kernel || exponent { variant.kernel } else { KernelModule::Power },
            radii: variant.radii && support,
            strengths: variant.strengths && strength,
            colors: variant.colors && (color || base),
            counting: variant.counting && work,
            chosen: &[],
        };
        if !telling.contains(&same_here) {
            telling.push(same_here);
        }
    }
    let with_choices = |variant| chosen.iter().map(move |&chosen| Variant { chosen, ..variant });
    telling.into_iter().flat_map(with_choices).collect()
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
    let check = |module: &'static Module| {
        for variant in variants(module) {
            assert!(entry_points(module, &variant) > 0, "{} has no entry point", module.name);
        }
    };
    std::thread::scope(|scope| {
        for module in MODULES.iter().filter(|module| module.is_entry) {
            scope.spawn(move || check(module));
        }
    });
}

/// The test of a layer depends on all fields of a variant, 14 of them, on one of three Bernstein
/// forms and on one of three ways of clipping; what tiles draw on two outlines, and on nothing else.
#[test]
fn variants_are_those_that_differ() {
    let count = |name: &str| {
        let module = MODULES.iter().find(|module| module.name == name).expect("in the table");
        variants(module).len()
    };
    assert_eq!(count("kanamori_peel/test"), 14 * (1 + 2 + 2));
    assert_eq!(count("kanamori_peel/turn"), 1 + 1);
}

/// Group and binding of everything that the composed module binds.
fn bindings(name: &str, variant: &Variant) -> Vec<(u32, u32)> {
    let module = compose(name, variant).expect("composes");
    let bound = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    let mut bindings: Vec<_> = bound.map(|binding| (binding.group, binding.binding)).collect();
    bindings.sort_unstable();
    bindings
}

/// What a variant has no use for does not exist in its shader: neither of the scene's arrays (group 1)
/// nor of the frame's (group 0).
#[test]
fn variants_bind_what_they_need() {
    let least = Variant {
        kernel: KernelModule::Power,
        radii: false,
        strengths: false,
        colors: false,
        counting: false,
        chosen: &["kanamori_peel/quartic", "kanamori_peel/clipping_short_stack"],
    };
    let least_bindings = bindings("kanamori_peel/test", &least);
    let more = |variant: Variant| {
        let bindings = bindings("kanamori_peel/test", &variant);
        assert!(least_bindings.iter().all(|binding| bindings.contains(binding)));
        bindings.into_iter().filter(|binding| !least_bindings.contains(binding)).collect::<Vec<_>>()
    };
    assert_eq!(more(Variant { radii: true, ..least }), []);
    assert_eq!(more(Variant { strengths: true, ..least }), [(1, 1)]);
    assert_eq!(more(Variant { colors: true, ..least }), [(0, 4), (1, 2)]);
    assert_eq!(more(Variant { counting: true, ..least }), [(0, 5)]);
    assert_eq!(more(Variant { kernel: KernelModule::Wyvill, ..least }), []);
    for kernel in [KernelModule::AnyPower, KernelModule::Any] {
        assert_eq!(more(Variant { kernel, ..least }), [(1, 4)]);
    }
}

#[test]
fn every_import_composes_alone_and_has_no_entry() {
    for module in MODULES.iter().filter(|module| !module.is_entry) {
        let variant = variants(module)[0];
        assert_eq!(entry_points(module, &variant), 0, "{} has entry points", module.name);
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
    let variant = Variant::trials().next().expect("there are variants");
    let error = compose("core/nonsense", &variant).expect_err("not in the table");
    assert_eq!(error, ComposeError::Unknown { name: "core/nonsense".to_owned() });
}

#[test]
fn layouts_are_reflected() {
    let variant = Variant::trials().next().expect("there are variants");
    let module = compose("core/view", &variant).expect("composes");
    let layout = struct_layout(&module, "Ray").expect("core/view has rays");
    let members = [("direction".to_owned(), 0), ("t_max".to_owned(), 12)];
    assert_eq!((layout.members.as_slice(), layout.size), (&members[..], 16));
    assert_eq!(struct_layout(&module, "Nonsense"), None);
}

/// The message of a module made of these lines.
fn message(source: &'static str) -> String {
    let variant = Variant::trials().next().expect("there are variants");
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

#[test]
fn code_grows_with_what_is_written() {
    let variant = Variant::trials().next().expect("there are variants");
    let size = |source| {
        let module = Module { name: "test/size", source, is_entry: true };
        code_size(&compose_module(&module, &variant).expect("composes"))
    };
    let empty = size("@compute @workgroup_size(1) fn a() {}");
    let once = size("@compute @workgroup_size(1) fn a() { var x = 1; x = x + 1; }");
    let twice = size("@compute @workgroup_size(1) fn a() { var x = 1; x = x + 1; x = x + 1; }");
    let nested = size(
        "@compute @workgroup_size(1) fn a() { var x = 1; if x > 0 { x = x + 1; x = x + 1; } }",
    );
    assert!(empty < once && once < twice && twice < nested);
}
