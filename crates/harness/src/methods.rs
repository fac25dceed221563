//! The only list of methods.

use std::sync::OnceLock;

use fbvh::{Kind, Options, SecantSearch};
use illes_fraglist::{Gather, Piece};
use kanamori_peel::CLIPPING_THRESHOLD;
use thiserror::Error;

use crate::renderer::Renderer;
use crate::technique::Technique;

/// A method that can be compared.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// Stable name on the command line, in records and in file names.
    pub name: &'static str,
    /// Name in headings.
    pub title: &'static str,
    /// Where it was published.
    pub paper: &'static str,
    /// What it does, one sentence.
    pub about: &'static str,
    /// What it does, from which all else that there is to know of it follows.
    pub technique: Technique,
}

/// What is compared unless other methods are named: the published ones, the one that is never wrong, and
/// those that need no adapter.
pub const HEADLINERS: &[&str] =
    &["bvh", "fbvh", "fbvh-certified", "fbvh-certified-cpu", "kanamori", "kanamori-cpu", "illes"];

/// The methods of this workspace, in the order of tables.
const METHODS: &[Method] = &[
    Method {
        name: Kind::ModifiedBvh.name(),
        title: "Modified BVH",
        paper: Kind::ModifiedBvh.source(),
        about: "A hierarchy whose leaves own their balls and name all others that reach in; boxes \
                overlap, and a ray continues until no nearer leaf is left.",
        technique: Technique::Tree(Options::modified_bvh(), Some(SecantSearch::DEFAULT)),
    },
    Method {
        name: Kind::Fitted.name(),
        title: "Fitted BVH",
        paper: Kind::Fitted.source(),
        about: "Balls are split among leaves whose fitted boxes do not overlap; the first hit ends \
                the ray.",
        technique: Technique::Tree(Options::fitted(), Some(SecantSearch::DEFAULT)),
    },
    Method {
        name: Kind::Certified.name(),
        title: "Certified FBVH",
        paper: Kind::Certified.source(),
        about: "Boxes in which the field stays below or above the threshold are dropped or solid; \
                the others are searched by exact bounds, so that no answer is wrong.",
        technique: Technique::Tree(Options::certified(), None),
    },
    Method {
        name: "fbvh-certified-cpu",
        title: "Certified FBVH on the CPU",
        paper: Kind::Certified.source(),
        about: "The same tree, traced on the CPU's threads in packets of eight rays, and searched in f64 \
                where f32 cannot tell; needs no adapter.",
        technique: Technique::TreeOnHost(Options::certified(), None),
    },
    Method {
        name: "kanamori",
        title: "Depth peeling",
        paper: "Kanamori et al. 2008",
        about: "Supports are drawn as rectangles and peeled layer by layer; each ray keeps a list of \
                the balls it is in and searches every interval by Bézier clipping.",
        technique: Technique::Peeling(kanamori_peel::Options::PUBLISHED),
    },
    Method {
        name: "kanamori-cpu",
        title: "Bézier clipping on the CPU",
        paper: "Kanamori et al. 2008, section 6; Nishita and Nakamae 1994",
        about: "A hierarchy of supports on the CPU's threads; the intervals between a ray's sorted points \
                are searched by Bézier clipping; needs no adapter.",
        technique: Technique::Baseline { threshold: CLIPPING_THRESHOLD },
    },
    Method {
        name: "kanamori-robust",
        title: "Tiles, searched",
        paper: "not published: the peeling of Kanamori et al. 2008 replaced by a search",
        about: "Balls are registered with tiles of the picture; each ray searches its tile's list by \
                intervals with exact bounds, so that neither coincident points nor overlap matters.",
        technique: Technique::TileSearch,
    },
    Method {
        name: "illes",
        title: "Fragment lists",
        paper: "Illés and Szécsi, Efficient GPU Fluid Visualization",
        about: "Each pixel gathers a list of the balls along its ray; between the ends and midpoints \
                of their chords the field is approximated by a cubic, a running sum in powers of the \
                distance, which loses its digits away from the eye.",
        technique: fragment_lists(Piece::Running),
    },
    Method {
        name: "illes-rebuilt",
        title: "Fragment lists, rebuilt cubics",
        paper: "not published: the same cubics without a running sum",
        about: "The same with each cubic made anew from the balls that are active between two points, \
                right to rounding at any distance.",
        technique: fragment_lists(Piece::Rebuilt),
    },
    Method {
        name: "illes-exact",
        title: "Fragment lists, exact polynomials",
        paper: "Illés and Szécsi, Efficient GPU Fluid Visualization, section 3",
        about: "The same with the field's own polynomial, of degree four or six, instead of the \
                cubic.",
        technique: fragment_lists(Piece::Exact),
    },
    Method {
        name: "illes-robust",
        title: "Fragment lists, robust",
        paper: "not published: exact polynomials, and no ray that too many balls overlap on is wrong",
        about: "The same as with exact polynomials; a ray with more separators than its array holds \
                is searched without it.",
        technique: fragment_lists(Piece::Robust),
    },
    Method {
        name: "illes-compute",
        title: "Fragment lists, gathered in compute",
        paper: "not published: the same cubics without a rasteriser",
        about: "Balls are sorted into tiles of the picture, and tiles into the lists of pixels, by \
                compute passes; the same cast.",
        technique: Technique::Fragments(illes_fraglist::Options {
            gather: Gather::Tiles,
            ..illes_fraglist::Options::PUBLISHED
        }),
    },
];

