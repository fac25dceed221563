//! The knobs of every method: each turned on its own, from the method's preset, and those of the published
//! trees that interact turned together.

use std::collections::BTreeMap;

use fbvh::{Boxes, Classes, Cost, Fitting, Options, Reading, SecantSearch, Structure};
use illes_fraglist::Sort;
use kanamori_peel::{Clipping, Outline, Registration};

use super::Configuration;
use crate::methods::{Method, find, methods};
use crate::technique::Technique;

/// Every configuration of a chart of error against time: each method's preset, each of its knobs turned,
/// and every combination of those that interact. Knobs that do not bear on a method are not in its list.
pub fn configurations() -> Vec<Configuration> {
    let with_turned = |method: &'static Method| {
        std::iter::once(method.into()).chain(turned(method)).chain(jointly(method))
    };
    methods().iter().flat_map(with_turned).collect()
}

/// A few of them, to see that everything works.
pub fn quick_configurations() -> Vec<Configuration> {
    let kept = ["tolerance", "threshold", "array"];
    let is_kept = |configuration: &Configuration| {
        configuration.options.keys().all(|name| kept.contains(&name.as_str()))
    };
    configurations().into_iter().filter(is_kept).collect()
}

/// Ends of knobs at which error is given away for time.
const CRUDE: &[(&str, &str)] = &[
    ("tolerance", "1e-2"),
    ("tolerance", "1e-1"),
    ("threshold", "1e-2"),
    ("threshold", "1e-1"),
    ("array", "24"),
];

/// Whom `auto` chooses from: every preset, and the crude ends of the knobs that trade error for
/// time.
pub fn candidates() -> Vec<Configuration> {
    let is_crude = |configuration: &Configuration| {
        let mut options = configuration.options.iter();
        options.all(|(name, value)| CRUDE.contains(&(name.as_str(), value.as_str())))
    };
    configurations().into_iter().filter(is_crude).collect()
}

/// A method with one of its knobs turned, for each position that differs from the preset.
fn turned(method: &'static Method) -> Vec<Configuration> {
    match method.technique {
        Technique::Tree(options, _) | Technique::TreeOnHost(options, _) => {
            match options.structure {
                Structure::ModifiedBvh => [searches(method, false), leaves(method)].concat(),
                Structure::Fitted(_) => {
                    [searches(method, true), leaves(method), fitted(method)].concat()
                }
                Structure::Certified(classes) => certified(method, classes),
            }
        }
        Technique::Peeling(preset) => peeling(method, preset),
        Technique::Baseline { .. } => clipping(method),
        Technique::Fragments(preset) => fragment_lists(method, preset),
        Technique::TileSearch | Technique::Own(_) => Vec::new(),
    }
}

fn tree(
    method: &'static Method,
    option: &str,
    value: &str,
    change: impl Fn(&mut Options, &mut Option<SecantSearch>),
) -> Option<Configuration> {
    let (Technique::Tree(preset, preset_search) | Technique::TreeOnHost(preset, preset_search)) =
        method.technique
    else {
        return None;
    };
    let (mut options, mut search) = (preset, preset_search);
    change(&mut options, &mut search);
    let is_preset = options == preset && search == preset_search;
    let turned = match method.technique {
        Technique::TreeOnHost(..) => Technique::TreeOnHost(options, search),
        _ => Technique::Tree(options, search),
    };
    (!is_preset).then(|| Configuration::with(method, option, value, turned))
}

/// How closely the secant search closes in (section 3), and how the leaf test is read.
fn searches(method: &'static Method, has_readings: bool) -> Vec<Configuration> {
    let tolerances =
        [("1e-1", 1e-1), ("1e-2", 1e-2), ("1e-3", 1e-3), ("1e-4", 1e-4), ("1e-6", 1e-6)];
    let mut configurations: Vec<_> = tolerances
        .into_iter()
        .filter_map(|(name, tolerance)| {
            tree(method, "tolerance", name, |_, search| {
                *search = search.map(|search| SecantSearch { tolerance, ..search });
            })
        })
        .collect();
    if has_readings {
        configurations.extend(tree(method, "reading", "literal", |_, search| {
            *search = search.map(|search| SecantSearch { reading: Reading::Literal, ..search });
        }));
    }
    configurations
}

