//! How a file's numbers make a field: its options.

use clap::Args;
use particle_files::{FormulaOptions, Preset};

#[derive(Debug, Args)]
#[command(
    next_help_heading = "Fields of simulations and of other programs (kernel and threshold may be others)"
)]
pub(crate) struct FormulaArgs {
    /// Take the file's masses, densities and smoothing lengths for the SPH interpolant: support radii by h,
    /// strengths m/ρ·W(0, h), threshold 0.5, kernel cubic-spline; without densities neighbours give volumes.
    #[arg(long, conflicts_with = "preset")]
    sph: bool,
    /// The support radius over the file's h, with --sph; where this is left out, what the kernel's source
    /// has: 2 for cubic-spline and Wendland's, 3 for quintic-spline.
    #[arg(long, value_name = "N")]
    support_per_h: Option<f64>,
    /// The mass of every particle, with --sph, where the file has densities and no masses.
    #[arg(long, value_name = "M")]
    particle_mass: Option<f64>,
    /// Draw the surface of another program: quicksurf (VMD), molmap (ChimeraX), gaussian-surface (Mol*) or
    /// splashsurf.
    #[arg(long, value_name = "NAME")]
    preset: Option<Preset>,
    /// The resolution of molmap, ångströms.
    #[arg(long, value_name = "A")]
    resolution: Option<f64>,
    /// What gaussian-surface increases radii by, ångströms [default: 0].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    radius_offset: Option<f64>,
    /// The smoothness of gaussian-surface [default: 1.5].
    #[arg(long, value_name = "S")]
    smoothness: Option<f64>,
    /// The smoothing length of splashsurf, in particle radii [default: 2].
    #[arg(long, value_name = "L")]
    smoothing_length: Option<f64>,
}

impl FormulaArgs {
    pub(crate) fn options(&self) -> FormulaOptions {
        FormulaOptions {
            sph: self.sph,
            preset: self.preset,
            support_per_h: self.support_per_h,
            particle_mass: self.particle_mass,
            resolution: self.resolution,
            radius_offset: self.radius_offset,
            smoothness: self.smoothness,
            smoothing_length: self.smoothing_length,
        }
    }
}
