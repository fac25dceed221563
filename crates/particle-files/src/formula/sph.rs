//! The interpolant of smoothed particle hydrodynamics.

use metaball_core::Kernel;

use super::{Density, SizedBalls, range_in_words, volumes};
use crate::error::Flaw;
use crate::interpret::numbers;
use crate::notes::Notes;
use crate::particles::{Particles, Sizes};
use crate::roles::Role;
use crate::smoothing_length::support_per_h;

/// The SPH interpolant of 1 (Monaghan 1992, Smoothed particle hydrodynamics): Σ V·W(d, h), V = m/ρ being a
/// particle's volume by its mass and density. It is 1 inside of a fluid and falls to 0 outside, so its surface is
/// where it is 0.5.
///
/// Support radii are what the options say; else the file's smoothing lengths h times what the kernel has for one,
/// or its support radii; else 2.6 spacings, a spacing being two radii, or more where the kernel is wider for the
/// same h. Where a file has no densities, or no masses beside them, neighbours give volumes: V = m/Σ m·W.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sph {
    /// The support radius over h; by the kernel where this is `None`: 2 for the cubic spline and Wendland's
    /// functions, 3 for the quintic spline, cut/√2 for a Gaussian, 1 for others.
    pub support_per_h: Option<f64>,
    /// The mass of every particle, in the units of densities and lengths; the file's where this is `None`.
    pub particle_mass: Option<f64>,
}

/// A smoothing length in spacings where nothing says one: usual in codes, and a filled lattice has the field 1
/// to 1 % then.
const LENGTH_PER_SPACING: f64 = 1.3;

impl Sph {
    /// The support radius of each particle.
    fn support_radii(
        self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<Vec<f32>, Flaw> {
        if let Sizes::Smoothing(lengths) = &particles.sizes {
            let per_h = self.support_per_h.unwrap_or_else(|| support_per_h(kernel));
            let radii: Vec<f32> = lengths.iter().map(|h| (per_h * f64::from(*h)) as f32).collect();
            let text =
                format!("sph: {kernel} of support radii R = {per_h} h: {}", range_in_words(&radii));
            match self.support_per_h {
                Some(_) => notes.read(format!("{text}, as asked for")),
                None => notes.guessed(format!(
                    "{text}, as the kernel's source has h (--support-per-h 1 where a code's h is R)"
                )),
            }
            return Ok(radii);
        }
        if self.support_per_h.is_some() {
            let needed =
                "a column of smoothing lengths (h, hsml, smoothing_length) for support per h";
            let flaw = Flaw::needed(needed, "none that is used");
            return Err(flaw.or("name it with --columns, or say R with --support-radius"));
        }
        if let Sizes::Support(radii) = &particles.sizes {
            notes.read(format!("sph: {kernel} of support radii R: {}", range_in_words(radii)));
            return Ok(radii.clone());
        }
        let spacings = LENGTH_PER_SPACING * support_per_h(kernel).max(2.0);
        let own = particle_radii(particles).unwrap_or_default();
        let radii: Vec<f32> =
            own.iter().map(|radius| (2.0 * spacings * f64::from(*radius)) as f32).collect();
        notes.guessed(format!(
            "sph: {kernel} of support radii R = {spacings:.3} spacings: {}, since no smoothing lengths say R \
             (--support-radius does)",
            range_in_words(&radii)
        ));
        Ok(radii)
    }

    /// The volume of each particle.
    fn volumes(
        self,
        particles: &Particles,
        radii: &[f32],
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<Vec<f64>, Flaw> {
        let masses = positive_numbers(particles, Role::Mass)?;
        let densities = positive_numbers(particles, Role::Density)?;
        match (densities, self.particle_mass, masses) {
            (Some((name, densities)), Some(mass), _) => {
                notes.read(format!(
                    "volumes m/ρ: m = {mass} as asked for, ρ from the column {name:?}"
                ));
                Ok(densities.iter().map(|density| mass / density).collect())
            }
            (Some((of_density, densities)), None, Some((of_mass, masses))) => {
                notes.read(format!(
                    "volumes m/ρ: m from the column {of_mass:?}, ρ from the column {of_density:?}"
                ));
                Ok(masses.iter().zip(densities).map(|(mass, density)| mass / density).collect())
            }
            (None, Some(mass), _) => {
                let needed = "a column of densities (density, rho, rhop) for a particle mass";
                let found = format!("none beside the mass {mass}");
                Err(Flaw::needed(needed, found)
                    .or("name it with --columns, or leave the mass out: equal ones cancel"))
            }
            (densities, None, masses) => {
                let why = match densities {
                    Some((name, _)) => format!(
                        "there are no masses for the densities {name:?} (--particle-mass says one for all)"
                    ),
                    None => "the file has no densities".to_owned(),
                };
                let whose = match masses {
                    Some((name, _)) => format!("masses from the column {name:?}"),
                    None => "equal masses".to_owned(),
                };
                notes.guessed(format!("volumes m/Σ m·W by neighbours, with {whose}: {why}"));
                let masses = masses.map(|(_, masses)| masses);
                Ok(volumes::by_neighbours(particles, radii, masses, kernel))
            }
        }
    }
}

impl Density for Sph {
    fn kernel(&self) -> Kernel {
        Kernel::CubicSpline
    }

    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw> {
        let radii = self.support_radii(particles, kernel, notes)?;
        let volumes = self.volumes(particles, &radii, kernel, notes)?;
        Ok(interpolant(radii, &volumes, kernel))
    }

    fn threshold(
        &self,
        _particles: &Particles,
        _kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw> {
        notes.read(
            "T = 0.5: half of the field inside, where a fluid ends (--threshold says another)",
        );
        Ok(0.5)
    }
}

/// The balls V·W.
pub(super) fn interpolant(radii: Vec<f32>, volumes: &[f64], kernel: Kernel) -> SizedBalls {
    let normalization = kernel.normalization();
    let strength = |(volume, radius): (&f64, &f32)| {
        (volume * normalization / f64::from(*radius).powi(3)) as f32
    };
    let strengths = volumes.iter().zip(&radii).map(strength).collect();
    SizedBalls { radii, strengths }
}

/// Half of the spacing around each particle, as the file has radii or by the spacing of all; `None` where
/// other sizes are given.
pub(super) fn particle_radii(particles: &Particles) -> Option<Vec<f32>> {
    match &particles.sizes {
        Sizes::Shown(radii) => Some(radii.clone()),
        Sizes::Spacing(two_spacings) => Some(vec![0.25 * two_spacings; particles.len()]),
        Sizes::Support(_) | Sizes::Smoothing(_) => None,
    }
}

/// A column of numbers above 0.
fn positive_numbers(particles: &Particles, role: Role) -> Result<Option<(&str, &[f64])>, Flaw> {
    let Some((name, values)) = numbers(&particles.columns, role) else { return Ok(None) };
    match values.iter().position(|value| !(value.is_finite() && *value > 0.0)) {
        None => Ok(Some((name, values))),
        Some(index) => {
            let mut flaw = Flaw::needed("a finite number above 0", values[index]).at_key(name);
            flaw.location.line = particles.lines.get(index);
            Err(flaw.or("leave the particle out with --drop"))
        }
    }
}
