//! What can go wrong.

use metaball_core::RayQuery;
use thiserror::Error;

/// A tracer does not answer a query that effects need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "needed answers to the ray query {query:?} of these effects, as the certified tree has; found none"
)]
pub struct UnansweredError {
    /// The query.
    pub query: RayQuery,
}
