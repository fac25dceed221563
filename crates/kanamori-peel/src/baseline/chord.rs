//! The chord that a ray has in a ball's support.

/// A ball along a ray. Lengths count in the ray's t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chord {
    /// Whose it is.
    pub(super) ball: u32,
    /// t of the centre's projection.
    pub(super) middle: f64,
    /// Half the chord, squared; not negative.
    pub(super) half_squared: f64,
    /// 1/R².
    pub(super) inverse_square: f64,
    /// q.
    pub(super) strength: f64,
    /// The same as `half_squared` for the ball's kernel sphere; negative where the ray misses it.
    pub(super) kernel_half_squared: f64,
}

impl Chord {
    /// t at which the ray enters the support; negative behind its start.
    pub(super) fn enter(&self) -> f64 {
        self.middle - self.half_squared.sqrt()
    }

    /// t at which the ray leaves the support.
    pub(super) fn leave(&self) -> f64 {
        self.middle + self.half_squared.sqrt()
    }

    /// t at which a ray that starts at `t_min` enters the kernel sphere, `t_min` with its start inside;
    /// infinite where it does not.
    pub(super) fn kernel_sphere(&self, t_min: f64) -> f64 {
        if self.kernel_half_squared < 0.0 {
            return f64::INFINITY;
        }
        let half = self.kernel_half_squared.sqrt();
        if self.middle + half < t_min { f64::INFINITY } else { (self.middle - half).max(t_min) }
    }
}
