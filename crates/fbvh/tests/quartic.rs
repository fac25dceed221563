//! The bounds of the polynomial test, `shaders/wgsl/fbvh/polynomial_test/quartic.wgsl`, formed in f32 as
//! the shader does, enclose the field in f64.

use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// The unit of the shader's margins.
const UNIT: f32 = f32::EPSILON;

/// A ball of the kernel (1 − r²/R²)², seen from the ray's origin.
#[derive(Debug, Clone, Copy)]
struct Ball {
    offset: Vec3,
    radius: f32,
    strength: f32,
}

/// Bernstein coefficients of what is nowhere below the field on an interval, and nowhere above.
struct Bounds {
    upper: [f32; 5],
    lower: [f32; 5],
}

/// The sums of the polynomial test.
fn bounds(balls: &[Ball], direction: Vec3, low: f32, high: f32) -> Bounds {
    let (mut most, mut least) = ([0.0f32; 5], [0.0f32; 5]);
    let mut error = 0.0f32;
    for ball in balls {
        let middle = ball.offset.dot(direction);
        let off_square = (ball.offset - middle * direction).length_squared();
        let inverse_radius = 1.0 / ball.radius;
        let inverse_square = inverse_radius * inverse_radius;
        let (to_start, to_end) = (low - middle, high - middle);
        let along = [to_start * to_start, to_start * to_end, to_end * to_end];
        let s = along.map(|along| (off_square + along) * inverse_square);
        let farthest = s[0].max(s[2]);
        let part = 6.0 * UNIT * ball.offset.length() * inverse_radius;
        let margin = UNIT * (1.0 + 10.0 * farthest) + part * (2.0 * farthest.sqrt() + part);
        let near = middle.clamp(low, high) - middle;
        if 1.0 - (off_square + near * near) * inverse_square + margin <= 0.0 {
            continue;
        }
        let [x, y, z] = s.map(|s| (1.0 - s).max(0.0));
        let terms = [x * x, x * y, (2.0 * y * y + x * z) * (1.0 / 3.0), y * z, z * z];
        let covers = 1.0 - farthest >= 2.0 * margin;
        for (k, term) in terms.into_iter().enumerate() {
            most[k] += ball.strength * term;
            least[k] += if covers { ball.strength * term } else { 0.0 };
        }
        error += 2.0 * ball.strength * margin * (x.max(y).max(z) + margin);
    }
    let summing = (balls.len() + 24) as f32 * UNIT;
    let error = error * (1.0 + summing);
    Bounds {
        upper: most.map(|sum| sum * (1.0 + summing) + error),
        lower: least.map(|sum| sum * (1.0 - summing) - error),
    }
}

/// The polynomial with these coefficients, at a part of the interval.
fn value(coefficients: [f32; 5], x: f64) -> f64 {
    let binomials = [1.0, 4.0, 6.0, 4.0, 1.0];
    let term = |k: usize| {
        binomials[k] * x.powi(k as i32) * (1.0 - x).powi(4 - k as i32) * f64::from(coefficients[k])
    };
    (0..5).map(term).sum()
}

fn field(balls: &[Ball], direction: Vec3, t: f64) -> f64 {
    let point: DVec3 = t * direction.as_dvec3();
    let part = |ball: &Ball| {
        let ratio = (ball.offset.as_dvec3() - point).length() / f64::from(ball.radius);
        f64::from(ball.strength) * (1.0 - ratio * ratio).max(0.0).powi(2)
    };
    balls.iter().map(part).sum()
}

fn vectors(size: f32) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from)
}

fn any_ball() -> impl Strategy<Value = Ball> {
    // Down to a sixteenth of the leaf, and as near to a rim as may be.
    (vectors(1.0), 0.1f32..1.5, 0.1f32..4.0, any::<bool>()).prop_map(
        |(offset, radius, strength, grazes)| {
            let radius = if grazes { offset.length() * (1.0 + 1e-6) } else { radius };
            Ball { offset, radius: radius.max(0.05), strength }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn the_field_is_between(
        balls in prop::collection::vec(any_ball(), 1..12),
        toward in vectors(1.0),
        start in -1.0f32..1.0,
        length in prop::sample::select(vec![1.5f32, 0.3, 1e-2, 1e-4]),
    ) {
        prop_assume!(toward.length() > 0.1);
        let direction = toward.normalize();
        let (low, high) = (start, start + length);
        let Bounds { upper, lower } = bounds(&balls, direction, low, high);
        for step in 0..=64 {
            let x = f64::from(step) / 64.0;
            let t = f64::from(low) + x * (f64::from(high) - f64::from(low));
            let (least, most) = (value(lower, x), value(upper, x));
            let here = field(&balls, direction, t);
            prop_assert!(least <= here && here <= most, "{least} {here} {most} at {x}");
        }
    }
}

/// A margin without which the test above would fail: rounding does reach beyond the bare sums.
#[test]
fn rounding_is_not_nothing() {
    let ball = Ball { offset: Vec3::new(0.3, 0.7, -0.2), radius: 0.9, strength: 1.0 };
    let direction = Vec3::new(1.0, 2.0, 3.0).normalize();
    let beyond = (0..200).any(|step| {
        let low = 0.01 * step as f32 - 1.0;
        let middle = ball.offset.dot(direction);
        let off_square = (ball.offset - middle * direction).length_squared();
        let v = 1.0 - (off_square + (low - middle).powi(2)) / (ball.radius * ball.radius);
        f64::from(v.max(0.0).powi(2)) < field(&[ball], direction, f64::from(low))
    });
    assert!(beyond);
}
