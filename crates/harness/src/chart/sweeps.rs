//! The knobs of every method: each turned on its own, from the method's preset.

use fbvh::{Boxes, Classes, Cost, Fitting, Options, Reading, Structure, TraceOptions};
use illes_fraglist::Piece;
use metaball_core::gpu::IsoRenderer;

use crate::methods::{METHODS, Method, find, tree_options};
use crate::setting::Setting;

/// Every setting of a chart of error against time: each method's preset, and each of its knobs
/// turned. Knobs that do not bear on a method are not in its list.
pub fn settings() -> Vec<Setting> {
    METHODS.iter().flat_map(|method| std::iter::once(method.into()).chain(turned(method))).collect()
}

/// A few of them, to see that everything works.
pub fn quick_settings() -> Vec<Setting> {
    let kept = ["tolerance", "threshold", "array"];
    let is_kept =
        |setting: &Setting| setting.options.keys().all(|name| kept.contains(&name.as_str()));
    settings().into_iter().filter(is_kept).collect()
}

/// A method with one of its knobs turned, for each position that differs from the preset.
fn turned(method: &'static Method) -> Vec<Setting> {
    match method.name {
        "bvh" => [searches(method, false), leaves(method)].concat(),
        "fbvh" => [searches(method, true), leaves(method), fitted(method)].concat(),
        "fbvh-certified" => certified(method),
        "kanamori" => kanamori(method),
        "kanamori-robust" => Vec::new(),
        _ => fragment_lists(method),
    }
}

fn tree(
    method: &'static Method,
    option: &str,
    value: &str,
    change: impl Fn(&mut Options, &mut TraceOptions),
) -> Option<Setting> {
    let preset = tree_options(method.name)?;
    let (mut options, mut trace) = (preset, TraceOptions::DEFAULT);
    change(&mut options, &mut trace);
    let is_preset = options == preset && trace == TraceOptions::DEFAULT;
    (!is_preset).then(|| {
        Setting::with(method, option, value, move |counting| {
            Box::new(fbvh::gpu::Renderer::new(method.name, options, trace, counting))
        })
    })
}

/// How closely the secant search closes in (section 3), and how the leaf test is read.
fn searches(method: &'static Method, has_readings: bool) -> Vec<Setting> {
    let tolerances =
        [("1e-1", 1e-1), ("1e-2", 1e-2), ("1e-3", 1e-3), ("1e-4", 1e-4), ("1e-6", 1e-6)];
    let mut settings: Vec<_> = tolerances
        .into_iter()
        .filter_map(|(name, tolerance)| {
            tree(method, "tolerance", name, |_, trace| trace.tolerance = tolerance)
        })
        .collect();
    if has_readings {
        let literal = |_: &mut Options, trace: &mut TraceOptions| trace.reading = Reading::Literal;
        settings.extend(tree(method, "reading", "literal", literal));
    }
    settings
}

/// When a node is a leaf.
fn leaves(method: &'static Method) -> Vec<Setting> {
    let sizes = [("4", 4), ("16", 16)];
    let costs = [("4", 4.0), ("96", 96.0)];
    let sizes = sizes.into_iter().filter_map(|(name, size)| {
        tree(method, "leaf size", name, |options, _| options.leaf_size = size)
    });
    let costs = costs.into_iter().filter_map(|(name, cost)| {
        tree(method, "traversal cost", name, |options, _| options.traversal_cost = cost)
    });
    sizes.chain(costs).collect()
}

/// Heuristic, fitting and discarding: sections 5.1 and 5.3.
fn fitted(method: &'static Method) -> Vec<Setting> {
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
fn certified(method: &'static Method) -> Vec<Setting> {
    let Some(Options { structure: Structure::Certified(preset), .. }) = tree_options(method.name)
    else {
        return Vec::new();
    };
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

/// Threshold of clipping, length of lists, culling: sections 4.2, 5.2 and 5.4.
fn kanamori(method: &'static Method) -> Vec<Setting> {
    use kanamori_peel::Options;
    let preset = Options::default();
    let thresholds = [("1e-1", 1e-1), ("1e-2", 1e-2), ("1e-4", 1e-4), ("1e-5", 1e-5)]
        .map(|(name, threshold)| ("threshold", name, Options { threshold, ..preset }));
    let lists = [("6", 6), ("22", 22), ("30", 30)]
        .map(|(name, list_capacity)| ("list", name, Options { list_capacity, ..preset }));
    let culling = [("culling", "off", Options { culling: false, ..preset })];
    thresholds
        .into_iter()
        .chain(lists)
        .chain(culling)
        .map(|(option, name, options)| {
            Setting::with(method, option, name, move |counting| {
                Box::new(kanamori_peel::Renderer::new(method.name, options, counting))
            })
        })
        .collect()
}

/// Length of the local array.
fn fragment_lists(method: &'static Method) -> Vec<Setting> {
    use illes_fraglist::{Gather, Options, Renderer};
    let preset = match method.name {
        "illes" => Options::default(),
        "illes-absolute" => Options { piece: Piece::AbsoluteCubic, ..Options::default() },
        "illes-exact" => Options { piece: Piece::Exact, ..Options::default() },
        "illes-robust" => Options { piece: Piece::Robust, ..Options::default() },
        "illes-compute" => Options { gather: Gather::Tiles, ..Options::default() },
        _ => return Vec::new(),
    };
    [("6", 6), ("12", 12), ("24", 24)]
        .into_iter()
        .map(|(name, room)| {
            let options = Options { room, ..preset };
            Setting::with(method, "array", name, move |counting| -> Box<dyn IsoRenderer> {
                Box::new(Renderer::new(method.name, options, counting))
            })
        })
        .collect()
}

/// The presets that growth and density are measured with.
pub fn presets(names: &[&str]) -> Vec<Setting> {
    names.iter().filter_map(|name| find(name)).map(Setting::preset).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_method_has_its_preset_and_no_setting_comes_twice() {
        for settings in [settings(), quick_settings()] {
            let names: BTreeSet<_> = settings.iter().map(Setting::to_string).collect();
            assert_eq!(names.len(), settings.len());
            for method in METHODS {
                assert!(names.contains(method.name), "{}", method.name);
            }
            for setting in &settings {
                assert_eq!(setting.renderer(false).name(), setting.method.name);
            }
        }
        assert!(settings().len() > quick_settings().len());
    }
}
