//! What a chart measures: which scenes, for what, with which configurations.

use serde::{Deserialize, Serialize};

use crate::compare::DEFAULT_SCENES;
use crate::extent::Extent;
use harness::configuration::{Configuration, sweeps};
use harness::methods::{Method, methods};
use harness::technique::Technique;

/// What a scene is measured for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Purpose {
    /// Error against time: every method, every knob.
    Error,
    /// Time and memory against the number of balls, of scenes by this generator.
    Growth(String),
    /// Time against density: one camera and count of balls, growing radii, and a threshold that
    /// keeps the number of pixels that hit.
    Density,
}

impl Purpose {
    /// The names of all.
    pub const NAMES: [&str; 3] = ["error", "growth", "density"];

    /// Its name, whatever the generator.
    pub fn name(&self) -> &'static str {
        let [error, growth, density] = Self::NAMES;
        match self {
            Self::Error => error,
            Self::Growth(_) => growth,
            Self::Density => density,
        }
    }
}

/// A scene, and what to measure on it.
#[derive(Debug, Clone)]
pub struct Planned {
    /// What for.
    pub purpose: Purpose,
    /// What to load.
    pub spec: String,
    /// The configurations that take part.
    pub configurations: Vec<Configuration>,
}

/// What growth and density are measured of: the published families, and what is faster; methods from
/// outside of this workspace join them.
const GROWTH_METHODS: &[&str] = &[
    "bvh",
    "fbvh",
    "fbvh-certified",
    "fbvh-certified-cpu",
    "kanamori",
    "kanamori-cpu",
    "illes",
    "illes-rebuilt",
    "illes-compute",
];

/// Everything to measure, in order. `scenes` are those of the charts of error; where there are none,
/// those of the extent. `chosen` are the methods that take part; all where there are none.
pub fn plan(extent: Extent, scenes: &[String], chosen: &[&Method]) -> Vec<Planned> {
    let (known, counts, count, densities): (&[&str], &[u32], u32, &[u32]) = match extent {
        Extent::Whole => (
            DEFAULT_SCENES,
            &[1_000, 3_000, 10_000, 30_000, 100_000, 300_000, 1_000_000],
            10_000,
            &[5, 10, 20, 40, 80, 160, 320, 500],
        ),
        Extent::Quick => (&["random-200"], &[100, 300], 200, &[5, 10]),
    };
    let errors = match extent {
        Extent::Whole => sweeps::configurations(),
        Extent::Quick => sweeps::quick_configurations(),
    };
    let takes_part = |configuration: &Configuration| {
        let name = configuration.method.name;
        chosen.is_empty() || chosen.iter().any(|method| method.name == name)
    };
    let errors: Vec<_> = errors.into_iter().filter(takes_part).collect();
    let own = methods().iter().filter(|method| matches!(method.technique, Technique::Own(_)));
    let named = sweeps::presets(GROWTH_METHODS).into_iter().chain(own.map(Configuration::preset));
    let presets: Vec<_> = named.filter(takes_part).collect();
    let scenes: Vec<_> = match scenes {
        [] => known.iter().map(|&name| name.to_owned()).collect(),
        chosen => chosen.to_vec(),
    };
    let errors = scenes.into_iter().map(|spec| Planned {
        purpose: Purpose::Error,
        spec,
        configurations: errors.clone(),
    });
    let growth = ["scattered", "tornado"].into_iter().flat_map(|family| {
        let presets = &presets;
        counts.iter().map(move |count| Planned {
            purpose: Purpose::Growth(family.to_owned()),
            spec: format!("{family}:{count}"),
            configurations: presets.clone(),
        })
    });
    let density = densities.iter().map(|density| Planned {
        purpose: Purpose::Density,
        spec: format!("scattered:{count}:{density}"),
        configurations: presets.clone(),
    });
    let planned = errors.chain(growth).chain(density);
    planned.filter(|planned| !planned.configurations.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use harness::methods::find;

    use super::*;

    #[test]
    fn every_planned_scene_loads_and_comes_once() {
        for extent in [Extent::Whole, Extent::Quick] {
            let plan = plan(extent, &[], &[]);
            for planned in &plan {
                let same = |other: &&Planned| {
                    (&other.spec, &other.purpose) == (&planned.spec, &planned.purpose)
                };
                assert_eq!(plan.iter().filter(same).count(), 1, "{}", planned.spec);
                assert!(!planned.configurations.is_empty());
                if extent == Extent::Quick {
                    load(&planned.spec, &Overrides::default()).expect("loads");
                }
            }
        }
        let chosen = plan(Extent::Quick, &["two-far".to_owned()], &[]);
        assert_eq!((chosen[0].spec.as_str(), &chosen[0].purpose), ("two-far", &Purpose::Error));
    }

    #[test]
    fn only_chosen_methods_take_part() {
        let only = |name| plan(Extent::Whole, &[], &[find(name).expect("listed")]);
        let certified = only("fbvh-certified");
        let all = certified.iter().flat_map(|planned| &planned.configurations);
        assert!(all.clone().count() > 20);
        assert!(all.into_iter().all(|of| of.method.name == "fbvh-certified"));
        // Growth is not measured of this one.
        assert!(only("illes-exact").iter().all(|planned| planned.purpose == Purpose::Error));
    }
}
