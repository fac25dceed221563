//! What Kanamori et al. 2008 print.

/// A row of table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TotalTime {
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Number of balls.
    pub balls: u32,
    /// Milliseconds of the CPU version.
    pub cpu_ms: f64,
    /// Milliseconds of the GPU version.
    pub gpu_ms: f64,
}

const fn total(size: (u32, u32), balls: u32, cpu_ms: f64, gpu_ms: f64) -> TotalTime {
    TotalTime { size, balls, cpu_ms, gpu_ms }
}

/// The smaller of the two picture sizes.
pub const SMALL: (u32, u32) = (640, 480);
/// The larger.
const LARGE: (u32, u32) = (1024, 768);

/// Table 1: total rendering times.
pub const TABLE_1: &[TotalTime] = &[
    total(SMALL, 10_000, 589.5, 117.1),
    total(SMALL, 50_000, 1014.8, 191.6),
    total(SMALL, 100_000, 1469.5, 299.4),
    total(SMALL, 200_000, 2265.4, 523.6),
    total(LARGE, 10_000, 1455.8, 230.4),
    total(LARGE, 50_000, 2495.2, 366.3),
    total(LARGE, 100_000, 3593.9, 571.4),
    total(LARGE, 200_000, 5491.3, 980.4),
];

/// Frames a second that section 6 gives for a scene, and our scene instead of it.
pub const SHOWN: &[(&str, f64)] = &[
    ("random-1k", 23.1),
    ("two-merging", 150.0),
    ("five-close-up", 50.0),
    ("molecule", 22.9),
    ("fountain-100k", 6.2),
    ("fluid-120k", 4.7),
    ("fluid-close-up", 4.4),
];

/// Section 6: the relative root mean square error of t.
pub const ERROR_OF_T: f64 = 0.007;

/// Section 5.4: iterations of a search with theirs and with the form that it replaces, average and
/// maximum.
pub const SHORT_STACK_ITERATIONS: (f64, u32) = (2.3, 8);
/// See [`SHORT_STACK_ITERATIONS`].
pub const ITERATIVE_ITERATIONS: (f64, u32) = (16.4, 29);

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper prints the speed-up to one decimal: the digits of the scan agree with it.
    #[test]
    fn table_1_has_the_printed_speed_ups() {
        let printed = [5.0, 5.3, 4.9, 4.3, 6.3, 6.8, 6.3, 5.6];
        for (row, printed) in TABLE_1.iter().zip(printed) {
            assert!((row.cpu_ms / row.gpu_ms - printed).abs() <= 0.051, "{row:?}");
        }
    }
}
