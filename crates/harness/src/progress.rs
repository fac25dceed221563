//! How a long measurement reports its progress.

/// What progress is reported to. `()` ignores it.
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
