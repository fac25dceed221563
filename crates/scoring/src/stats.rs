//! Order statistics, and how quantities grow.

/// The value below which the given share of the numbers lies, by linear interpolation between
/// neighbours (Hyndman and Fan's type 7, as in NumPy). `sorted` rises; `share` is from 0 to 1.
/// `None` of no numbers.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let position = share.clamp(0.0, 1.0) * last as f64;
    let below = position.floor() as usize;
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    // Equal neighbours first: between two infinities there is nothing to interpolate.
    Some(if low == high { low } else { low + (high - low) * position.fract() })
}

/// The numbers in rising order, NaN last.
pub fn sorted(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// The median; `None` of no numbers.
pub fn median(numbers: &[f64]) -> Option<f64> {
    quantile(&sorted(numbers.to_vec()), 0.5)
}

/// The exponent p of the power law y ~ xᵖ through the points: the slope of the line of least squares
/// through their logarithms. `None` of fewer than two different x, or where a number is not above 0.
pub fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    if points.iter().any(|&(x, y)| x.is_nan() || y.is_nan() || x <= 0.0 || y <= 0.0) {
        return None;
    }
    let logs: Vec<_> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(|log| log.0), mean(|log| log.1));
    let spread: f64 = logs.iter().map(|log| (log.0 - x_mean).powi(2)).sum();
    let shared: f64 = logs.iter().map(|log| (log.0 - x_mean) * (log.1 - y_mean)).sum();
    (spread > 0.0).then(|| shared / spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate() {
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[7.0], 0.25), Some(7.0));
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.25), Some(1.75));
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 1.0), Some(4.0));
        assert_eq!(quantile(&[1.0, f64::INFINITY, f64::INFINITY], 0.9), Some(f64::INFINITY));
    }

    #[test]
    fn medians_need_no_order() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn power_laws_have_their_exponents() {
        let law = |p: f64| [1.0, 3.0, 10.0].map(|x: f64| (x, 7.0 * x.powf(p)));
        for p in [-0.5, 0.0, 1.0, 2.0] {
            assert!((exponent(&law(p)).expect("three points") - p).abs() < 1e-12);
        }
        assert_eq!(exponent(&[(1.0, 1.0)]), None);
        assert_eq!(exponent(&[(1.0, 1.0), (2.0, 0.0)]), None);
    }
}
