//! The structures that the tables compare.

use fbvh::{Boxes, Cost, Fitting, Options, Structure};

/// A structure with its options.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TreeVariant {
    /// Section 4.
    Modified,
    /// Section 5 with everything.
    Fitted,
    /// The same with the standard heuristic: a leaf of n balls costs n, and a traversal step what the
    /// modified BVH takes it to cost in that unit.
    Linear,
    /// Boxes cut by planes and not fitted; neither tighter boxes nor discarding.
    Cut,
    /// Boxes fitted to supports; neither tighter boxes nor discarding.
    Plain,
    /// Boxes fitted to reduced radii: section 5.3.1.
    Tighter,
    /// Boxes fitted to supports, and split balls discarded: section 5.3.2.
    Discarding,
    /// Section 5 with everything, to so many levels.
    Levels(usize),
}

impl TreeVariant {
    /// Its name in files and tables.
    pub fn name(self) -> String {
        match self {
            Self::Modified => "bvh".to_owned(),
            Self::Fitted => "fbvh".to_owned(),
            Self::Linear => "fbvh, cost n".to_owned(),
            Self::Cut => "fbvh, not fitted".to_owned(),
            Self::Plain => "fbvh, fitted only".to_owned(),
            Self::Tighter => "fbvh, tighter boxes".to_owned(),
            Self::Discarding => "fbvh, discarding".to_owned(),
            Self::Levels(levels) => format!("fbvh, {levels} levels"),
        }
    }

    /// What to build.
    pub fn options(self) -> Options {
        let fitted = Options::fitted();
        let with = |boxes, discard_up_to| Options {
            structure: Structure::Fitted(Fitting { boxes, discard_up_to }),
            ..fitted
        };
        match self {
            Self::Modified => Options::modified_bvh(),
            Self::Fitted => fitted,
            Self::Linear => Options {
                cost: Cost::Linear,
                traversal_cost: Options::modified_bvh().traversal_cost,
                ..fitted
            },
            Self::Cut => with(Boxes::Cut, 0),
            Self::Plain => with(Boxes::Support, 0),
            Self::Tighter => with(Boxes::PerNode, 0),
            Self::Discarding => match fitted.structure {
                Structure::Fitted(Fitting { discard_up_to, .. }) => {
                    with(Boxes::Support, discard_up_to)
                }
                _ => fitted,
            },
            Self::Levels(max_depth) => Options { max_depth, ..fitted },
        }
    }
}
