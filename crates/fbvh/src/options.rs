//! Which structure to build, and how.

use glam::Vec3A;

use crate::MAX_DEPTH;

/// The two structures of the paper, and the certified tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Section 4: boxes around own balls, which overlap; a leaf projects its own balls only, and a
    /// ray continues until no nearer leaf is left.
    ModifiedBvh,
    /// Section 5: boxes that do not overlap; a leaf projects all its balls, and the first hit ends
    /// the ray.
    Fitted,
    /// Not in the paper: boxes that do not overlap, in each of which the field may cross T or is above
    /// T throughout; a leaf is searched by bounds, and every answer is right or undecided.
    Certified,
}

impl Kind {
    /// Stable name in tables and on command lines: `bvh`, `fbvh`, `fbvh-certified`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ModifiedBvh => "bvh",
            Self::Fitted => "fbvh",
            Self::Certified => "fbvh-certified",
        }
    }

    /// Where it was published.
    pub const fn source(self) -> &'static str {
        match self {
            Self::ModifiedBvh => "Gourmel et al. 2010, section 4",
            Self::Fitted => "Gourmel et al. 2010, section 5",
            Self::Certified => "not published: exact ranges instead of the paper's assumption",
        }
    }

    /// Whether the paper has it, whose leaves are searched by its section 3.
    pub(crate) const fn is_published(self) -> bool {
        matches!(self, Self::ModifiedBvh | Self::Fitted)
    }
}

/// The structure to build, with the options that it alone has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Structure {
    /// Section 4, algorithm 1.
    ModifiedBvh,
    /// Section 5, algorithm 2.
    Fitted(Fitting),
    /// Not in the paper: boxes classified by exact ranges of the field, as empty, solid or a leaf.
    Certified(Classes),
}

/// When a box that may hold surface is a leaf of the certified tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Classes {
    /// Boxes reached by at most this many balls are not divided further; nor are those of at most twice
    /// as many where a cut would leave most of them on both sides.
    pub leaf_size: u32,
    /// Nor are boxes whose longest side is below this part of their balls' radius, the mean weighted by
    /// the most that each ball adds in the box. Where n balls reach a box, n more than three times
    /// `leaf_size`, that part is divided by the cube root of n / `leaf_size`.
    pub smallest_side: f32,
}

/// How the nodes of a Fitted BVH are cut down to what they must hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitting {
    /// How the boxes are fitted.
    pub boxes: Boxes,
    /// Section 5.3.2: split balls that cannot take part in a surface inside the box are discarded
    /// in nodes of at most this many balls; 0 discards nothing. The test is quadratic: the paper's
    /// section 6 advises to skip it in nodes of more than a dozen.
    pub discard_up_to: u32,
}

/// How a node's box, cut from its parent's by the splitting plane, is fitted to its balls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Boxes {
    /// Not at all: table 4, left.
    Cut,
    /// To the support spheres: section 5.1.2; table 4, right.
    Support,
    /// To spheres of radius min(Rᵢ, `r_max`), `r_max` = R·k⁻¹(T/Σq) with the largest radius R of the
    /// node's balls: section 5.3.1, with T/Σq for the printed T/n, which strengths above 1 break.
    PerNode,
    /// To spheres of radius Rᵢ·k⁻¹(T/Σq): the same bound for each ball. Not in the paper; never
    /// looser than [`Boxes::PerNode`].
    PerBall,
}

/// The estimated cost of searching a leaf of n balls, in units of one ball's share of one evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cost {
    /// n: the standard heuristic.
    Linear,
    /// n² + λn: section 5.1.1. The square is the search for the bracket, which evaluates n balls at
    /// n projections; the rest is the secant search.
    Quadratic {
        /// λ. The paper sets 0.
        lambda: f32,
    },
}

impl Cost {
    /// The cost of a leaf of so many balls.
    pub(crate) fn of(self, balls: f32) -> f32 {
        match self {
            Self::Linear => balls,
            Self::Quadratic { lambda } => balls * (balls + lambda),
        }
    }

    /// The costs of three leaves.
    #[inline]
    pub(crate) fn of_each(self, balls: Vec3A) -> Vec3A {
        match self {
            Self::Linear => balls,
            Self::Quadratic { lambda } => balls * (balls + lambda),
        }
    }
}

/// How to build a tree. Start from [`Options::certified`], [`Options::fitted`] or
/// [`Options::modified_bvh`].
///
/// Of these, a certified tree has only [`bins`](Options::bins) and [`max_depth`](Options::max_depth):
/// its cost is the number of balls, and its leaves are as [`Classes`] says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The structure.
    pub structure: Structure,
    /// The cost of a leaf in the surface area heuristic. n counts own and split balls in the Fitted BVH,
    /// own balls in the modified BVH.
    pub cost: Cost,
    /// The cost of a step of the traversal, in the unit of [`Options::cost`]. A node is split only
    /// where that is cheaper than a leaf.
    pub traversal_cost: f32,
    /// Bins a node is divided into along each axis to find the best plane (Wald 2007). From 2 to 16.
    pub bins: u32,
    /// Section 7: nodes of more balls than this are halved along their longest axis, without
    /// binning. `u32::MAX` bins them all.
    pub halve_above: u32,
    /// Nodes of at most this many balls are not split further.
    pub leaf_size: u32,
    /// Levels of interior nodes, at most [`MAX_DEPTH`]. From level 32 on planes go through the middle
    /// ball; what is left at the last level is a leaf, however large.
    pub max_depth: usize,
}

impl Options {
    /// The modified BVH of section 4: standard heuristic, 16 bins.
    pub const fn modified_bvh() -> Self {
        Self {
            structure: Structure::ModifiedBvh,
            cost: Cost::Linear,
            traversal_cost: 1.0,
            bins: 16,
            halve_above: u32::MAX,
            leaf_size: 1,
            max_depth: MAX_DEPTH,
        }
    }

    /// The Fitted BVH with everything that the paper's section 5 has: cost n², fitted boxes, tighter
    /// radii per node, discarding in nodes of up to a dozen balls; 16 bins.
    ///
    /// A traversal step costs 24: on scattered and on dense balls, rays on the CPU take the same time
    /// for 4 to 24 within a tenth, and a tree for 4 takes three times as long to build.
    pub const fn fitted() -> Self {
        Self {
            structure: Structure::Fitted(Fitting { boxes: Boxes::PerNode, discard_up_to: 12 }),
            cost: Cost::Quadratic { lambda: 0.0 },
            traversal_cost: 24.0,
            ..Self::modified_bvh()
        }
    }

    /// The certified tree, for which no ray's answer is wrong: leaves of up to 16 balls, or sides of 0.7
    /// radii.
    pub const fn certified() -> Self {
        Self {
            structure: Structure::Certified(Classes { leaf_size: 16, smallest_side: 0.7 }),
            ..Self::modified_bvh()
        }
    }

    /// The kind of tree that these options build.
    pub const fn kind(&self) -> Kind {
        match self.structure {
            Structure::ModifiedBvh => Kind::ModifiedBvh,
            Structure::Fitted(_) => Kind::Fitted,
            Structure::Certified(_) => Kind::Certified,
        }
    }
}
