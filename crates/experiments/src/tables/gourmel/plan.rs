//! Which structures are measured on which scenes.

use std::collections::{BTreeMap, BTreeSet};

use super::paper::{COUNTED, PRINTED};
use super::paper_scene::PaperScene;
use super::tree_variant::TreeVariant;
use crate::extent::Extent;

/// A line in a plot: frame time over a quantity.
#[derive(Debug, Clone)]
pub struct Series {
    /// What it shows.
    pub title: &'static str,
    /// Name of the horizontal axis.
    pub axis: &'static str,
    /// Which quantity of a run is on the horizontal axis.
    pub quantity: Quantity,
    /// Scene and variant of each point.
    pub points: Vec<(String, TreeVariant)>,
}

/// What a plot's horizontal axis counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Balls of the scene.
    Balls,
    /// Levels of the tree that was built.
    Depth,
    /// Split balls of a leaf, the mean.
    Split,
}

/// Between what to load and the factor on its supports, in the name of such a scene.
const SCALED: &str = " × ";

/// The name of the molecule with a factor on its balls' supports.
pub fn scaled_molecule(factor: f32) -> String {
    if factor == 1.0 { "molecule".to_owned() } else { format!("molecule{SCALED}{factor}") }
}

/// What to load for the name of a scene, and the factor on its supports.
pub fn subject(name: &str) -> (&str, f32) {
    let scaled = name.split_once(SCALED);
    scaled.and_then(|(spec, factor)| Some((spec, factor.parse().ok()?))).unwrap_or((name, 1.0))
}

/// The plots of Forcier and Wang's implementation (2017), which has a tornado too: time over the
/// number of balls, over the depth of the tree, and over split balls.
pub fn series(extent: Extent) -> Vec<Series> {
    let (counts, levels, dense, densities): (&[u32], &[usize], u32, &[u32]) = match extent {
        Extent::Whole => {
            (&[1000, 2000, 4000, 8000, 16_000], &[8, 9, 10, 12, 16], 2000, &[5, 10, 20, 40])
        }
        Extent::Quick => (&[100, 200], &[2, 4], 100, &[5, 10]),
    };
    let over_balls = |title, variant| Series {
        title,
        axis: "balls",
        quantity: Quantity::Balls,
        points: counts.iter().map(|count| (format!("tornado:{count}"), variant)).collect(),
    };
    let tornado = PaperScene::Tornado4k.spec(extent);
    vec![
        over_balls("Number of balls, modified BVH", TreeVariant::Modified),
        over_balls("Number of balls, Fitted BVH", TreeVariant::Fitted),
        Series {
            title: "Depth of the tree",
            axis: "levels",
            quantity: Quantity::Depth,
            points: levels
                .iter()
                .map(|&most| (tornado.to_owned(), TreeVariant::Levels(most)))
                .collect(),
        },
        Series {
            title: "Split balls, by the scene's density",
            axis: "split balls a leaf",
            quantity: Quantity::Split,
            points: densities
                .iter()
                .map(|density| (format!("tornado:{dense}:{density}"), TreeVariant::Fitted))
                .collect(),
        },
    ]
}

/// Factors on the supports of the molecule's balls that make it sparser and denser, rising.
pub fn support_factors(extent: Extent) -> &'static [f32] {
    match extent {
        Extent::Whole => &[0.6, 0.8, 1.0, 1.25, 1.6],
        Extent::Quick => &[0.8, 1.0],
    }
}

/// Everything that the tables and plots need, each once: variants by scene.
pub fn measurements(extent: Extent) -> BTreeMap<String, BTreeSet<TreeVariant>> {
    let rates = PRINTED.iter().flat_map(|table| table.rows);
    let rates = rates.map(|row| (row.scene.spec(extent).to_owned(), row.variant));
    let counted = COUNTED.iter().map(|row| row.variant);
    let counted = counted.map(|variant| (PaperScene::Tornado4k.spec(extent).to_owned(), variant));
    let points = series(extent).into_iter().flat_map(|series| series.points);
    let mut measurements = BTreeMap::<_, BTreeSet<_>>::new();
    let sizes = support_factors(extent).iter().map(|&factor| scaled_molecule(factor));
    let scaled = sizes.flat_map(|spec| {
        [TreeVariant::Modified, TreeVariant::Fitted].map(|variant| (spec.clone(), variant))
    });
    for (spec, variant) in rates.chain(counted).chain(points).chain(scaled) {
        measurements.entry(spec).or_default().insert(variant);
    }
    measurements
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_how_supports_are_scaled() {
        assert_eq!(subject(&scaled_molecule(1.25)), ("molecule", 1.25));
        assert_eq!(subject(&scaled_molecule(1.0)), ("molecule", 1.0));
        assert_eq!(subject("tornado:100:5"), ("tornado:100:5", 1.0));
    }
}
