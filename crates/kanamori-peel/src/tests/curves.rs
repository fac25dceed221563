//! Bernstein forms and Bézier clipping on the adapter, against f64.

use metaball_core::Kernel;
use metaball_core::gpu::Gpu;

use super::random::Random;
use super::records::{Record, evaluate, record_shader};
use crate::Clipping;

/// The value of a curve in Bernstein form, by de Casteljau in f64.
fn value(coefficients: &[f32], u: f64) -> f64 {
    let mut d: Vec<f64> = coefficients.iter().copied().map(f64::from).collect();
    while d.len() > 1 {
        d = d.windows(2).map(|pair| (1.0 - u) * pair[0] + u * pair[1]).collect();
    }
    d[0]
}

/// Random parts of random chords under every kernel that has a form. Along a chord v = 4a s(1−s);
/// the coefficients make at most 2α + 8 roundings of numbers up to the strength, two subdivisions
/// 3·2α each: below 128 · 2⁻²³ for α = 8.
#[test]
fn bernstein_forms_are_the_kernel() {
    const SOURCE: &str = record_shader!(
        "#import kanamori_peel::bernstein::{along_chord, degree}\n\
         #import kanamori_peel::bezier::part",
        "
                let curve = part(along_chord(record[0], record[1]), record[2], record[3]);
                for (var i = 0u; i <= degree(); i++) {
                    outcome[i] = curve.d[i];
                }"
    );
    let Some(gpu) = Gpu::for_test() else { return };
    let mut random = Random::new(1);
    let chords: Vec<Record> = (0..400)
        .map(|_| {
            let (low, high) = (random.unit(), random.unit());
            let mut chord = Record::default();
            chord[..4].copy_from_slice(&[
                random.unit(),
                0.1 + 2.0 * random.unit(),
                low.min(high),
                low.max(high),
            ]);
            chord
        })
        .collect();
    for kernel in Kernel::all() {
        let Some(degree) = kernel.degree_along_ray() else { continue };
        let curves = evaluate(&gpu, SOURCE, kernel, Clipping::ShortStack, &[], &chords);
        for (chord, curve) in chords.iter().zip(curves) {
            let [a, strength, low, high] = [0, 1, 2, 3].map(|index| f64::from(chord[index]));
            for step in 0..=20 {
                let u = f64::from(step) / 20.0;
                let s = low + (high - low) * u;
                let needed = strength * kernel.value(1.0 - 4.0 * a * s * (1.0 - s));
                let error = (value(&curve[..=degree], u) - needed).abs();
                let allowed = 128.0 * f64::from(f32::EPSILON) * strength;
                assert!(error <= allowed, "{kernel}, {chord:?} at {u}: {error:e}");
            }
        }
    }
}

/// Finds the first root of each curve: 0 to 1, or 2 where there is none.
const ROOTS: &str = record_shader!(
    "#import kanamori_peel::bernstein::{Curve, degree}\n\
     #import kanamori_peel::clipping::first_root",
    "
                var curve = Curve();
                for (var i = 0u; i <= degree(); i++) {
                    curve.d[i] = record[i];
                }
                outcome[0] = first_root(curve);"
);

/// Roots of curves of degree six with a threshold and, on the short stack, a stack size.
fn roots(
    gpu: &Gpu,
    curves: &[Record],
    clipping: Clipping,
    (threshold, stack_size): (f64, f64),
) -> Vec<f64> {
    let mut constants = vec![("33", threshold)];
    if clipping == Clipping::ShortStack {
        constants.push(("34", stack_size));
    }
    let roots = evaluate(gpu, ROOTS, Kernel::Wyvill, clipping, &constants, curves);
    roots.iter().map(|record| f64::from(record[0])).collect()
}

fn curve(coefficients: [f32; 7]) -> Record {
    let mut record = Record::default();
    record[..7].copy_from_slice(&coefficients);
    record
}

