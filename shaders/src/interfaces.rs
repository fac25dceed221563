//! The table of interfaces: what the files of a folder have in common.

/// A folder below `wgsl/` in which every file declares the same: others import the folder, and a
/// [`Variant`](crate::Variant) chooses the file.
#[derive(Debug, Clone, Copy)]
pub struct Interface {
    /// The folder, such as `fbvh/leaf`.
    pub folder: &'static str,
    /// What it is about.
    pub purpose: &'static str,
    /// What every file in it declares: WGSL without bodies and values, each line with its meaning
    /// above it.
    pub declarations: &'static str,
}

impl Interface {
    /// The declarations without their comments, one each.
    pub fn declared(&self) -> impl Iterator<Item = &'static str> {
        let lines = self.declarations.lines().map(str::trim);
        lines.filter(|line| !line.is_empty() && !line.starts_with("//"))
    }
}

/// Every interface. A new one is an entry here, and a folder.
pub const INTERFACES: &[Interface] = &[
    Interface {
        folder: "kernel",
        purpose: "A ball's kernel k, by the depth v = 1 - r^2/R^2 below the rim of its support.",
        declarations: "
            // Zero for v <= 0.
            fn kernel(v: f32) -> f32
            // Derivative by v; zero for v <= 0.
            fn kernel_slope(v: f32) -> f32
            // |d2k/dt2| R^2 along any line is nowhere more.
            fn greatest_bend() -> f32
            // The greatest slope between two values of v.
            fn steepest_slope(least: f32, most: f32) -> f32
            // For an exact v, `kernel` and `kernel_slope` err by so many units in the last place of themselves
            // more than eight products do.
            fn kernel_roundings() -> u32
        ",
    },
    Interface {
        folder: "exponent",
        purpose: "The exponent alpha of a power kernel, from 1 to 8.",
        declarations: "
            fn exponent() -> u32
        ",
    },
    Interface {
        folder: "support",
        purpose: "Where a ball's field may be positive.",
        declarations: "
            fn support_of(ball: u32) -> Support
        ",
    },
    Interface {
        folder: "strength",
        purpose: "What a ball's kernel is multiplied by.",
        declarations: "
            fn strength(ball: u32) -> f32
        ",
    },
    Interface {
        folder: "color",
        purpose: "The colour of a hit: each ball's by its share of the field.",
        declarations: "
            fn blend_start()
            // `weight` is what the ball adds to the field at the hit.
            fn blend_add(ball: u32, weight: f32)
            fn blend_write(pixel: u32)
        ",
    },
    Interface {
        folder: "work",
        purpose: "Counters of what a pixel costs.",
        declarations: "
            // A node of a tree.
            fn count_node()
            // Through an interior node, to one of its children.
            fn go_down()
            // A child of the node that was last gone through is left for later, in a slot of a stack.
            fn leave_for_later(slot: u32)
            fn come_back_to(slot: u32)
            // A test of a leaf, layer or interval.
            fn count_leaf_test()
            fn count_balls(n: u32)
            // Evaluations of one ball's kernel.
            fn count_evaluations(n: u32)
            // Steps of a root finder.
            fn count_iterations(n: u32)
            // The iterations to come belong to another search.
            fn count_search_end()
            // Peeled layers, or entries of a list.
            fn count_layers(n: u32)
            // Adds what was counted to the pixel's record; once an invocation.
            fn write_work(pixel: u32)
        ",
    },
    Interface {
        folder: "opaque",
        purpose: "The solid scene in front of the balls, if any: no ray continues beyond it.",
        declarations: "
            // Distance along the pixel's ray; NO_LIMIT for nothing.
            fn opaque_distance(pixel: u32) -> f32
        ",
    },
    Interface {
        folder: "ray",
        purpose: "The rays that a pass traces, for methods that trace more than primary rays.",
        declarations: "
            // The pixel whose ray an invocation of a workgroup of 64 traces, or NO_PIXEL.
            fn pixel_of(group: vec3<u32>, index: u32) -> u32
            fn ray_of(pixel: u32) -> Ray
            // Whether anything solid on the ray answers it, first or not.
            fn any_hit_suffices() -> bool
            // Whether secondary rays may start at the hit, so that its clearance is needed.
            fn needs_clearance() -> bool
        ",
    },
    Interface {
        folder: "shade/base",
        purpose: "The surface's own colour, in linear light.",
        declarations: "
            fn base_color(pixel: u32) -> vec3<f32>
        ",
    },
    Interface {
        folder: "light/environment",
        purpose: "The surroundings, in linear light. The second axis points to the zenith.",
        declarations: "
            // What is seen in a direction.
            fn environment(direction: vec3<f32>) -> vec3<f32>
            // Mean light from above a surface, as its normal weighs it.
            fn ambient(normal: vec3<f32>) -> vec3<f32>
        ",
    },
    Interface {
        folder: "fbvh/leaf",
        purpose: "The search of one leaf of a tree.",
        declarations: "
            // Whether no leaf behind one with a hit holds a nearer one.
            fn first_hit_ends() -> bool
            // Whether rays start in the solid and look for the exit from it.
            fn seeks_exit() -> bool
            // The state of a search, kept while a ray is suspended: 28 bytes.
            struct Search
            var<private> search: Search
            // Prepares the search of another leaf; the first needs a cleared state alone.
            fn reset()
            // Starts or resumes the search of a leaf. Returns a fbvh::leaf_outcome.
            fn search_leaf(ray: Ray, inverse: vec3<f32>, index: u32) -> u32
            // Distance and status of the hit that was FOUND; AT_FACE, the distance alone.
            fn hit_t() -> f32
            fn hit_status() -> u32
            // Whether the search ended BRACKETED.
            fn is_bracketed() -> bool
            // Closes in on the root in the bracket: FOUND or WAITING. Apart from the search, so that rays
            // side by side, which reach their hits in different leaves, do it at the same time.
            fn close_in(ray: Ray, inverse: vec3<f32>, index: u32) -> u32
            // Brackets the exit in a leaf that the ray certainly leaves the solid in, at its far face if
            // nowhere before. False where the budget is spent.
            fn bracket_exit(ray: Ray, inverse: vec3<f32>, index: u32) -> bool
            // What an early end of a search can leave of F - T at a hit.
            fn residual() -> f32
            // By how much rounding can move a ball's v = 1 - r^2/R^2 at a hit.
            fn depth_error(leaf: Leaf, ray: Ray, t: f32, offset: vec3<f32>, radius: f32) -> f32
        ",
    },
    Interface {
        folder: "fbvh/excess",
        purpose: "Exact ranges of the excess whose rise to 0 a certified search looks for: F - T at an \
                  entry into the solid, T - F at an exit.",
        declarations: "
            // The excess is this times F - T.
            const SIGN: f32
            // Whether a box in which the field is above T throughout answers the search.
            const SOLID_ANSWERS: bool
            // Whether the excess stays below 0 where the field is nowhere more than this.
            fn stays_below(most: f32) -> bool
            // Where on an interval a ball adds most to the excess, of its depths there.
            fn depth_of_most(v: Depths) -> f32
            // Which of the signed distances from a ball's projection to the interval's ends bounds its
            // share of the excess's slope from below, as `least_product` takes it.
            fn way_of_least_slope(to_start: f32, to_end: f32) -> f32
            // What the excess is at most and at least where the field is, but for this relative error,
            // between the two.
            fn upper_bound(least: f32, most: f32, error: f32) -> f32
            fn lower_bound(least: f32, most: f32, error: f32) -> f32
        ",
    },
    Interface {
        folder: "fbvh/polynomial_test",
        purpose: "A test of an interval of a ray in a leaf by a polynomial, which decides most leaves in \
                  fewer walks along the list than ranges do; what it leaves uncertain, ranges decide.",
        declarations: "
            // So many tests of a leaf, before ranges are tried.
            const MOST_TESTS: u32
            // By one walk along the balls near.
            fn polynomial_test(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> TestResult
        ",
    },
    Interface {
        folder: "illes_fraglist/array_size",
        purpose: "The size of a ray's local arrays: WGSL has no private arrays of overridable size.",
        declarations: "
            // Separators of three a ball.
            const ARRAY_SIZE: u32
        ",
    },
    Interface {
        folder: "illes_fraglist/piece",
        purpose: "The field between two separators as a polynomial.",
        declarations: "
            // What a separator changes.
            struct Change
            // That of each separator of a ball: `enter`, `middle`, `leave`.
            struct Changes
            fn changes_of(rank: u32, segment: Segment, radius: f32) -> Changes
            fn pass_separator(change: Change, direction: vec3<f32>)
            // The first point in [start, end] where the field reaches the threshold, or NO_ROOT. No
            // separator lies between the two.
            fn first_root(start: f32, end: f32) -> f32
            // What a ray that waits must keep beside its list and its position.
            fn kept_sum() -> vec4<f32>
            // Sets it, after all separators up to the position are passed again.
            fn restore_sum(sum: vec4<f32>)
            // Whether a ray at a position can wait, with this the next separator to pass.
            fn can_wait_before(at: f32, position: f32) -> bool
        ",
    },
    Interface {
        folder: "illes_fraglist/overlap",
        purpose: "What becomes of a ray with more separators than the local array has capacity for.",
        declarations: "
            // Whether a ray can be searched without the array.
            fn can_search() -> bool
            // Searches from the position to the limit, at first in an interval of a width, scene units; 0: as
            // long as the first ball's radius. Returns the first root; or NO_ROOT, with the position as far
            // as was searched: short of the limit where the budget is spent, to be resumed with the width
            // that is left.
            fn search_without_array(head: u32, direction: vec3<f32>, limit: f32, \
                                    position: ptr<function, f32>, width: ptr<function, f32>) -> f32
        ",
    },
    Interface {
        folder: "kanamori_peel/outline",
        purpose: "What is rasterised for a ball, to cover its support.",
        declarations: "
            // Vertices of a ball.
            const VERTICES: u32
            // Clip position of a vertex, counted from 0.
            fn outline(vertex: u32, placed: Placed, to_center: vec3<f32>, radius: f32) -> vec4<f32>
        ",
    },
    Interface {
        folder: "kanamori_peel/bernstein",
        purpose: "A ball's field along its chord in Bernstein form (appendix A).",
        declarations: "
            // Coefficients `d`, one more than the degree.
            struct Curve
            fn degree() -> u32
            // `a` is Q^2/R^2: half the chord over the radius, squared.
            fn along_chord(a: f32, strength: f32) -> Curve
        ",
    },
    Interface {
        folder: "kanamori_peel/longest",
        purpose: "The longest list of active balls that the targets of a ray hold (section 4.2).",
        declarations: "
            const LONGEST: u32
        ",
    },
    Interface {
        folder: "kanamori_peel/clipping",
        purpose: "The root of a curve by Bézier clipping.",
        declarations: "
            // The first point of [0, 1] at which a curve is not negative; NO_ROOT, or LOST.
            fn first_root(whole: Curve) -> f32
        ",
    },
];
