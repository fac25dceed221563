//! Checking a finished tree against its field.

mod flaw;
mod lists;
mod neighbors;
mod samples;
mod shape;
mod surface;

pub use self::flaw::Flaw;
use crate::{Field, Stats, Tree};

impl Tree {
    /// Checks everything that tracing relies on: the order of nodes and leaves, boxes inside boxes,
    /// children apart in the Fitted BVH, who owns a ball, lists complete up to balls that do not
    /// matter to the surface in the leaf (sampled), the surface inside leaves (sampled: from each
    /// ball's centre outwards), and solid leaves solid (sampled). Slow, in f64, and with neighbours
    /// found without the tree: for tests.
    ///
    /// # Errors
    /// The first [`Flaw`] found.
    pub fn validate(&self, field: &impl Field) -> Result<Stats, Flaw> {
        self.check_shape()?;
        self.check_lists(field)?;
        self.check_completeness(field)?;
        self.check_surface(field)?;
        self.check_solids(field)?;
        Ok(self.stats())
    }
}
