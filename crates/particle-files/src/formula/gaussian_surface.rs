//! The Gaussian surface of Mol*.

use metaball_core::Kernel;

use super::gaussians::{Gaussians, cut_near};
use super::{Density, SizedBalls, radii_of_atoms, range_in_words};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::particles::Particles;

/// The density of Mol*'s Gaussian surface (Sehnal et al. 2021, Mol* Viewer; `gaussian-density/cpu.ts` and
/// `gaussian-surface-mesh.ts` of its source): Σ exp(−s·d²/r²), r being Mol*'s radius of an atom and the radius
/// offset, s the smoothness, and the isovalue exp(−s), so that an atom alone shows at r. What is farther than 2 r
/// is left out: 2√(2s) standard deviations, of which the nearest hundredth is the kernel's cut. Mol*'s grid is
/// not copied, nor that it makes a surface for each chain: here all atoms make one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianSurface {
    /// What all radii are increased by, in the unit of the positions.
    pub radius_offset: f64,
    /// The exponent s, 0.125 to 4.5.
    pub smoothness: f64,
}

impl Default for GaussianSurface {
    fn default() -> Self {
        Self { radius_offset: 0.0, smoothness: 1.5 }
    }
}

impl GaussianSurface {
    const NAME: &str = "gaussian-surface";
}

impl Density for GaussianSurface {
    fn kernel(&self) -> Kernel {
        cut_near(2.0 * (2.0 * self.smoothness).sqrt())
    }

    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let own = radii_of_atoms(particles, Self::NAME)?;
        let offset = self.radius_offset as f32;
        if let Some(index) = own.iter().position(|radius| *radius + offset <= 0.0) {
            let mut flaw =
                Flaw::needed("a radius above 0 with the radius offset", own[index] + offset);
            flaw.location.line = particles.lines.get(index);
            return Err(flaw);
        }
        notes.read(format!(
            "gaussian-surface: Gaussians exp(−{} d²/r²) (--smoothness) of radii r {} and {} (--radius-offset), \
             cut at {:.3} r where Mol* cuts at 2",
            self.smoothness,
            range_in_words(own),
            self.radius_offset,
            gaussians.cut() / (2.0 * self.smoothness).sqrt()
        ));
        let deviation = |radius: &f32| {
            (f64::from(*radius) + self.radius_offset) / (2.0 * self.smoothness).sqrt()
        };
        let radii = own.iter().map(|radius| gaussians.support(deviation(radius)));
        Ok(SizedBalls {
            radii: radii.collect(),
            strengths: vec![gaussians.strength(1.0); own.len()],
        })
    }

    fn threshold(
        &self,
        _particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let isovalue = (-self.smoothness).exp();
        let threshold = gaussians.threshold(isovalue)?;
        notes.read(format!(
            "T = {threshold}: Mol*'s isovalue exp(−{}) = {isovalue:.4}, less {:.2e} at the cut (--threshold says \
             another)",
            self.smoothness,
            gaussians.at_cut()
        ));
        Ok(threshold)
    }
}
