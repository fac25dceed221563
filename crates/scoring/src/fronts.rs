//! When two distances along a ray are on different fronts of the surface.

/// A hit further than this from the true one, in smallest support radii there, lies on a wrong
/// front.
pub const WRONG_FRONT: f64 = 0.05;