const fn fragment_lists(piece: Piece) -> Technique {
    let published = illes_fraglist::Options::PUBLISHED;
    Technique::Fragments(illes_fraglist::Options { piece, ..published })
}

/// All methods, from the first use of the list or the first addition to it.
static ALL: OnceLock<Vec<Method>> = OnceLock::new();

/// All methods: those of this workspace, in the order of tables, then those that were
/// [added](add_methods).
pub fn methods() -> &'static [Method] {
    ALL.get_or_init(|| METHODS.to_vec())
}

/// Why methods were not added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AddError {
    /// Two methods have one name.
    #[error("method {name}: needed a name of its own, found another method of that name")]
    Name {
        /// The name.
        name: &'static str,
    },
    /// The list is in use already.
    #[error("methods: needed to be added once, before the first use of the list")]
    Late,
}

/// Adds methods of another crate to the list, before its first use.
///
/// # Errors
/// When a name is taken, or the list was used or added to before.
pub fn add_methods(own: impl IntoIterator<Item = Method>) -> Result<(), AddError> {
    let mut all = METHODS.to_vec();
    for method in own {
        if all.iter().any(|other| other.name == method.name) {
            return Err(AddError::Name { name: method.name });
        }
        all.push(method);
    }
    ALL.set(all).map_err(|_| AddError::Late)
}

/// The method of that name.
pub fn find(name: &str) -> Option<&'static Method> {
    methods().iter().find(|method| method.name == name)
}

impl Method {
    /// A renderer without a scene. It counts its work or, as when timing, does not.
    pub fn renderer(&self, counting: bool) -> Renderer {
        self.technique.renderer(self.name, counting)
    }

    /// Whether it draws nothing without an adapter.
    pub fn needs_adapter(&self) -> bool {
        matches!(self.renderer(false), Renderer::Adapter(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_renderers_know_theirs() {
        for (index, method) in methods().iter().enumerate() {
            assert!(methods()[..index].iter().all(|other| other.name != method.name));
            for counting in [false, true] {
                assert_eq!(method.renderer(counting).name(), method.name);
            }
        }
        let on_host = methods().iter().filter(|method| !method.needs_adapter());
        let on_host: Vec<_> = on_host.map(|method| method.name).collect();
        assert_eq!(on_host, ["fbvh-certified-cpu", "kanamori-cpu"]);
        assert!(find("fbvh").is_some() && find("no such method").is_none());
    }

    #[test]
    fn a_name_is_taken_once_and_a_list_in_use_is_not_added_to() {
        let fbvh = *find("fbvh").expect("listed");
        assert_eq!(add_methods([fbvh]), Err(AddError::Name { name: "fbvh" }));
        assert_eq!(add_methods([Method { name: "mine", ..fbvh }]), Err(AddError::Late));
        assert!(find("mine").is_none());
    }
}
