//! Formulas as options and scene files say them.

use std::fmt;
use std::str::FromStr;

use super::{Formula, GaussianSurface, Molmap, QuickSurf, Sph, Splashsurf};
use crate::error::LoadError;
use crate::options::parameter;

/// Which formula is asked for, and its parameters; the default is none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FormulaOptions {
    /// The SPH interpolant.
    pub sph: bool,
    /// A surface of another program.
    pub preset: Option<Preset>,
    /// Of SPH: the support radius over the file's smoothing length h; by the kernel where this is `None`.
    pub support_per_h: Option<f64>,
    /// Of SPH: the mass of every particle, in the units of the file's densities and lengths.
    pub particle_mass: Option<f64>,
    /// Of `molmap`: the resolution, ångströms.
    pub resolution: Option<f64>,
    /// Of `gaussian-surface`: what all radii are increased by, ångströms; 0 where this is `None`.
    pub radius_offset: Option<f64>,
    /// Of `gaussian-surface`: the exponent of its Gaussians at an atom's radius; 1.5 where this is `None`.
    pub smoothness: Option<f64>,
    /// Of `splashsurf`: the smoothing length in particle radii; 2 where this is `None`.
    pub smoothing_length: Option<f64>,
}

/// A program's surface, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Preset {
    /// `quicksurf`, of VMD.
    QuickSurf,
    /// `molmap`, of ChimeraX.
    Molmap,
    /// `gaussian-surface`, of Mol*.
    GaussianSurface,
    /// `splashsurf`.
    Splashsurf,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::QuickSurf, Self::Molmap, Self::GaussianSurface, Self::Splashsurf];
}

impl fmt::Display for Preset {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::QuickSurf => "quicksurf",
            Self::Molmap => "molmap",
            Self::GaussianSurface => "gaussian-surface",
            Self::Splashsurf => "splashsurf",
        })
    }
}

impl FromStr for Preset {
    type Err = LoadError;

    fn from_str(name: &str) -> Result<Self, LoadError> {
        let named = Self::ALL.into_iter().find(|preset| preset.to_string() == name);
        named.ok_or_else(|| {
            let needed = "quicksurf, molmap, gaussian-surface or splashsurf";
            parameter("preset", needed, format_args!("{name:?}"))
        })
    }
}

impl FormulaOptions {
    /// The formula, if one is asked for.
    ///
    /// # Errors
    /// When two are, when a parameter has no use in the one that is, or cannot have its value.
    pub fn formula(&self) -> Result<Option<Formula>, LoadError> {
        self.check()?;
        let formula = match self.preset {
            None if !self.sph => return Ok(None),
            None => Formula::Sph(Sph {
                support_per_h: self.support_per_h,
                particle_mass: self.particle_mass,
            }),
            Some(Preset::QuickSurf) => Formula::QuickSurf(QuickSurf),
            Some(Preset::Molmap) => Formula::Molmap(Molmap {
                resolution: self.resolution.ok_or_else(|| {
                    parameter("resolution", "one in ångströms for molmap, such as 3", "none")
                })?,
            }),
            Some(Preset::GaussianSurface) => {
                let default = GaussianSurface::default();
                Formula::GaussianSurface(GaussianSurface {
                    radius_offset: self.radius_offset.unwrap_or(default.radius_offset),
                    smoothness: self.smoothness.unwrap_or(default.smoothness),
                })
            }
            Some(Preset::Splashsurf) => {
                let default = Splashsurf::default().smoothing_length;
                Formula::Splashsurf(Splashsurf {
                    smoothing_length: self.smoothing_length.unwrap_or(default),
                })
            }
        };
        Ok(Some(formula))
    }

