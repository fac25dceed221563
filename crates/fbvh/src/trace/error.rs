//! What a kind of tree cannot do.

use thiserror::Error;

use crate::Kind;

/// Why a tracer or a renderer cannot do what was asked of it: its kind of tree does not have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// Exits of a published tree: the paper's leaf test is for rays that start outside.
    #[error("exits: needed a certified tree, found {found:?}")]
    ExitOfPublished {
        /// The tree's kind.
        found: Kind,
    },
    /// A cut of a published tree: where a ray starts in the solid, which is where it meets the face of a
    /// cut, the paper promises nothing.
    #[error("clipping: needed a certified tree, found {found:?}")]
    ClipOfPublished {
        /// The tree's kind.
        found: Kind,
    },
    /// A secant search in a certified tree: its leaves are searched by bounds, to the last float, and
    /// have neither a tolerance nor a reading.
    #[error("a secant search: needed a published tree, found {found:?}")]
    SecantOfCertified {
        /// The tree's kind.
        found: Kind,
    },
}
