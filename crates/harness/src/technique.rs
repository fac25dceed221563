//! What a method does, with all its options: whatever else the harness knows of a method follows from
//! this: its renderer, the tree that the CPU traces instead, where it promises to be right, how
//! near a root it stops, and the kernels that it refuses.

use fbvh::{Kind, SecantSearch};
use illes_fraglist::Piece;
use kanamori_peel::baseline;
use metaball_core::{Kernel, Scene};

use crate::judge::promise::Promise;
use crate::judge::{Stop, Terms};
use crate::renderer::Renderer;

/// What a method does, with all its options.
#[derive(Debug, Clone, Copy)]
pub enum Technique {
    /// Traces a tree: those of Gourmel et al. 2010, whose leaves are searched so, or the certified tree.
    Tree(fbvh::Options, Option<SecantSearch>),
    /// Traces such a tree on the CPU.
    TreeOnHost(fbvh::Options, Option<SecantSearch>),
    /// Peels supports layer by layer: Kanamori et al. 2008.
    Peeling(kanamori_peel::Options),
    /// Intersects supports and clips Bézier curves on the CPU: what Kanamori et al. 2008 compares with.
    Baseline {
        /// Width at which a range is a root, in parts of an interval.
        threshold: f32,
    },
    /// Searches tiles' lists of balls by intervals: `kanamori_peel::robust`.
    TileSearch,
    /// Gathers a list of balls for each pixel: Illés and Szécsi.
    Fragments(illes_fraglist::Options),
    /// A method of another crate.
    Own(Own),
}

/// A method of another crate.
#[derive(Debug, Clone, Copy)]
pub struct Own {
    /// Makes a renderer that counts its work or, as when timing, does not; on the CPU nothing is counted.
    /// Its name is the method's.
    pub make: fn(counting: bool) -> Renderer,
    /// Where it must be right: [`Promise::Always`], unless its paper says less.
    pub promise: Promise,
    /// How near a root it stops.
    pub stop: Stop,
    /// Kernels that it refuses, with a word that its error has in it; `None` for those that it draws.
    pub refuses: fn(Kernel) -> Option<&'static str>,
}

impl Technique {
    /// A renderer of that name without a scene. It counts its work or, as when timing, does not; on the CPU
    /// nothing is counted.
    pub fn renderer(&self, name: &'static str, counting: bool) -> Renderer {
        match *self {
            Self::Tree(options, search) => {
                let renderer = fbvh::gpu::Renderer::new(name, options, counting);
                Renderer::Adapter(Box::new(match search {
                    Some(search) => renderer.with_search(search).expect("a published tree"),
                    None => renderer,
                }))
            }
            Self::TreeOnHost(options, search) => {
                let method = fbvh::host::Method::new(name, options);
                Renderer::Host(Box::new(match search {
                    Some(search) => method.with_search(search).expect("a published tree"),
                    None => method,
                }))
            }
            Self::Peeling(options) => {
                Renderer::Adapter(Box::new(kanamori_peel::Renderer::new(name, options, counting)))
            }
            Self::Baseline { threshold } => {
                Renderer::Host(Box::new(baseline::Method::new(name, threshold.into())))
            }
            Self::TileSearch => {
                Renderer::Adapter(Box::new(kanamori_peel::robust::Renderer::new(name, counting)))
            }
            Self::Fragments(options) => {
                Renderer::Adapter(Box::new(illes_fraglist::Renderer::new(name, options, counting)))
            }
            Self::Own(own) => (own.make)(counting),
        }
    }

    /// The tree that it traces, if it is one of the trees.
    pub fn tree(&self) -> Option<fbvh::Options> {
        match self {
            Self::Tree(options, _) | Self::TreeOnHost(options, _) => Some(*options),
            _ => None,
        }
    }

    /// What it is held to.
    pub fn terms(&self) -> Terms {
        Terms { promise: self.promise(), stop: self.stop() }
    }

    /// Where it must be right.
    pub fn promise(&self) -> Promise {
        match *self {
            Self::Tree(options, _) | Self::TreeOnHost(options, _) => match options.kind() {
                Kind::ModifiedBvh => Promise::ProjectionOfCover,
                Kind::Fitted => Promise::Projection,
                Kind::Certified => Promise::Always,
            },
            Self::Peeling(options) => {
                Promise::Peeling { list_capacity: options.list_capacity as usize }
            }
            // Lists have no capacity, and coincident points are all kept.
            Self::Baseline { .. } | Self::TileSearch => Promise::Always,
            Self::Fragments(options) if options.piece == Piece::Robust => Promise::Always,
            Self::Fragments(options) => {
                Promise::Fragments { piece: options.piece, array_capacity: options.array_capacity }
            }
            Self::Own(own) => own.promise,
        }
    }

    /// How near a root it stops, rounding aside.
    pub fn stop(&self) -> Stop {
        match *self {
            Self::Tree(_, Some(search)) | Self::TreeOnHost(_, Some(search)) => {
                Stop::Residual(search.tolerance.into())
            }
            Self::Tree(_, None) | Self::TreeOnHost(_, None) => Stop::Rounding,
            Self::Peeling(options) => clipped(options.threshold),
            Self::Baseline { threshold } => clipped(threshold),
            Self::TileSearch => Stop::Rounding,
            // A piece is no longer than a radius.
            Self::Fragments(_) => Stop::Distance(illes_fraglist::ROOT_TOLERANCE),
            Self::Own(own) => own.stop,
        }
    }

    /// Why it refuses a scene, in words that its error has in it; `None` where it does not.
    pub fn refusal(&self, scene: &Scene) -> Option<&'static str> {
        let kernel = scene.kernel();
        match self {
            Self::Peeling(_) | Self::Baseline { .. } => kernel
                .degree_along_ray()
                .is_none()
                .then_some("needed a kernel that is a polynomial along a ray"),
            Self::Fragments(options) if options.piece.is_exact() => {
                kernel.degree_along_ray().is_none_or(|degree| degree > 6).then_some(
                    "needed a kernel that is a polynomial of degree six or less along a ray",
                )
            }
            Self::Own(own) => (own.refuses)(kernel),
            Self::Tree(..) | Self::TreeOnHost(..) | Self::TileSearch | Self::Fragments(_) => None,
        }
    }
}

/// Where Bézier clipping stops: half the threshold, times an interval of at most two radii, and ten
/// roundings of a distance of a few radii.
fn clipped(threshold: f32) -> Stop {
    Stop::Distance(f64::from(threshold) + 9e-6)
}
