//! What Gourmel et al. 2010 print in section 6: frames a second at 640 × 480 on a GeForce GTX 280.

use super::paper_scene::PaperScene;
use super::tree_variant::TreeVariant;

/// A table of frame rates. The first row of each scene is what its other rows are compared with.
#[derive(Debug)]
pub struct Printed {
    /// How the paper calls it.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// Its rows.
    pub rows: &'static [Rate],
}

/// A row of such a table.
#[derive(Debug)]
pub struct Rate {
    /// The scene.
    pub scene: PaperScene,
    /// The structure.
    pub variant: TreeVariant,
    /// Milliseconds to build it, where printed.
    pub build_ms: Option<f64>,
    /// Frames a second: least and most, where printed.
    pub extremes: Option<(f64, f64)>,
    /// Frames a second on average.
    pub fps: f64,
}

/// A row of table 3.
#[derive(Debug)]
pub struct Counts {
    /// The structure.
    pub variant: TreeVariant,
    /// Node traversals a ray.
    pub nodes: f64,
    /// Intersection tests a ray.
    pub leaf_tests: f64,
    /// Balls considered a ray.
    pub balls: f64,
}

use PaperScene::{Molecule, Pool, Scattered30k, Scattered100k, Tornado4k, Tornado128k};
use TreeVariant::{Cut, Discarding, Fitted, Linear, Modified, Plain, Tighter};

const fn full(
    scene: PaperScene,
    variant: TreeVariant,
    build_ms: f64,
    extremes: (f64, f64),
    fps: f64,
) -> Rate {
    Rate { scene, variant, build_ms: Some(build_ms), extremes: Some(extremes), fps }
}

const fn built(scene: PaperScene, variant: TreeVariant, build_ms: f64, fps: f64) -> Rate {
    Rate { scene, variant, build_ms: Some(build_ms), extremes: None, fps }
}

const fn rate(scene: PaperScene, variant: TreeVariant, fps: f64) -> Rate {
    Rate { scene, variant, build_ms: None, extremes: None, fps }
}

/// Tables 1, 4 and 5, and the two heuristics.
pub const PRINTED: &[Printed] = &[
    Printed {
        name: "Table 1",
        title: "Modified BVH and Fitted BVH",
        rows: &[
            full(Scattered30k, Modified, 101.0, (4.6, 12.4), 7.4),
            full(Scattered30k, Fitted, 79.0, (4.9, 12.5), 9.4),
            full(Scattered100k, Modified, 160.0, (1.8, 3.9), 3.3),
            full(Scattered100k, Fitted, 150.0, (2.3, 9.1), 4.3),
            full(Tornado4k, Modified, 8.0, (3.6, 5.4), 4.6),
            full(Tornado4k, Fitted, 5.5, (4.0, 14.5), 11.0),
            full(Tornado128k, Modified, 500.0, (0.6, 1.1), 1.0),
            full(Tornado128k, Fitted, 290.0, (1.9, 2.6), 2.4),
            full(Molecule, Modified, 8.9, (3.2, 8.6), 5.8),
            full(Molecule, Fitted, 9.9, (7.5, 24.1), 17.7),
            full(Pool, Modified, 41.0, (1.5, 2.3), 1.9),
            full(Pool, Fitted, 40.0, (4.1, 11.0), 7.1),
        ],
    },
    Printed {
        name: "Table 4",
        title: "Fitting the boxes after a split, without the optimizations of table 5",
        rows: &[
            built(Molecule, Cut, 8.7, 12.7),
            built(Molecule, Plain, 9.2, 14.6),
            built(Pool, Cut, 35.0, 3.2),
            built(Pool, Plain, 37.0, 6.5),
        ],
    },
    Printed {
        name: "Table 5",
        title: "Tighter boxes and discarded split balls",
        rows: &[
            rate(Molecule, Plain, 14.6),
            rate(Molecule, Tighter, 15.3),
            rate(Molecule, Discarding, 16.7),
            rate(Molecule, Fitted, 17.7),
            rate(Pool, Plain, 6.5),
            rate(Pool, Tighter, 6.7),
            rate(Pool, Discarding, 6.8),
            rate(Pool, Fitted, 7.1),
        ],
    },
    Printed {
        name: "Section 6, heuristics",
        title: "Leaf cost n against n²",
        rows: &[rate(Pool, Linear, 5.1), rate(Pool, Fitted, 7.1)],
    },
];

/// Table 3: means a ray on the tornado. The paper does not say which; here it is the small one.
pub const COUNTED: [Counts; 2] = [
    Counts { variant: Modified, nodes: 9.3, leaf_tests: 1.2, balls: 83.5 },
    Counts { variant: Fitted, nodes: 6.2, leaf_tests: 0.5, balls: 35.1 },
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's text repeats some of its numbers: table 4's right is table 5's left, table 5's
    /// right is table 1's average.
    #[test]
    fn tables_agree_with_each_other() {
        let fps = |name, scene, variant| {
            let table = PRINTED.iter().find(|table| table.name == name).expect("printed");
            let row = table.rows.iter().find(|row| row.scene == scene && row.variant == variant);
            row.expect("printed").fps
        };
        for scene in [Molecule, Pool] {
            assert_eq!(fps("Table 4", scene, Plain), fps("Table 5", scene, Plain));
            assert_eq!(fps("Table 5", scene, Fitted), fps("Table 1", scene, Fitted));
        }
        assert_eq!(fps("Section 6, heuristics", Pool, Fitted), fps("Table 1", Pool, Fitted));
    }
}
