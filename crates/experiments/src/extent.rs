//! How much is measured.

/// How much to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Small scenes, small pictures, few rounds: to see that everything works.
    Quick,
    /// Everything.
    Whole,
}
