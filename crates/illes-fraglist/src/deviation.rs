//! How far the published cubic is from the kernel.

use metaball_core::Kernel;

/// Bounds on (kernel − cubic) along a chord, in parts of the ball's value at the chord's midpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Most that the cubic is above the kernel: not positive.
    pub least: f64,
    /// Most that the cubic is below the kernel: not negative.
    pub greatest: f64,
}

/// The bounds for a kernel, over all chords.
///
/// On half a chord let x go from 0 at the end to 1 at the midpoint. The cubic is γx²(3 − 2x) (figure
/// 5), and v = a·x(2 − x) with a = Q²/R². A power kernel is then γ(x(2 − x))^α whatever the chord.
/// The others depend on a; the bounds are those over a in (0, 1].
pub fn cubic_deviation(kernel: Kernel) -> Deviation {
    const STEPS: u32 = 256;
    // Between two samples the difference moves by less than its slope, at most 2α + 1.5 in x, allows:
    // what the grid can miss at an extremum is the square of half a step times its curvature. Of short
    // chords the kernel is nearly a power of v, but a Gaussian's that is cut far out only of very short ones.
    const MISSED: f64 = 64.0 / (STEPS * STEPS) as f64;
    let fractions = || (1..=STEPS).map(|step| f64::from(step) / f64::from(STEPS));
    // Along power kernels all chords are alike.
    let depths: Vec<f64> = match kernel {
        Kernel::Power(_) => vec![1.0],
        _ => fractions().chain((9..=20).map(|halvings| 0.5f64.powi(halvings))).collect(),
    };
    let bounds = Deviation { least: 0.0, greatest: 0.0 };
    let found = depths.iter().flat_map(|&a| fractions().map(move |x| (a, x))).fold(
        bounds,
        |bounds, (a, x)| {
            let along = kernel.value(1.0 - a * x * (2.0 - x)) / kernel.value(1.0 - a);
            let difference = along - x * x * (3.0 - 2.0 * x);
            Deviation {
                least: bounds.least.min(difference),
                greatest: bounds.greatest.max(difference),
            }
        },
    );
    Deviation { least: found.least - MISSED, greatest: found.greatest + MISSED }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The extremes that were computed symbolically, from the splines on by a program of its own; the search
    /// adds 1e-3.
    #[test]
    fn bounds_are_the_known_ones() {
        let power = |exponent| Kernel::power(exponent).expect("legal");
        let known = [
            (power(1), 0.0, 0.2963),
            (power(2), 0.0, 0.0625),
            (power(3), -0.09017, 0.0),
            (power(4), -0.189, 0.0),
            (power(5), -0.263, 0.0),
            (Kernel::Wyvill, -0.0128, 0.0625),
            (Kernel::Perlin, -0.0902, 0.0537),
            (Kernel::CubicSpline, -0.25, 0.0),
            (Kernel::QuinticSpline, -0.4001, 0.0),
            (Kernel::WendlandC2, -0.3185, 0.0),
            (Kernel::WendlandC4, -0.4077, 0.0),
            (Kernel::WendlandC6, -0.4766, 0.0),
            (Kernel::gaussian(3.0).expect("legal"), -0.183, 0.2963),
            (Kernel::gaussian(6.0).expect("legal"), -0.608, 0.2963),
        ];
        for (kernel, least, greatest) in known {
            let found = cubic_deviation(kernel);
            assert!((found.least - least).abs() < 2e-3, "{kernel}: {found:?}");
            assert!((found.greatest - greatest).abs() < 2e-3, "{kernel}: {found:?}");
        }
    }
}
