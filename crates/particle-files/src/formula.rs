//! Formulas by which what a file says of its particles makes a field: that of SPH, and those of other programs.

mod gaussian_surface;
mod gaussians;
mod molmap;
mod neighbours;
mod options;
mod quicksurf;
mod sph;
mod splashsurf;
mod volumes;

use metaball_core::Kernel;

pub use self::gaussian_surface::GaussianSurface;
pub use self::molmap::Molmap;
pub use self::options::{FormulaOptions, Preset};
pub use self::quicksurf::QuickSurf;
pub use self::sph::Sph;
pub use self::splashsurf::Splashsurf;
use crate::atom_radii::AtomRadii;
use crate::error::{Flaw, LoadError};
use crate::notes::Notes;
use crate::particles::{Particles, Sizes};

/// How support radii, strengths, kernel and threshold follow from what a file says. The field is a sum of
/// balls, exactly that of the formula but where it says otherwise; grids and meshes of the programs that are
/// named are not copied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Formula {
    /// The SPH interpolant of 1.
    Sph(Sph),
    /// The surface `QuickSurf` of VMD.
    QuickSurf(QuickSurf),
    /// The map that the command `molmap` of ChimeraX makes.
    Molmap(Molmap),
    /// The Gaussian surface of Mol*.
    GaussianSurface(GaussianSurface),
    /// The density of splashsurf.
    Splashsurf(Splashsurf),
}

/// Particles whose support radii and strengths are those of a formula, and what makes a scene of them:
/// [`Particles::into_scene`].
#[derive(Debug, Clone, PartialEq)]
pub struct ByFormula {
    /// The particles, with their notes.
    pub particles: Particles,
    /// The kernel.
    pub kernel: Kernel,
    /// The threshold T.
    pub threshold: f32,
}

/// What each formula says.
trait Density {
    /// The kernel unless another is asked for.
    fn kernel(&self) -> Kernel;

    /// The ball of each particle.
    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw>;

    /// The threshold unless another is asked for.
    fn threshold(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw>;
}

/// How large each ball is, and how strong.
struct SizedBalls {
    /// Support radii, in the unit of the positions.
    radii: Vec<f32>,
    strengths: Vec<f32>,
}

impl Formula {
    /// Gives particles what the formula says, under its own kernel and threshold where these are `None`.
    ///
    /// # Errors
    /// When something is missing or cannot be used: names the particle with its line, what was needed, what
    /// was found, and the way out.
    pub fn apply(
        self,
        mut particles: Particles,
        kernel: Option<Kernel>,
        threshold: Option<f32>,
    ) -> Result<ByFormula, LoadError> {
        let kernel = kernel.unwrap_or_else(|| self.kernel());
        let mut notes = std::mem::take(&mut particles.notes);
        if particles.strengths.take().is_some() {
            notes.left_out("the file's strengths: the formula says them");
        }
        let density = self.density();
        let made = density.balls(&particles, kernel, &mut notes).and_then(|balls| {
            let threshold = match threshold {
                Some(threshold) => threshold,
                None => density.threshold(&particles, kernel, &mut notes)?,
            };
            Ok((balls, threshold))
        });
        let (balls, threshold) = made.map_err(|mut flaw| {
            flaw.location.file = particles.file.clone();
            flaw
        })?;
        let particles = Particles {
            sizes: Sizes::Support(balls.radii),
            strengths: Some(balls.strengths),
            notes,
            ..particles
        };
        Ok(ByFormula { particles, kernel, threshold })
    }

    /// The kernel that it has unless another is asked for.
    pub fn kernel(self) -> Kernel {
        self.density().kernel()
    }

    fn density(&self) -> &dyn Density {
        match self {
            Self::Sph(sph) => sph,
            Self::QuickSurf(surface) => surface,
            Self::Molmap(map) => map,
            Self::GaussianSurface(surface) => surface,
            Self::Splashsurf(density) => density,
        }
    }

    /// Whether its particles are no atoms.
    pub(crate) fn is_of_fluids(self) -> bool {
        matches!(self, Self::Sph(_) | Self::Splashsurf(_))
    }

    /// Whether a column of smoothing lengths says how large its particles are.
    pub(crate) fn takes_smoothing_lengths(self) -> bool {
        matches!(self, Self::Sph(_))
    }

    /// Whether how large its particles are has a part in it.
    pub(crate) fn takes_sizes(self) -> bool {
        !matches!(self, Self::Molmap(_))
    }

    /// The radii of atoms under a formula or none.
    pub(crate) fn atom_radii(formula: Option<Self>) -> AtomRadii {
        match formula {
            Some(Self::QuickSurf(_)) => AtomRadii::Vmd,
            Some(Self::GaussianSurface(_)) => AtomRadii::MolStar,
            _ => AtomRadii::Alvarez,
        }
    }
}

/// The radius of each particle, for a formula that has no use for supports.
fn radii_of_atoms<'a>(particles: &'a Particles, program: &str) -> Result<&'a [f32], Flaw> {
    match &particles.sizes {
        Sizes::Shown(radii) => Ok(radii),
        sizes => {
            let found = match sizes {
                Sizes::Support(_) => "support radii",
                Sizes::Smoothing(_) => "smoothing lengths",
                _ => "none",
            };
            let needed = format!("radii of atoms or a column of radii for {program}");
            Err(Flaw::needed(&needed, found).or("--as molecule or --radius says them"))
        }
    }
}

/// From the least to the greatest, in words.
fn range_in_words(values: &[f32]) -> String {
    let least = values.iter().copied().fold(f32::INFINITY, f32::min);
    let most = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    match values.is_empty() {
        true => "of none".to_owned(),
        false if least == most => least.to_string(),
        false => format!("{least} to {most}"),
    }
}
