//! Sums of Gaussians, cut and lowered to reach 0 at the cut.

use metaball_core::Kernel;

use crate::error::Flaw;

/// Gaussians of a program, of which the kernel takes as much as lies above their value at the cut: a ball adds
/// a·(g(r) − g(cut)), where the program adds a·g(r) and jumps to 0. So a field of n balls in reach of a point is
/// less by n·a·g(cut), and with a threshold that is less by a·g(cut) an atom alone shows where it shows there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gaussians {
    /// In standard deviations.
    cut: f64,
}

impl Gaussians {
    /// Those of a kernel, for a program.
    pub(super) fn of(kernel: Kernel, program: &str) -> Result<Self, Flaw> {
        match kernel {
            Kernel::Gaussian(cut) => Ok(Self { cut: cut.get() }),
            other => {
                let needed = format!("a Gaussian for {program}, such as gaussian-4 with its cut");
                Err(Flaw::needed(&needed, other).at_key("kernel"))
            }
        }
    }

    /// In standard deviations.
    pub(super) fn cut(self) -> f64 {
        self.cut
    }

    /// g(cut).
    pub(super) fn at_cut(self) -> f64 {
        (-0.5 * self.cut * self.cut).exp()
    }

    /// The support radius for a standard deviation.
    pub(super) fn support(self, deviation: f64) -> f32 {
        (self.cut * deviation) as f32
    }

    /// The strength of a ball that is a times a Gaussian, lowered.
    pub(super) fn strength(self, amplitude: f64) -> f32 {
        (amplitude * (1.0 - self.at_cut())) as f32
    }

    /// The threshold for an isovalue of Gaussians that are 1 in their middle.
    pub(super) fn threshold(self, isovalue: f64) -> Result<f32, Flaw> {
        let threshold = isovalue - self.at_cut();
        if threshold > 0.0 {
            return Ok(threshold as f32);
        }
        let needed = format!("a cut at which the Gaussian is below the isovalue {isovalue}");
        let found = format!("{} at {} standard deviations", self.at_cut(), self.cut);
        Err(Flaw::needed(&needed, found).at_key("kernel"))
    }
}

/// The Gaussian whose cut is nearest to so many standard deviations, 1 to 6.
pub(super) fn cut_near(deviations: f64) -> Kernel {
    let hundredths = (100.0 * deviations).round().clamp(100.0, 600.0);
    Kernel::gaussian(hundredths / 100.0).unwrap_or(Kernel::QUARTIC)
}
