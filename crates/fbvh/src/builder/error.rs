//! Why a tree cannot be built.

use metaball_core::{NegativeBall, SceneError};
use thiserror::Error;

use super::plane::MAX_BINS;
use crate::Kind;

/// Why [`Tree::build`](crate::Tree::build) makes no tree.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A ball, the threshold or the number of balls is not legal in a field.
    #[error(transparent)]
    Field(#[from] SceneError),
    /// [`Options::bins`](crate::Options::bins) is out of range.
    #[error("bins: needed from 2 to {MAX_BINS}, found {found}")]
    Bins {
        /// The number given.
        found: u32,
    },
    /// A negative ball in a published tree: where it takes away from the solid, a ray can hit without
    /// passing a centre's projection inside, which the paper's leaf test looks for.
    #[error("a tree of {kind:?}: {source}")]
    NegativeOfPublished {
        /// The tree's kind.
        kind: Kind,
        /// The first negative ball.
        source: NegativeBall,
    },
    /// The balls overlap so much that indices of 32 bits cannot name all list entries or leaves.
    #[error("{what} of the tree: needed at most {limit}, found {found}")]
    TooMany {
        /// `leaves` or `list entries`.
        what: &'static str,
        /// How many there would be.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Whoever waited for it did not want it any more.
    #[error("broken off")]
    BrokenOff,
}
