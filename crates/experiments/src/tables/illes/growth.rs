//! How time grows with the number of particles.

use serde::{Deserialize, Serialize};

use super::paper::TABLE;
use super::run::{Phases, Run};

/// Exponents e of time ~ Nᵉ, fitted to the logarithms by least squares.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// The setting, or `paper`.
    pub setting: String,
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
    fn fit(setting: &str, points: &[(usize, Phases)]) -> Option<Self> {
        let counts = points.iter().map(|(count, _)| *count);
        let particles = (counts.clone().min()?, counts.max()?);
        if particles.0 == particles.1 {
            return None;
        }
        let exponent = |of: fn(&Phases) -> f64| {
            slope(points.iter().map(|(count, phases)| (*count as f64, of(phases))))
        };
        let exponents = Phases {
            total: exponent(|phases| phases.total),
            sort: exponent(|phases| phases.sort),
            depth: exponent(|phases| phases.depth),
            gather: exponent(|phases| phases.gather),
            cast: exponent(|phases| phases.cast),
        };
        Some(Self { setting: setting.to_owned(), particles, exponents })
    }
}

/// The paper's own numbers, over the particles that were measured here, and each setting's.
pub fn growth(settings: &[&str], runs: &[Run]) -> Vec<Growth> {
    let of = |setting: &str| -> Vec<(usize, Phases)> {
        let runs = runs.iter().filter(|run| run.setting == setting);
        runs.map(|run| (run.balls, run.phases)).collect()
    };
    let paper: Vec<_> = TABLE.iter().map(|row| (row.particles, row.phases)).collect();
    let ours = settings.iter().filter_map(|setting| Growth::fit(setting, &of(setting)));
    Growth::fit("paper", &paper).into_iter().chain(ours).collect()
}

/// The slope of the line through the points' logarithms; points without time are left out, and 0 is the
/// slope of fewer than two.
fn slope(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let logs: Vec<_> = points.filter(|(_, y)| *y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len().max(1) as f64;
    let mean_x = logs.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = logs.iter().map(|(_, y)| y).sum::<f64>() / count;
    let spread: f64 = logs.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    let together: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    if spread > 0.0 { together / spread } else { 0.0 }
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