/// When a node is a leaf.
fn leaves(method: &'static Method) -> Vec<Configuration> {
    let sizes = [("4", 4), ("16", 16)];
    let costs = [("4", 4.0), ("96", 96.0)];
    let sizes = sizes.into_iter().filter_map(|(name, size)| {
        tree(method, "leaf size", name, |options, _| options.leaf_size = size)
    });
    let costs = costs.into_iter().filter_map(|(name, cost)| {
        tree(method, "traversal cost", name, |options, _| options.traversal_cost = cost)
    });
    let halved = tree(method, "halve above", "1000", |options, _| options.halve_above = 1_000);
    sizes.chain(costs).chain(halved).collect()
}

/// A knob's position other than the preset's: its option, its value, and what it sets.
type Turn = (&'static str, &'static str, fn(&mut Options, &mut SecantSearch));

/// Knobs of a published tree of which one decides how much another brings: a coarse search makes large
/// leaves cheap, large leaves want cheap steps, and what the builder may leave out depends on both.
const JOINT: [&[Turn]; 4] = [
    &[("tolerance", "1e-2", |_, search| search.tolerance = 1e-2)],
    &[("leaf size", "4", |options, _| options.leaf_size = 4)],
    &[
        ("traversal cost", "4", |options, _| options.traversal_cost = 4.0),
        ("traversal cost", "96", |options, _| options.traversal_cost = 96.0),
    ],
    &[("halve above", "1000", |options, _| options.halve_above = 1_000)],
];

/// The same of the Fitted BVH's boxes.
const JOINT_FITTED: [&[Turn]; 2] = [
    &[("boxes", "per ball", |options, _| fit(options, |fitting| fitting.boxes = Boxes::PerBall))],
    &[("discarding", "off", |options, _| fit(options, |fitting| fitting.discard_up_to = 0))],
];

fn fit(options: &mut Options, change: impl FnOnce(&mut Fitting)) {
    if let Structure::Fitted(fitting) = &mut options.structure {
        change(fitting);
    }
}

/// Every combination of two or more knobs of a published tree that interact.
fn jointly(method: &'static Method) -> Vec<Configuration> {
    let Technique::Tree(preset, Some(preset_search)) = method.technique else {
        return Vec::new();
    };
    let is_fitted = matches!(preset.structure, Structure::Fitted(_));
    let knobs = JOINT.into_iter().chain(JOINT_FITTED.into_iter().filter(|_| is_fitted));
    let mut settings = vec![(BTreeMap::new(), preset, preset_search)];
    for turns in knobs {
        let turned: Vec<_> = settings
            .iter()
            .flat_map(|(names, options, search)| {
                turns.iter().map(move |(option, value, turn)| {
                    let (mut names, mut options, mut search) = (names.clone(), *options, *search);
                    names.insert((*option).to_owned(), (*value).to_owned());
                    turn(&mut options, &mut search);
                    (names, options, search)
                })
            })
            .collect();
        settings.extend(turned);
    }
    settings
        .into_iter()
        .filter(|(names, ..)| names.len() > 1)
        .map(|(names, options, search)| {
            Configuration::with_all(method, names, Technique::Tree(options, Some(search)))
        })
        .collect()
}

/// Heuristic, fitting and discarding: sections 5.1 and 5.3.
fn fitted(method: &'static Method) -> Vec<Configuration> {
    let fitting = |boxes, discard_up_to| Structure::Fitted(Fitting { boxes, discard_up_to });
    let structures = [
        ("boxes", "cut", fitting(Boxes::Cut, 0)),
        ("boxes", "support", fitting(Boxes::Support, 12)),
        ("boxes", "per ball", fitting(Boxes::PerBall, 12)),
        ("discarding", "off", fitting(Boxes::PerNode, 0)),
    ];
    let structures = structures.into_iter().filter_map(|(option, name, structure)| {
        tree(method, option, name, |options, _| options.structure = structure)
    });
    let linear = tree(method, "leaf cost", "n", |options, _| options.cost = Cost::Linear);
    structures.chain(linear).collect()
}

/// When a box that may hold surface is a leaf.
fn certified(method: &'static Method, preset: Classes) -> Vec<Configuration> {
    let sizes = [("8", 8), ("12", 12), ("24", 24), ("48", 48)];
    let sides = [("1/4", 0.25), ("1", 1.0)];
    let sizes = sizes.map(|(name, leaf_size)| ("leaf size", name, Classes { leaf_size, ..preset }));
    let sides = sides
        .map(|(name, side)| ("smallest side", name, Classes { smallest_side: side, ..preset }));
    let classes = sizes.into_iter().chain(sides);
    classes
        .filter_map(|(option, name, classes)| {
            let structure = Structure::Certified(classes);
            tree(method, option, name, |options, _| options.structure = structure)
        })
        .collect()
}