/// Random curves against a fine grid: the first grid cell with a change of sign holds the first
/// root, unless the curve comes so near to the axis before it, or nowhere else, that f32 cannot
/// tell; such curves are left out. Twenty subdivisions of seven roundings of numbers up to 1 err by
/// less than 200 · 2⁻²³ = 2.4e-5. The ways of clipping that the paper replaces also take a touch for a
/// root where the hull of a range as wide as the threshold w reaches the axis: control points of such a
/// range are within 120·w²/8 of the curve, whose second derivative is 30 second differences of at most 4.
#[test]
fn clipping_finds_the_first_root() {
    const STEPS: u32 = 4000;
    const ROUNDING: f64 = 2.4e-5;
    let Some(gpu) = Gpu::for_test() else { return };
    let mut random = Random::new(2);
    let curves: Vec<_> = (0..600)
        .map(|_| {
            let mut coefficients = [(); 7].map(|()| 2.0 * random.unit() - 1.0);
            coefficients[0] = -random.unit();
            curve(coefficients)
        })
        .collect();
    for (clipping, threshold, stack_size) in [
        (Clipping::ShortStack, 1e-3, 1.0),
        (Clipping::ShortStack, 1e-3, 3.0),
        (Clipping::ShortStack, 1e-4, 3.0),
        (Clipping::ShortStack, 1e-4, 4.0),
        (Clipping::Iterative, 1e-3, 0.0),
        (Clipping::Original, 1e-3, 0.0),
        (Clipping::Original, 1e-4, 0.0),
    ] {
        let (mut found, mut missed) = (0, 0);
        let unclear = match clipping {
            Clipping::ShortStack => ROUNDING,
            Clipping::Iterative | Clipping::Original => ROUNDING + 15.0 * threshold * threshold,
        };
        let roots = roots(&gpu, &curves, clipping, (threshold, stack_size));
        for (curve, root) in curves.iter().zip(roots) {
            let at = |step: u32| value(&curve[..7], f64::from(step) / f64::from(STEPS));
            let first = (1..=STEPS).find(|&step| at(step) >= 0.0);
            let before = (0..first.unwrap_or(STEPS + 1)).map(at).fold(f64::MIN, f64::max);
            let is_isolated = first.is_some_and(|step| at(step - 1) < 0.0);
            let Some(step) = first else {
                if before < -unclear {
                    assert_eq!(root, 2.0, "{curve:?}");
                    missed += 1;
                }
                continue;
            };
            // Near the root itself values are small; a touch before it would be a maximum.
            let touches = (1..step.saturating_sub(1))
                .any(|k| at(k) > -unclear && at(k) > at(k - 1) && at(k) > at(k + 1));
            if is_isolated && !touches {
                let error = (root - f64::from(step) / f64::from(STEPS)).abs();
                assert!(error <= threshold + 1.5 / f64::from(STEPS), "{curve:?}: {root} at {step}");
                found += 1;
            }
        }
        assert!(found > 200 && missed > 20, "{found} found, {missed} missed");
    }
}

/// (u − r)² − h², turned over, raised to degree six: roots r ∓ h, a double root for h = 0, none for
/// h² < 0. A quadratic's Bernstein coefficient of index i at degree six is
/// −(r² − h²) + 2r·i/6 − i(i − 1)/30.
#[test]
fn clipping_copes_with_tangents() {
    let Some(gpu) = Gpu::for_test() else { return };
    let touching = |r: f64, squared: f64| {
        let coefficient = |index: i32| {
            let i = f64::from(index);
            (squared - r * r + 2.0 * r * i / 6.0 - i * (i - 1.0) / 30.0) as f32
        };
        curve([0, 1, 2, 3, 4, 5, 6].map(coefficient))
    };
    for squared in [1e-2, 1e-4, 1e-5, -1e-5, -1e-4, -1e-2] {
        let roots_at: Vec<f64> = (4..=19).map(|index| f64::from(index) / 20.0 + 0.003).collect();
        let curves: Vec<_> = roots_at.iter().map(|&r| touching(r, squared)).collect();
        for stack_size in [1.0, 3.0] {
            for (r, root) in
                roots_at.iter().zip(roots(&gpu, &curves, Clipping::ShortStack, (1e-3, stack_size)))
            {
                if squared < 0.0 {
                    assert_eq!(root, 2.0, "touch at {r} from {squared:e} below");
                } else {
                    // The value moves by 2h a unit of u: 1e-6 of rounding is 2e-4 for h² = 1e-5.
                    let error = (root - (r - squared.sqrt())).abs();
                    assert!(error <= 1e-3 + 2e-4, "root {root} near {r} for {squared:e}");
                }
            }
        }
    }
}
