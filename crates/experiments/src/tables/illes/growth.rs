//! How time grows with the number of particles.

use serde::{Deserialize, Serialize};

use super::paper::TABLE;
use super::run::{ListRun, Phases};
use harness::stats::exponent;

/// Exponents e of time ~ Nᵉ, fitted to the logarithms by least squares.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// The variant, or `paper`.
    #[serde(rename = "setting")]
    pub variant: String,
    /// Fewest and most particles of the fit.
    pub particles: (usize, usize),
    /// Of each phase; one that takes no time has 0.
    pub exponents: Phases,
}

impl Growth {
    /// The paper's claim, section 7: the cast grows slower than the number of particles.
    pub fn cast_grows_slower(&self) -> bool {
        self.exponents.cast < 1.0
    }

    /// Fits the points; `None` of fewer than two numbers of particles.
    fn fit(variant: &str, points: &[(usize, Phases)]) -> Option<Self> {
        let counts = points.iter().map(|(count, _)| *count);
        let particles = (counts.clone().min()?, counts.max()?);
        if particles.0 == particles.1 {
            return None;
        }
        let fit = |of: fn(&Phases) -> f64| {
            slope(points.iter().map(|(count, phases)| (*count as f64, of(phases))))
        };
        let exponents = Phases {
            total: fit(|phases| phases.total),
            sort: fit(|phases| phases.sort),
            depth: fit(|phases| phases.depth),
            gather: fit(|phases| phases.gather),
            cast: fit(|phases| phases.cast),
        };
        Some(Self { variant: variant.to_owned(), particles, exponents })
    }
}

/// The paper's own numbers, over the particles that were measured here, and each variant's.
pub fn growth(variants: &[&str], runs: &[ListRun]) -> Vec<Growth> {
    let of = |variant: &str| -> Vec<(usize, Phases)> {
        let runs = runs.iter().filter(|run| run.variant == variant);
        runs.map(|run| (run.balls, run.phases)).collect()
    };
    let paper: Vec<_> = TABLE.iter().map(|row| (row.particles, row.phases)).collect();
    let ours = variants.iter().filter_map(|variant| Growth::fit(variant, &of(variant)));
    Growth::fit("paper", &paper).into_iter().chain(ours).collect()
}

/// The exponent over the points that take time; 0 of fewer than two.
fn slope(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let points: Vec<_> = points.filter(|(_, time)| *time > 0.0).collect();
    exponent(&points).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_found() {
        let power = |exponent: f64| [10.0, 100.0, 3000.0].map(|x: f64| (x, 7.0 * x.powf(exponent)));
        for exponent in [0.0, 0.5, 1.0, 2.0] {
            assert!((slope(power(exponent).into_iter()) - exponent).abs() < 1e-12);
        }
        assert_eq!(slope([(10.0, 1.0), (20.0, 0.0)].into_iter()), 0.0);
    }

    /// From 24 to 108 ms over a factor of 32: an exponent of about ln 4.5 / ln 32 = 0.43; the sort's is
    /// above 1. Canary: a cast that grows faster than N does not hold the claim.
    #[test]
    fn the_papers_numbers_hold_its_claim() {
        let [paper] = &growth(&[], &[])[..] else { panic!("one fit") };
        assert!((paper.exponents.cast - 0.43).abs() < 0.06, "{paper:?}");
        assert!(paper.cast_grows_slower() && paper.exponents.sort > 1.0);
        let phases = |cast| Phases { total: cast, sort: 1.0, depth: 0.0, gather: 1.0, cast };
        let steep = Growth::fit("x", &[(10, phases(1.0)), (20, phases(2.5))]).expect("two points");
        assert!(!steep.cast_grows_slower());
    }
}
