use super::*;
use crate::Kernel;

const STEPS: usize = 20_000;

/// Depths of a fine lattice strictly between rim and centre.
fn depths() -> impl Iterator<Item = f64> {
    (1..STEPS).map(|step| step as f64 / STEPS as f64)
}

fn profiles() -> impl Iterator<Item = Kernel> {
    let gaussians = [1.0, 2.5, 4.75, 6.0].map(|cut| Kernel::gaussian(cut).expect("legal"));
    Kernel::all().filter(|kernel| kernel.profile().is_some()).chain(gaussians)
}

/// Value, slope and second derivative at v, in f64 and in f32, and the peak.
fn ask(kernel: Kernel, v: f64) -> ([f64; 3], [f64; 3], (f64, f64)) {
    let profile = kernel.profile().expect("all but Perlin's");
    let single = v as f32;
    (
        [profile.value(v), profile.slope(v), profile.bend(v)],
        [profile.value(single), profile.slope(single), profile.bend(single)].map(f64::from),
        profile.peak(),
    )
}

/// Central differences over h = 1e-6 err by h² times the next derivative but one, which away from the
/// centre is below 1e5 of the value it is of, and by rounding 1e-16/h.
#[test]
fn derivatives_are_those_of_the_value() {
    let h = 1e-6;
    for kernel in profiles() {
        for v in depths().step_by(7).filter(|v| (1e-3..0.99).contains(v)) {
            let ([_, slope, bend], ..) = ask(kernel, v);
            let ([before, steep_before, _], ..) = ask(kernel, v - h);
            let ([after, steep_after, _], ..) = ask(kernel, v + h);
            let difference = (after - before) / (2.0 * h);
            assert!((slope - difference).abs() < 1e-7, "slope of {kernel} at {v}");
            let difference = (steep_after - steep_before) / (2.0 * h);
            assert!((bend - difference).abs() < 2e-6 * (1.0 + bend), "bend of {kernel} at {v}");
        }
    }
}

#[test]
fn profiles_rise_ever_more() {
    for kernel in profiles() {
        let mut before = [0.0; 3];
        for v in depths() {
            let (now, single, (peak, at)) = ask(kernel, v);
            for (now, before) in now.into_iter().zip(before) {
                assert!(now >= before * (1.0 - 1e-14), "{kernel} at {v}");
            }
            before = now;
            let share = (1.0 - v) * now[2];
            assert!(share <= peak * (1.0 + 1e-5), "{kernel} at {v}: {share} over {peak}");
            let next = (1.0 - v - 1e-4) * ask(kernel, v + 1e-4).0[2];
            if (v - at).abs() > 1e-3 && v + 1e-4 < 1.0 {
                assert_eq!(next > share, v < at, "{kernel} at {v}");
            }
            // Sixteen units of itself, or what four of v do.
            let unit = f64::from(f32::EPSILON);
            for (k, single) in single.into_iter().enumerate().take(2) {
                let by_depth = now[k + 1].min(1e3) * 4.0 * unit;
                let error = (single - now[k]).abs();
                assert!(
                    error <= 16.0 * unit * now[k] + by_depth,
                    "{k} of {kernel} at {v}: {error}"
                );
            }
        }
        let ([value, ..], ..) = ask(kernel, 1.0);
        assert!((value - 1.0).abs() < 1e-14, "{kernel}");
    }
}
