//! What is searched for in a leaf, and what can be found.

use glam::DVec3;
use metaball_core::Kernel;

/// Which way the ray crosses the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::trace) enum Crossing {
    /// Into the solid: F − T rises through zero.
    Entry,
    /// Out of it: T − F does.
    Exit,
}

/// What is searched for.
#[derive(Debug, Clone, Copy)]
pub(in crate::trace) struct Query {
    pub(in crate::trace) kernel: Kernel,
    pub(in crate::trace) threshold: f64,
    pub(in crate::trace) crossing: Crossing,
    /// Whether any crossing will do, wherever it is.
    pub(in crate::trace) any: bool,
}

/// What a search by polynomials found in a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) enum Answer {
    /// No crossing in the interval.
    Nothing,
    /// The ray starts beyond the crossing.
    StartsBeyond,
    /// The first crossing: the nearest t of the ray, and the gradient of the field there.
    Root(f32, DVec3),
    /// Certainly a crossing, for a query that any will do for.
    Somewhere,
    /// f32 cannot decide.
    Undecided,
}