    /// Roles of columns that are read for it, by a name of each.
    pub(crate) fn columns(&self) -> &'static [&'static str] {
        if self.sph { &["mass", "density", "smoothing length"] } else { &[] }
    }

    /// These, and what they do not say from others; only their parameters where these name a formula that
    /// is not the others'.
    pub(crate) fn or(&self, others: &Self) -> Self {
        let names_one = self.sph || self.preset.is_some();
        if names_one && (self.sph, self.preset) != (others.sph, others.preset) {
            return *self;
        }
        Self {
            sph: others.sph || self.sph,
            preset: self.preset.or(others.preset),
            support_per_h: self.support_per_h.or(others.support_per_h),
            particle_mass: self.particle_mass.or(others.particle_mass),
            resolution: self.resolution.or(others.resolution),
            radius_offset: self.radius_offset.or(others.radius_offset),
            smoothness: self.smoothness.or(others.smoothness),
            smoothing_length: self.smoothing_length.or(others.smoothing_length),
        }
    }

    /// Refuses values that no formula can have, and parameters of another formula than is asked for.
    fn check(&self) -> Result<(), LoadError> {
        if let (true, Some(preset)) = (self.sph, self.preset) {
            return Err(parameter("preset", "none beside sph", preset));
        }
        let sph = || (self.sph, "sph".to_owned());
        let of = |preset| (self.preset == Some(preset), format!("the preset {preset}"));
        let positive: (&str, fn(f64) -> bool) = ("a finite number above 0", |value| value > 0.0);
        let finite: (&str, fn(f64) -> bool) = ("a finite number", |_| true);
        let smooth: (&str, fn(f64) -> bool) =
            ("a number from 0.125 to 4.5", |value| (0.125..=4.5).contains(&value));
        let parameters = [
            ("support per h", self.support_per_h, sph(), positive),
            ("particle mass", self.particle_mass, sph(), positive),
            ("resolution", self.resolution, of(Preset::Molmap), positive),
            ("radius offset", self.radius_offset, of(Preset::GaussianSurface), finite),
            ("smoothness", self.smoothness, of(Preset::GaussianSurface), smooth),
            ("smoothing length", self.smoothing_length, of(Preset::Splashsurf), positive),
        ];
        for (name, value, (is_asked_for, formula), (needed, is_fine)) in parameters {
            let Some(value) = value else { continue };
            if !is_asked_for {
                return Err(parameter(name, &format!("{formula}, whose it is"), self.asked()));
            }
            if !(value.is_finite() && is_fine(value)) {
                return Err(parameter(name, needed, value));
            }
        }
        Ok(())
    }

    /// What is asked for, in words.
    fn asked(&self) -> String {
        match self.preset {
            Some(preset) => format!("the preset {preset}"),
            None if self.sph => "sph".to_owned(),
            None => "no formula".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_read_as_they_are_written() {
        for preset in Preset::ALL {
            assert_eq!(preset.to_string().parse::<Preset>().expect("its name"), preset);
        }
        let error = "vmd".parse::<Preset>().expect_err("no preset").to_string();
        assert!(error.starts_with("preset: needed quicksurf, molmap"), "{error}");
    }

    #[test]
    fn parameters_go_with_their_formula() {
        let refused = |options: FormulaOptions| options.formula().expect_err("refused").to_string();
        let sph = FormulaOptions { sph: true, ..FormulaOptions::default() };
        let of = |preset| FormulaOptions { preset: Some(preset), ..FormulaOptions::default() };
        assert_eq!(FormulaOptions::default().formula().expect("none"), None);
        assert!(refused(of(Preset::Molmap)).starts_with("resolution: needed one in ångströms"));
        assert_eq!(
            refused(FormulaOptions { smoothness: Some(1.0), ..sph }),
            "smoothness: needed the preset gaussian-surface, whose it is, found sph"
        );
        assert_eq!(
            refused(FormulaOptions { support_per_h: Some(2.0), ..FormulaOptions::default() }),
            "support per h: needed sph, whose it is, found no formula"
        );
        assert!(refused(FormulaOptions { support_per_h: Some(0.0), ..sph }).ends_with("found 0"));
        assert!(
            refused(FormulaOptions { sph: true, ..of(Preset::Molmap) }).contains("none beside sph")
        );
        let sunken = FormulaOptions { radius_offset: Some(-0.5), ..of(Preset::GaussianSurface) };
        assert!(sunken.formula().is_ok());
    }

    #[test]
    fn parameters_of_another_formula_are_not_taken_over() {
        let of_file = FormulaOptions {
            preset: Some(Preset::Molmap),
            resolution: Some(3.0),
            ..FormulaOptions::default()
        };
        let finer = FormulaOptions { resolution: Some(1.0), ..FormulaOptions::default() };
        assert_eq!(finer.or(&of_file), FormulaOptions { resolution: Some(1.0), ..of_file });
        let sph = FormulaOptions { sph: true, ..FormulaOptions::default() };
        assert_eq!(sph.or(&of_file), sph);
        assert_eq!(FormulaOptions::default().or(&of_file), of_file);
    }
}
