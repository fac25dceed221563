//! Methods that answer queries of free rays.

use super::{Frame, RayBatch, RenderError};
use crate::RayQuery;

/// A method that traces any ray, beyond primary ones. Light effects are made of such rays.
pub trait RayTracer {
    /// Whether the method answers this query.
    fn answers(&self, query: RayQuery) -> bool;

    /// Records the passes that list the rays of the batch with this query
    /// ([`RayBatch::encode_list`]) and write their answers; other rays and answers stay as they are.
    /// The batch belongs to the frame's targets. An answer from which secondary rays can start says
    /// how far from the surface they have to ([`PackedHit::clearance`](crate::PackedHit::clearance)).
    ///
    /// # Errors
    /// When the method does not answer this query, or a pass cannot be recorded.
    fn encode_answers(
        &mut self,
        frame: &mut Frame<'_>,
        batch: &RayBatch,
        query: RayQuery,
    ) -> Result<(), RenderError>;
}
