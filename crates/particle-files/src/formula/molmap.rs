//! `molmap` of ChimeraX.

use std::f64::consts::{PI, SQRT_2};

use glam::{DVec3, UVec3};
use metaball_core::Kernel;
use rayon::prelude::*;

use super::gaussians::{Gaussians, cut_near};
use super::{Density, SizedBalls};
use crate::error::Flaw;
use crate::interpret::{column_of, elements_of};
use crate::notes::Notes;
use crate::particles::Particles;
use crate::roles::Role;

/// The density map that ChimeraX's command `molmap` makes (its documentation, and `map/src/molmap.py` of its
/// source), after `pdb2mrc` of EMAN: Σ Z·(2πσ²)^(−3/2)·exp(−d²/2σ²) in electrons per cubic ångström, Z being the
/// atomic number and σ = resolution/(π√2), whose Fourier transform falls to 1/e at the resolution. What is farther
/// than 5 σ is left out. The first level shown has 95 % of the density of all points of the map above it: points a
/// third of the resolution apart, from three resolutions below the least coordinates on. Here values at these
/// points are ranked as they are, and not in bins, and only where no other threshold is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Molmap {
    /// The resolution, ångströms.
    pub resolution: f64,
}

/// The most points of a map, a gibibyte of numbers.
const MOST_POINTS: u64 = 1 << 28;

impl Molmap {
    const NAME: &str = "molmap";
    const SHOWN_PART: f64 = 0.95;

    /// σ, ångströms.
    fn deviation(self) -> f64 {
        self.resolution / (PI * SQRT_2)
    }

    /// A Gaussian's middle for each electron.
    fn normalization(self) -> f64 {
        (2.0 * PI).powf(-1.5) * self.deviation().powi(-3)
    }

    /// The map's values, in no order that matters.
    fn map(self, positions: &[DVec3], numbers: &[u8], cut: f64) -> Result<Vec<f32>, Flaw> {
        let (pad, step) = (3.0 * self.resolution, self.resolution / 3.0);
        let least = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min) - pad;
        let most = positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max) + pad;
        let counts = ((most - least).max(DVec3::ZERO) / step).ceil();
        let count = counts.x * counts.y * counts.z;
        if count > MOST_POINTS as f64 {
            let needed = format!("a map of at most {MOST_POINTS} points for its level");
            return Err(Flaw::needed(&needed, count)
                .or("--threshold says the level, or --resolution a coarser map"));
        }
        let counts = counts.as_uvec3();
        let mut map = vec![0.0_f32; counts.element_product() as usize];
        let (deviation, normalization) = (self.deviation(), self.normalization());
        let (reach, falloff) = (cut * deviation, -0.5 / (deviation * deviation));
        for (position, number) in positions.iter().zip(numbers) {
            let middle = (position - least) / step;
            let from = (middle - reach / step).max(DVec3::ZERO).ceil().as_uvec3();
            let to = (middle + reach / step).floor().as_uvec3().min(counts - UVec3::ONE);
            let weight = f64::from(*number) * normalization;
            for z in from.z..=to.z {
                for y in from.y..=to.y {
                    let row = (z * counts.y + y) * counts.x;
                    for x in from.x..=to.x {
                        let away = (DVec3::new(x.into(), y.into(), z.into()) - middle) * step;
                        let squared = away.length_squared();
                        if squared <= reach * reach {
                            map[(row + x) as usize] += (weight * (falloff * squared).exp()) as f32;
                        }
                    }
                }
            }
        }
        Ok(map)
    }
}

impl Density for Molmap {
    fn kernel(&self) -> Kernel {
        cut_near(5.0)
    }

    fn balls(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<SizedBalls, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let numbers = atomic_numbers(particles)?;
        notes.read(format!(
            "molmap: Gaussians of σ = {:.4} Å for a resolution of {} Å (--resolution), cut at {} σ, with atomic \
             numbers as weights, in electrons per Å³",
            self.deviation(),
            self.resolution,
            gaussians.cut()
        ));
        let strength = |number: &u8| gaussians.strength(f64::from(*number) * self.normalization());
        Ok(SizedBalls {
            radii: vec![gaussians.support(self.deviation()); numbers.len()],
            strengths: numbers.iter().map(strength).collect(),
        })
    }

    fn threshold(
        &self,
        particles: &Particles,
        kernel: Kernel,
        notes: &mut Notes,
    ) -> Result<f32, Flaw> {
        let gaussians = Gaussians::of(kernel, Self::NAME)?;
        let map = self.map(&particles.positions, &atomic_numbers(particles)?, gaussians.cut())?;
        let level = level_below(map, Self::SHOWN_PART);
        notes.read(format!(
            "T = {level}: 95 % of the map's density is above it, as ChimeraX first shows it (--threshold says \
             another)"
        ));
        Ok(level)
    }
}

/// The value above which so large a part of the sum of all lies.
fn level_below(mut values: Vec<f32>, part: f64) -> f32 {
    values.retain(|value| *value > 0.0);
    values.par_sort_unstable_by(|a, b| b.total_cmp(a));
    let total: f64 = values.iter().map(|value| f64::from(*value)).sum();
    let mut above = 0.0;
    let level = values.iter().find(|value| {
        above += f64::from(**value);
        above >= part * total
    });
    level.copied().unwrap_or(1.0)
}

/// The atomic number of each atom.
fn atomic_numbers(particles: &Particles) -> Result<Vec<u8>, Flaw> {
    let elements = elements_of(&particles.columns);
    let unknown = elements.iter().position(Option::is_none);
    let column = column_of(&particles.columns, Role::Element);
    match (column, unknown) {
        (None, _) if !particles.is_empty() => {
            let flaw =
                Flaw::needed("elements for molmap, whose weights are atomic numbers", "none");
            Err(flaw.or("name their column element with --columns, or take another preset"))
        }
        (Some(column), Some(index)) => {
            let found = format!("{:?}", column.values.text(index));
            let mut flaw = Flaw::needed("an element for every atom of molmap", found);
            flaw.location.line = particles.lines.get(index);
            Err(flaw.or("leave it out with --drop"))
        }
        _ => Ok(elements.iter().flatten().map(|element| element.number()).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_has_its_part_above() {
        assert_eq!(level_below(vec![1.0, 4.0, 0.0, 2.0, 3.0], 0.9), 2.0);
        assert_eq!(level_below(vec![1.0, 4.0, 0.0, 2.0, 3.0], 0.91), 1.0);
        assert_eq!(level_below(Vec::new(), 0.95), 1.0);
    }

    #[test]
    fn maps_that_are_too_large_are_refused_with_a_way_out() {
        let far = [DVec3::ZERO, DVec3::splat(1e5)];
        let error = Molmap { resolution: 1.0 }.map(&far, &[1, 1], 5.0).expect_err("refused");
        assert!(error.problem.contains("--threshold says the level"), "{}", error.problem);
        assert!(Molmap { resolution: 1.0 }.map(&[], &[], 5.0).expect("empty").is_empty());
    }
}
