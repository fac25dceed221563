//! The trait by which particles of any type become a field.

use metaball_core::{Kernel, Scene, Support};

/// Balls with a kernel and a threshold, wherever they are kept: all that building and tracing need.
///
/// [`Scene`] implements it. Particles of another type need no copy; they implement it by reading their
/// own memory:
///
/// ```
/// use fbvh::{Field, Options, Tree};
/// use metaball_core::{Kernel, Support};
///
/// struct Fluid { positions: Vec<[f64; 3]>, radius: f32 }
///
/// impl Field for Fluid {
///     fn ball_count(&self) -> usize { self.positions.len() }
///     fn support(&self, ball: usize) -> Support {
///         let center = self.positions[ball].map(|coordinate| coordinate as f32).into();
///         Support { center, radius: self.radius }
///     }
///     fn kernel(&self) -> Kernel { Kernel::Wyvill }
///     fn threshold(&self) -> f32 { 0.25 }
/// }
///
/// let fluid = Fluid { positions: vec![[0.0; 3], [0.7, 0.0, 0.0]], radius: 1.0 };
/// assert!(!Tree::build(&fluid, &Options::certified())?.is_empty());
/// # Ok::<(), fbvh::BuildError>(())
/// ```
pub trait Field: Sync {
    /// Number of balls.
    fn ball_count(&self) -> usize;

    /// Centre and support radius of a ball, `ball < ball_count()`, world space, scene units.
    fn support(&self, ball: usize) -> Support;

    /// Strength q of a ball, not 0, in units of the field; 1 by default.
    fn strength(&self, ball: usize) -> f32 {
        let _ = ball;
        1.0
    }

    /// The kernel of all balls.
    fn kernel(&self) -> Kernel;

    /// Threshold T > 0: the field's value on the surface.
    fn threshold(&self) -> f32;
}

impl Field for Scene {
    #[inline]
    fn ball_count(&self) -> usize {
        self.len()
    }

    #[inline]
    fn support(&self, ball: usize) -> Support {
        self.supports()[ball]
    }

    #[inline]
    fn strength(&self, ball: usize) -> f32 {
        self.strengths().map_or(1.0, |strengths| strengths[ball])
    }

    #[inline]
    fn kernel(&self) -> Kernel {
        self.kernel()
    }

    #[inline]
    fn threshold(&self) -> f32 {
        self.threshold()
    }
}
