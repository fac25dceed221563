//! Bézier clipping as it was first published (Nishita, Sederberg and Kakimoto 1990): clip to where
//! the hull of the control points crosses the axis, again and again; where that removes too little,
//! split in two.

use super::bernstein::Coefficients;

/// Clipping that leaves more than this of a range is not worth it: the range is split.
const TOO_LITTLE: f64 = 0.8;

/// A search for roots, and what it has cost so far.
#[derive(Debug)]
pub(super) struct Search {
    threshold: f64,
    pub(super) searches: u64,
    pub(super) iterations: u64,
    pub(super) most_iterations: u64,
}

/// A part of the interval with its curve.
#[derive(Debug, Clone)]
struct Range {
    points: Coefficients,
    low: f64,
    width: f64,
}

impl Search {
    /// `threshold` is the width, in parts of the interval, at which a range is a root.
    pub(super) fn new(threshold: f64) -> Self {
        Self { threshold, searches: 0, iterations: 0, most_iterations: 0 }
    }

    /// The first u of [0, 1] at which the curve of this degree is not negative.
    pub(super) fn first_root(&mut self, points: &Coefficients, degree: usize) -> Option<f64> {
        let before = self.iterations;
        self.searches += 1;
        let root = self.search(points, degree);
        self.most_iterations = self.most_iterations.max(self.iterations - before);
        root
    }

    fn search(&mut self, points: &Coefficients, degree: usize) -> Option<f64> {
        // A range whose hull crosses the axis though no two ends differ may hold no root: it is
        // narrowed further before it counts as one that the curve touches.
        let touch = (self.threshold * self.threshold).max(1e-12);
        let mut waiting: Vec<Range> = Vec::new();
        let mut range = Range { points: *points, low: 0.0, width: 1.0 };
        loop {
            self.iterations += 1;
            if range.points[0] >= 0.0 {
                return Some(range.low);
            }
            let Some((from, to)) = hull_on_axis(&range.points[..=degree]) else {
                range = waiting.pop()?;
                continue;
            };
            let ends_differ = range.points[degree] >= 0.0;
            if range.width <= if ends_differ { self.threshold } else { touch } {
                return Some(range.low + if ends_differ { 0.5 * range.width } else { 0.0 });
            }
            if to - from > TOO_LITTLE {
                let right = range.part(degree, 0.5, 1.0);
                waiting.push(right);
                range = range.part(degree, 0.0, 0.5);
            } else {
                range = range.part(degree, from, to);
            }
        }
    }
}

impl Range {
    /// From `low` to `high` of this range, by two subdivisions of de Casteljau.
    fn part(&self, degree: usize, low: f64, high: f64) -> Self {
        let mut points = self.points;
        if low > 0.0 {
            for round in 1..=degree {
                for k in 0..=degree - round {
                    points[k] += low * (points[k + 1] - points[k]);
                }
            }
        }
        if high < 1.0 {
            let part = (high - low) / (1.0 - low);
            for round in 1..=degree {
                for k in (round..=degree).rev() {
                    points[k] = points[k - 1] + part * (points[k] - points[k - 1]);
                }
            }
        }
        Self { points, low: self.low + low * self.width, width: (high - low) * self.width }
    }
}

/// Where the convex hull of the control points, at equal steps over [0, 1], meets the axis: spanned
/// by the crossings of all lines between points on different sides.
fn hull_on_axis(points: &[f64]) -> Option<(f64, f64)> {
    let degree = (points.len() - 1) as f64;
    let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, &one) in points.iter().enumerate() {
        for (j, &other) in points.iter().enumerate().skip(i + 1) {
            if (one >= 0.0) != (other >= 0.0) {
                let crossing = (i as f64 + (j - i) as f64 * one / (one - other)) / degree;
                from = from.min(crossing);
                to = to.max(crossing);
            }
        }
    }
    (from <= to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::super::bernstein::MOST_DEGREE;
    use super::*;

    fn curve(points: &[f64]) -> (Coefficients, usize) {
        let mut all = [0.0; MOST_DEGREE + 1];
        all[..points.len()].copy_from_slice(points);
        (all, points.len() - 1)
    }

    fn root(points: &[f64]) -> Option<f64> {
        let (points, degree) = curve(points);
        Search::new(1e-6).first_root(&points, degree)
    }

    #[test]
    fn the_first_of_several_roots_is_found() {
        // (u − ¼)(u − ½)(u − ¾) in Bernstein form, from below.
        let found = root(&[-3.0 / 32.0, 13.0 / 96.0, -13.0 / 96.0, 3.0 / 32.0]).expect("a root");
        assert!((found - 0.25).abs() <= 1e-6, "{found}");
        assert_eq!(root(&[0.5, -1.0]), Some(0.0));
        assert_eq!(root(&[-1.0, -0.5, -1.0]), None);
    }

    /// −(u − ½)² touches the axis; lowered by 1e-6 it does not, though the hull crosses for long.
    #[test]
    fn a_double_root_counts_and_a_near_miss_does_not() {
        let touching = root(&[-0.25, 0.25, -0.25]).expect("touches");
        assert!((touching - 0.5).abs() < 1e-5, "{touching}");
        assert_eq!(root(&[-0.25 - 1e-6, 0.25 - 1e-6, -0.25 - 1e-6]), None);
    }
}