/// Threshold and way of clipping, length of lists, and what bears on time alone: sections 4.2 and
/// 5.1 to 5.4.
fn peeling(method: &'static Method, preset: kanamori_peel::Options) -> Vec<Configuration> {
    use kanamori_peel::Options;
    let knobs = [
        ("threshold", "1e-1", Options { threshold: 1e-1, ..preset }),
        ("threshold", "1e-2", Options { threshold: 1e-2, ..preset }),
        ("threshold", "1e-4", Options { threshold: 1e-4, ..preset }),
        ("threshold", "1e-5", Options { threshold: 1e-5, ..preset }),
        ("list", "6", Options { list_capacity: 6, ..preset }),
        ("list", "22", Options { list_capacity: 22, ..preset }),
        ("list", "30", Options { list_capacity: 30, ..preset }),
        ("clipping", "iterative", Options { clipping: Clipping::Iterative, ..preset }),
        ("clipping", "original", Options { clipping: Clipping::Original, ..preset }),
        ("outline", "tessellated", Options { outline: Outline::Tessellation, ..preset }),
        ("culling", "off", Options { culling: false, ..preset }),
        ("tiles", "1", Options { tiles: 1, ..preset }),
        ("tiles", "4", Options { tiles: 4, ..preset }),
        ("tiles", "16", Options { tiles: 16, ..preset }),
        ("registration", "adapter", Options { registration: Registration::Adapter, ..preset }),
    ];
    let configuration = |(option, value, options)| {
        Configuration::with(method, option, value, Technique::Peeling(options))
    };
    knobs.map(configuration).into()
}

/// How far the baseline clips.
fn clipping(method: &'static Method) -> Vec<Configuration> {
    let thresholds = [("1e-1", 1e-1), ("1e-2", 1e-2), ("1e-4", 1e-4), ("1e-5", 1e-5)];
    let configuration = |(value, threshold)| {
        Configuration::with(method, "threshold", value, Technique::Baseline { threshold })
    };
    thresholds.map(configuration).into()
}

/// Length of the local array, and where balls are sorted.
fn fragment_lists(method: &'static Method, preset: illes_fraglist::Options) -> Vec<Configuration> {
    use illes_fraglist::Options;
    let knobs = [
        ("array", "6", Options { array_capacity: 6, ..preset }),
        ("array", "12", Options { array_capacity: 12, ..preset }),
        ("array", "24", Options { array_capacity: 24, ..preset }),
        ("sort", "adapter", Options { sort: Sort::Adapter, ..preset }),
    ];
    let configuration = |(option, value, options)| {
        Configuration::with(method, option, value, Technique::Fragments(options))
    };
    knobs.map(configuration).into()
}

/// The presets that growth and density are measured with.
pub fn presets(names: &[&str]) -> Vec<Configuration> {
    names.iter().filter_map(|name| find(name)).map(Configuration::preset).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_method_has_its_preset_and_no_setting_comes_twice() {
        for configurations in [configurations(), quick_configurations(), candidates()] {
            let names: BTreeSet<_> = configurations.iter().map(Configuration::to_string).collect();
            assert_eq!(names.len(), configurations.len());
            for method in methods() {
                assert!(names.contains(method.name), "{}", method.name);
            }
            for configuration in &configurations {
                assert_eq!(configuration.renderer(false).name(), configuration.method.name);
            }
        }
        assert!(configurations().len() > quick_configurations().len());
        // Two of six knobs' positions, two of them of one knob; without the preset and single turns.
        let joint = |name| jointly(find(name).expect("listed")).len();
        assert_eq!((joint("bvh"), joint("fbvh")), (2 * 2 * 3 * 2 - 6, 2 * 2 * 3 * 2 * 2 * 2 - 8));
        for crude in CRUDE {
            let has = |configuration: &Configuration| {
                configuration
                    .options
                    .iter()
                    .any(|(name, value)| (name.as_str(), value.as_str()) == *crude)
            };
            assert!(candidates().iter().any(has), "{crude:?} is an end of no knob");
        }
    }
}
