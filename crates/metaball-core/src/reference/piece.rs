//! Pieces of a segment: what is certain about the field on each.

/// The field on part of a segment, with what is certain about it.
pub(super) trait Piece: Sized {
    /// First and last u.
    fn span(&self) -> (f64, f64);
    /// Values at first and last u.
    fn ends(&self) -> (f64, f64);
    /// Bounds of all values; tighter on shorter pieces.
    fn range(&self) -> (f64, f64);
    /// The direction, if the piece is known to be monotonic.
    fn trend(&self) -> Option<Trend>;
    /// The parts before and after `middle`, which is half-way.
    fn split_at(&self, middle: f64) -> [Self; 2];
}

/// The direction of a monotonic piece.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Trend {
    Rising,
    Falling,
}
