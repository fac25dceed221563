//! Which points no other point dominates.

/// The corners of the dominated staircase of points (cost, error), both better when smaller: the
/// points that no other beats in one and equals or beats in the other, by rising cost.
pub(super) fn frontier(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted: Vec<_> = points
        .iter()
        .copied()
        .filter(|(cost, error)| cost.is_finite() && error.is_finite())
        .collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for point in sorted {
        if corners.last().is_none_or(|corner| point.1 < corner.1) {
            corners.push(point);
        }
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_undominated_points_are_corners() {
        let points = [(3.0, 1.0), (1.0, 5.0), (2.0, 5.0), (2.0, 3.0), (4.0, 1.0), (9.0, f64::NAN)];
        assert_eq!(frontier(&points), [(1.0, 5.0), (2.0, 3.0), (3.0, 1.0)]);
        assert!(frontier(&[]).is_empty());
    }
}
