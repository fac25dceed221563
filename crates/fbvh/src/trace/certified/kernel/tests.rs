//! Bounds of a ball on intervals of a ray, against the ball itself, in f64.

use proptest::prelude::*;

use super::super::bernstein::{inverse_binomials, value_and_rise};
use super::super::lanes::array_of;
use super::super::parabolas::UNIT;
use super::*;

/// An interval of a ray past a ball of radius 1 that it comes as close to as `off_axis`; t from there.
#[derive(Debug, Clone, Copy)]
struct Passage {
    off_axis: f64,
    start: f64,
    end: f64,
}

impl Passage {
    fn at(&self, share: f64) -> f64 {
        self.start + share * (self.end - self.start)
    }

    fn depth(&self, t: f64) -> f64 {
        1.0 - self.off_axis * self.off_axis - t * t
    }

    fn stretch(&self) -> Stretch {
        let lanes = |x: f64| Lanes::splat(x as f32);
        let middle = 1.0 - self.off_axis * self.off_axis - self.start * self.end;
        let margin = Lanes::splat(64.0 * UNIT * (1.0 + (self.start * self.end).abs() as f32));
        Stretch {
            v: [lanes(self.depth(self.start)), lanes(middle), lanes(self.depth(self.end))],
            peak: lanes(self.depth(0.0)),
            has_peak: Mask::from_bits(if self.start < 0.0 && self.end > 0.0 { !0 } else { 0 }),
            slopes: [lanes(-2.0 * self.start), lanes(-2.0 * self.end)],
            margin,
            slope_margin: margin,
        }
    }
}

/// What is bounded at some places of an interval, in parts of it.
struct Asked {
    passage: Passage,
    strength: f32,
    places: Vec<f64>,
}

/// Bounds at a place.
#[derive(Debug)]
struct AtPlace {
    most: f64,
    least: f64,
    /// What the slope is nowhere less than.
    slope: f64,
}

/// Bounds at the places, at the start and at the ends, and by how much rounding may move all of them.
struct Found {
    places: Vec<AtPlace>,
    start: f64,
    ends: [f64; 2],
    rounding: f64,
}

impl ByKernel for &Asked {
    type Output = Found;

    fn run<K: LaneKernel<N>, const N: usize>(self, kernel: K) -> Found {
        let stretch = self.passage.stretch();
        let reaches = !(stretch.top() + stretch.margin).is_at_most(Lanes::splat(0.0));
        let bounds = kernel.bounds(&stretch, Lanes::splat(self.strength), reaches);
        let one = |lanes: Lanes<f32>| f64::from(lanes.0[0]);
        let inverses = inverse_binomials::<N>();
        let most: [f64; N] = array_of(|k| one(bounds.most[k]) * inverses[k]);
        let least: [f64; N] = array_of(|k| one(bounds.least[k]) * inverses[k]);
        let rise = bounds.rise.map(one);
        let slope = |share: f64| match (K::BOUNDS_SLOPES, bounds.rises.any()) {
            (true, _) => rise[0] + share * (rise[1] - rise[0]),
            (false, true) => 0.0,
            (false, false) => f64::NEG_INFINITY,
        };
        let at = |&share: &f64| AtPlace {
            most: value_and_rise(most, share).0,
            least: value_and_rise(least, share).0,
            slope: slope(share),
        };
        let roundings = (4 * N + 64 + 4 * K::ROUNDINGS) as f64 * f64::from(UNIT);
        let size = most.iter().fold(0.0f64, |size, c| size.max(c.abs()))
            + one(bounds.magnitude)
            + one(bounds.steepness);
        Found {
            places: self.places.iter().map(at).collect(),
            start: one(bounds.start),
            ends: bounds.ends.map(one),
            rounding: one(bounds.error) + roundings * size,
        }
    }
}

/// What is wrong with the bounds, if the kernel's values were so many times what they are.
fn complaint(kernel: Kernel, asked: &Asked, times: f64) -> Option<String> {
    let Asked { passage, strength, ref places } = *asked;
    let found = by_kernel(kernel, asked).expect("lanes have it");
    let (strength, slack) = (times * f64::from(strength), found.rounding);
    let value = |t: f64| strength * kernel.value(1.0 - passage.depth(t));
    let slope = |t: f64| -2.0 * t * strength * -kernel.slope(1.0 - passage.depth(t));
    for (&share, bounds) in places.iter().zip(&found.places) {
        let t = passage.at(share);
        let (value, slope) = (value(t), slope(t));
        if value > bounds.most + slack || value < bounds.least - slack {
            return Some(format!("{value} at {share} of {passage:?}: {bounds:?}"));
        }
        if slope < bounds.slope - slack {
            return Some(format!("slope {slope} at {share} of {passage:?}: {bounds:?}"));
        }
    }
    if value(passage.start) > found.start + slack {
        return Some(format!(
            "{} at the start of {passage:?}: {}",
            value(passage.start),
            found.start
        ));
    }
    let ends = [passage.start, passage.end].map(value).into_iter().zip(found.ends);
    let mut below = ends.filter(|(value, least)| *value < least - slack);
    below.next().map(|(value, least)| format!("{value} at an end of {passage:?}: {least}"))
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn balls_are_within_their_bounds(
        kernel in prop::sample::select(
            Kernel::all().filter(|&kernel| has_bounds(kernel)).collect::<Vec<_>>(),
        ),
        off_axis in 0.0f64..1.1, start in -1.6f64..1.2,
        width in prop_oneof![0.0f64..2.0, 0.0f64..0.1, 1e-5f64..1e-3],
        strength in 0.1f32..4.0,
    ) {
        let passage = Passage { off_axis, start, end: start + width };
        let places = (0..=64).map(|step| f64::from(step) / 64.0).collect();
        let asked = Asked { passage, strength, places };
        let wrong = complaint(kernel, &asked, 1.0);
        prop_assert!(wrong.is_none(), "{}: {:?}", kernel, wrong);
        // Where the ball rises all the way its bounds meet it at the ends: a little more breaks them.
        if passage.end < 0.0 && passage.depth(passage.start) > 0.3 {
            prop_assert!(complaint(kernel, &asked, 1.03).is_some(), "{} and more", kernel);
            prop_assert!(complaint(kernel, &asked, 0.97).is_some(), "{} and less", kernel);
        }
    }
}
