//! The only list of methods.

use fbvh::gpu::Renderer;
use fbvh::{Options, TraceOptions};
use illes_fraglist::{Gather, Piece};
use metaball_core::gpu::IsoRenderer;

/// A method that can be compared.
#[derive(Debug)]
pub struct Method {
    /// Stable name on the command line, in records and in file names.
    pub name: &'static str,
    /// Name in headings.
    pub title: &'static str,
    /// Where it was published.
    pub paper: &'static str,
    /// What it does, one sentence.
    pub about: &'static str,
    /// Makes a renderer that counts its work or, as when timing, does not.
    pub make: fn(counting: bool) -> Box<dyn IsoRenderer>,
}

/// What is compared unless other methods are named: the published ones, and the one that is never
/// wrong.
pub const HEADLINERS: &[&str] = &["bvh", "fbvh", "fbvh-certified", "kanamori", "illes"];

/// All methods, in the order of tables.
pub const METHODS: &[Method] = &[
    Method {
        name: "bvh",
        title: "Modified BVH",
        paper: "Gourmel et al. 2010, section 4",
        about: "A hierarchy whose leaves own their balls and name all others that reach in; boxes \
                overlap, and a ray goes on until no nearer leaf is left.",
        make: |counting| bvh("bvh", Options::modified_bvh(), counting),
    },
    Method {
        name: "fbvh",
        title: "Fitted BVH",
        paper: "Gourmel et al. 2010, section 5",
        about: "Balls are split among leaves whose fitted boxes do not overlap; the first hit ends \
                the ray.",
        make: |counting| bvh("fbvh", Options::fitted(), counting),
    },
    Method {
        name: "fbvh-certified",
        title: "Certified FBVH",
        paper: "not published: exact ranges in the place of the paper's assumption",
        about: "Boxes in which the field stays below or above the threshold are dropped or solid; \
                the others are searched by exact bounds, so that no answer is wrong.",
        make: |counting| bvh("fbvh-certified", Options::certified(), counting),
    },
    Method {
        name: "kanamori",
        title: "Depth peeling",
        paper: "Kanamori et al. 2008",
        about: "Supports are drawn as rectangles and peeled layer by layer; each ray keeps a list of \
                the balls it is in and searches every interval by Bézier clipping.",
        make: |counting| {
            let options = kanamori_peel::Options::default();
            Box::new(kanamori_peel::Renderer::new("kanamori", options, counting))
        },
    },
    Method {
        name: "kanamori-robust",
        title: "Tiles, searched",
        paper: "not published: the peeling of Kanamori et al. 2008 replaced by a search",
        about: "Balls are registered with tiles of the picture; each ray searches its tile's list by \
                intervals with exact bounds, so that neither coincident points nor crowds matter.",
        make: |counting| {
            Box::new(kanamori_peel::robust::Renderer::new("kanamori-robust", counting))
        },
    },
    Method {
        name: "illes",
        title: "Fragment lists",
        paper: "Illés and Szécsi, Efficient GPU Fluid Visualization",
        about: "Each pixel gathers a list of the balls along its ray; between the ends and midpoints \
                of their chords the field is approximated by a cubic.",
        make: |counting| fragment_lists("illes", Piece::Cubic, counting),
    },
    Method {
        name: "illes-absolute",
        title: "Fragment lists, printed basis",
        paper: "Illés and Szécsi, Efficient GPU Fluid Visualization, section 4",
        about: "The same with the cubic as printed, a running sum in powers of the distance, which \
                loses its digits away from the eye.",
        make: |counting| fragment_lists("illes-absolute", Piece::AbsoluteCubic, counting),
    },
    Method {
        name: "illes-exact",
        title: "Fragment lists, exact polynomials",
        paper: "Illés and Szécsi, Efficient GPU Fluid Visualization, section 3",
        about: "The same with the field's own polynomial, of degree four or six, in place of the \
                cubic.",
        make: |counting| fragment_lists("illes-exact", Piece::Exact, counting),
    },
    Method {
        name: "illes-robust",
        title: "Fragment lists, robust",
        paper: "not published: exact polynomials, and no ray that too many balls overlap on is wrong",
        about: "The same as with exact polynomials; a ray with more separators than its array holds \
                is searched without it.",
        make: |counting| fragment_lists("illes-robust", Piece::Robust, counting),
    },
    Method {
        name: "illes-compute",
        title: "Fragment lists, gathered in compute",
        paper: "not published: the same cubics without a rasteriser",
        about: "Balls are sorted into tiles of the picture, and tiles into the lists of pixels, by \
                compute passes; the same cast.",
        make: |counting| {
            let options = illes_fraglist::Options { gather: Gather::Tiles, ..Default::default() };
            Box::new(illes_fraglist::Renderer::new("illes-compute", options, counting))
        },
    },
];

fn fragment_lists(name: &'static str, piece: Piece, counting: bool) -> Box<dyn IsoRenderer> {
    let options = illes_fraglist::Options { piece, ..illes_fraglist::Options::default() };
    Box::new(illes_fraglist::Renderer::new(name, options, counting))
}

fn bvh(name: &'static str, options: Options, counting: bool) -> Box<dyn IsoRenderer> {
    Box::new(Renderer::new(name, options, TraceOptions::default(), counting))
}

/// The tree that a method traces, for those that the CPU traces too.
pub fn tree_options(method: &str) -> Option<Options> {
    match method {
        "bvh" => Some(Options::modified_bvh()),
        "fbvh" => Some(Options::fitted()),
        "fbvh-certified" => Some(Options::certified()),
        _ => None,
    }
}

/// The method of that name.
pub fn find(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_renderers_know_theirs() {
        for (index, method) in METHODS.iter().enumerate() {
            assert!(METHODS[..index].iter().all(|other| other.name != method.name));
            for counting in [false, true] {
                assert_eq!((method.make)(counting).name(), method.name);
            }
        }
        let traced_on_cpu = METHODS.iter().filter(|method| tree_options(method.name).is_some());
        assert_eq!(traced_on_cpu.count(), 3);
        assert!(find("fbvh").is_some() && find("no such method").is_none());
    }
}
