//! What a program does that draws a scene against ours.

use picture_files::HitImage;

/// A program's own clocks, milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Times {
    /// Whatever it does before the first ray, by the wall's clock.
    pub(super) prepare: f64,
    /// From the first ray to the last, by the wall's clock.
    pub(super) trace: f64,
    /// The same, summed over its threads.
    pub(super) trace_cpu: f64,
}

/// A program with a view of a scene to draw.
pub(super) trait Contender {
    /// Draws the view, and reads the program's clocks.
    ///
    /// # Errors
    /// When it fails, with its own words, or does not say how long it took.
    fn time(&self) -> anyhow::Result<Times>;

    /// The hits of the view, row by row from the top left. It has been drawn before.
    ///
    /// # Errors
    /// When the program fails, or leaves no hits of the view's size.
    fn hits(&self) -> anyhow::Result<HitImage>;
}
