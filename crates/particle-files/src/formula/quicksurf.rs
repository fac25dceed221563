//! `QuickSurf` of VMD.

use metaball_core::Kernel;

use super::gaussians::{Gaussians, cut_near};
use super::{Density, SizedBalls, radii_of_atoms, range_in_words};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::particles::Particles;

/// The density of VMD's `QuickSurf` (Krone, Stone, Ertl and Schulten 2012, Fast visualization of Gaussian density
/// surfaces for molecular dynamics and particle system trajectories; VMD 1.9.4, `QuickSurf.C` and `AtomRep.C`):
/// Σ exp(−d²/2r²), r being VMD's radius of an atom times the radius scale (1, `ReadOptions::radius_scale`), and
/// the isovalue 0.5. VMD leaves out what is farther than 2 r at its lowest quality, 2.5 r, 3 r and 4 r at its
/// highest; here it is 4 r unless the kernel says otherwise. VMD's own grid, by default 1 Å wide, is not copied.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuickSurf;

impl QuickSurf {
    const NAME: &str = "quicksurf";
    const ISOVALUE: f64 = 0.5;
}

impl Density for QuickSurf {
    fn kernel(&self) -> Kernel {
        cut_near(4.0)
    }

    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let deviations = radii_of_atoms(particles, Self::NAME)?;
        notes.read(format!(
            "quicksurf: Gaussians exp(−d²/2r²) of radii r {} (--radius-scale multiplies them), cut at {} r as \
             VMD's highest quality cuts at 4 (--kernel gaussian-2 is its lowest)",
            range_in_words(deviations),
            gaussians.cut()
        ));
        let radii = deviations.iter().map(|radius| gaussians.support(f64::from(*radius)));
        let strengths = vec![gaussians.strength(1.0); deviations.len()];
        Ok(SizedBalls { radii: radii.collect(), strengths })
    }

    fn threshold(
        &self,
        _particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let threshold = gaussians.threshold(Self::ISOVALUE)?;
        notes.read(format!(
            "T = {threshold}: VMD's isovalue 0.5, less {:.2e} at the cut (--threshold says another)",
            gaussians.at_cut()
        ));
        Ok(threshold)
    }
}
