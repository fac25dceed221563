//! What Illés and Szécsi print, measured on a GeForce GTX 560 Ti.

use super::run::Phases;

/// A row of table 1: phases at 1024 × 768.
#[derive(Debug, Clone, Copy)]
pub struct Printed {
    /// Number of particles.
    pub particles: usize,
    /// Milliseconds.
    pub phases: Phases,
}

const fn row(particles: usize, [total, sort, depth, gather, cast]: [f64; 5]) -> Printed {
    Printed { particles, phases: Phases { total, sort, depth, gather, cast } }
}

/// Table 1. "Sort includes CPU-GPU data transfer, Cast includes shading."
pub const TABLE: [Printed; 5] = [
    row(50_000, [40.0, 8.0, 2.0, 6.0, 24.0]),
    row(100_000, [77.0, 15.0, 5.0, 15.0, 42.0]),
    row(200_000, [160.0, 32.0, 12.0, 36.0, 80.0]),
    row(800_000, [505.0, 165.0, 65.0, 191.0, 84.0]),
    row(1_600_000, [991.0, 350.0, 131.0, 402.0, 108.0]),
];

/// Frames a second of the three pictures of figure 7, 200,000 particles.
pub const FIGURE_7: [f64; 3] = [25.0, 13.0, 6.0];

#[cfg(test)]
mod tests {
    use super::*;

    /// The text has the total as the sum of the phases, to the rounding of a millisecond each.
    #[test]
    fn totals_are_sums() {
        for Printed { phases, .. } in TABLE {
            let sum = phases.sort + phases.depth + phases.gather + phases.cast;
            assert!((phases.total - sum).abs() <= 2.5, "{phases:?}");
        }
    }
}
