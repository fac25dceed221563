//! How far a long measurement is: told to whoever watches.

/// Whoever watches a measurement. `()` does not.
pub trait Progress {
    /// Something begins.
    fn stage(&self, text: String);

    /// So many steps are done.
    fn advance(&self, steps: u64);
}

impl Progress for () {
    fn stage(&self, _: String) {}

    fn advance(&self, _: u64) {}
}
