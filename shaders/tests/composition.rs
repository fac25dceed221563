//! Every WGSL file, under every variant that can choose it.

use std::collections::{BTreeMap, HashSet};

use metaball_shaders::{
    ComposeError, INTERFACES, Interface, KernelModule, MODULES, Module, Variant, code_size,
    compose, compose_module, struct_layout,
};

/// The modules that an interface's folder holds.
fn implementations(interface: &Interface) -> Vec<&'static Module> {
    let folder_of = |module: &Module| module.name.rsplit_once('/').expect("a folder").0;
    MODULES.iter().filter(|module| folder_of(module) == interface.folder).collect()
}

/// Folders of the interfaces that a module can be composed of, whatever is chosen.
fn reached(module: &'static Module) -> HashSet<&'static str> {
    let mut names = HashSet::new();
    let mut open = vec![module];
    while let Some(importer) = open.pop() {
        for import in importer.source.lines().filter_map(|line| line.strip_prefix("#import ")) {
            for provider in MODULES {
                // An import names a module, an item of it or a list of items.
                let rest = import.strip_prefix(provider.import_path().as_str());
                let provides = rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("::"));
                if provides && names.insert(provider.name) {
                    open.push(provider);
                }
            }
        }
    }
    let is_reached = |interface: &&Interface| {
        implementations(interface).iter().any(|it| names.contains(it.name))
    };
    INTERFACES.iter().filter(is_reached).map(|interface| interface.folder).collect()
}

/// Names of the modules that a pipeline chooses from, by the interface's folder.
fn choices() -> BTreeMap<&'static str, Vec<&'static str>> {
    INTERFACES
        .iter()
        .filter(|interface| !BY_VARIANT.contains(&interface.folder))
        .map(|interface| {
            let modules = implementations(interface);
            (interface.folder, modules.iter().map(|module| module.name).collect())
        })
        .collect()
}

/// Interfaces that the fields of a variant choose for.
const BY_VARIANT: [&str; 7] =
    ["kernel", "exponent", "support", "strength", "color", "shade/base", "work"];

/// Every variant that makes a difference to a module: with the first of all choices, and with each
/// other choice in turn. A choice for which the module reaches nothing stays as it is.
fn variants(module: &'static Module) -> Vec<Variant> {
    let reached = reached(module);
    let mut alternatives = choices();
    alternatives.retain(|interface, _| reached.contains(interface));
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
        BY_VARIANT.map(|interface| reached.contains(interface));
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

/// The test of a layer depends on all fields of a variant, 26 of them, on one of three Bernstein
/// forms, on one of three ways of clipping and on one of two lengths of lists; what tiles draw on two
/// outlines, and on nothing else.
#[test]
fn variants_are_those_that_differ() {
    let count = |name: &str| {
        let module = MODULES.iter().find(|module| module.name == name).expect("in the table");
        variants(module).len()
    };
    assert_eq!(count("kanamori_peel/test"), 26 * (1 + 2 + 2 + 1));
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
        chosen: &[
            "kanamori_peel/bernstein/quartic",
            "kanamori_peel/clipping/short_stack",
            "kanamori_peel/longest/four_targets",
        ],
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
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of modules") {
            let path = entry.expect("entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let path = path.with_extension("");
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
            assert!(line.starts_with("#import "), "{name}: {line}");
        }
    }
}

/// A declaration on one line, whatever lines it was broken into.
fn on_one_line(text: &str) -> String {
    let words: Vec<_> = text.split_whitespace().collect();
    words.join(" ").replace("( ", "(").replace(", )", ")")
}

/// Every file of an interface declares what the table says, and a folder is either an interface, with a
/// choice of files, or holds modules of their own.
#[test]
fn files_of_an_interface_declare_what_it_says() {
    for interface in INTERFACES {
        let modules = implementations(interface);
        assert!(modules.len() > 1, "{}: no choice", interface.folder);
        assert!(interface.declared().next().is_some(), "{}: declares nothing", interface.folder);
        for module in modules {
            let source = on_one_line(module.source);
            for declaration in interface.declared() {
                assert!(source.contains(declaration), "{}: no {declaration}", module.name);
            }
        }
        let below = format!("{}/", interface.folder);
        let is_deeper =
            |name: &str| name.strip_prefix(&below).is_some_and(|rest| rest.contains('/'));
        assert!(!MODULES.iter().any(|module| is_deeper(module.name)), "{below}: holds folders");
    }
}

#[test]
fn modules_are_imported_by_their_files_paths() {
    let path = |name: &str| {
        let module = MODULES.iter().find(|module| module.name == name).expect("in the table");
        module.import_path()
    };
    assert_eq!(path("core/view"), "core::view");
    assert_eq!(path("kernel/power"), "kernel");
    assert_eq!(path("fbvh/leaf/certified"), "fbvh::leaf");
    assert_eq!(path("fbvh/structure"), "fbvh::structure");
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
    let layout = struct_layout(&module, "PrimaryRay").expect("core/view has rays");
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
    let nobody = message("#import core::nobody\n");
    assert_eq!(
        nobody,
        "shader module test/broken imports core::nobody: needed one module to provide it, \
         found none"
    );
    let unchosen = message("#import opaque::opaque_distance\n");
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
