//! What is expected of every method at every value: the only table of stated limits.
//!
//! Whatever is not listed is expected to be right. A published method is listed where its paper says
//! that it fails, and the expectation fails when it no longer does; a robust or certified one where
//! its limit is, and there it must report it. *Broken* is a known defect: it is listed so that it is
//! not forgotten, and so that the test fails when it is mended.

use bench_scenes::Case;

use super::outcome::Outcome;
use super::outcome::Outcome::{Broken, Coarse, Reported, Right, SilentlyWrong};

/// From a value on, in the order of the case's values, this is the outcome of a method.
type From = (f64, Outcome);

/// A method's limit in a case.
type Limit = (&'static str, &'static [From]);

/// Negative balls are refused.
const CARVED: &[From] = &[(0.1, Reported)];

/// The limits of `illes`, and of `illes-compute`, which casts the same: those of its cubics, and of a running
/// sum that loses its digits away from the eye (section 4).
const RUNNING_CUBICS: &[Limit] = &[
    ("few", &[(1.0, SilentlyWrong), (0.0, Right)]),
    ("coincident", &[(33.0, Reported)]),
    ("overlapping", &[(33.0, Reported)]),
    ("concentric", &[(65.0, Reported)]),
    ("common-entry", &[(2.0, SilentlyWrong), (13.0, Right), (33.0, Reported)]),
    ("veiled", &[(13.0, SilentlyWrong), (14.0, Right), (65.0, SilentlyWrong)]),
    ("distance", &[(10.0, SilentlyWrong), (30.0, Right), (100.0, SilentlyWrong), (1e4, Broken)]),
    ("radius-ratio", &[(10.0, SilentlyWrong)]),
    ("background", &[(10.0, SilentlyWrong), (100.0, Right), (1e3, Broken)]),
    ("strength", &[(1.0, SilentlyWrong), (10.0, Right)]),
    ("exponent", &[(1.0, SilentlyWrong)]),
    ("cut", &[(1.0, SilentlyWrong)]),
    ("threshold-near-maximum", &[(1e-5, SilentlyWrong), (1e-6, Right)]),
    ("grazing", &[(1e-2, SilentlyWrong), (1e-3, Right), (1e-5, SilentlyWrong), (1e-6, Right)]),
    ("neck", &[(0.1, SilentlyWrong), (-0.1, Right), (1e-3, SilentlyWrong)]),
    ("sheet", &[(0.1, SilentlyWrong)]),
    ("kink", &[(1e-3, SilentlyWrong), (0.0, Right)]),
    ("carved", CARVED),
    ("effective-radii", &[(0.8, SilentlyWrong), (1.0, Right), (1.25, SilentlyWrong)]),
    ("wide-lens", &[(38.0, SilentlyWrong), (120.0, Right), (150.0, SilentlyWrong), (170.0, Right)]),
    ("narrow-lens", &[(38.0, SilentlyWrong), (1.0, Right)]),
    ("nudged", &[(0.5, SilentlyWrong)]),
    ("image", &[(2.0, SilentlyWrong)]),
    ("redrawn", &[(20.0, SilentlyWrong)]),
    ("shuffled", &[(20.0, SilentlyWrong)]),
];

/// The limits of `illes-rebuilt`.
///
/// Section 3: a cubic for the kernel, which is as far off at easy values as at hard ones: whether a ray is
/// wrong depends on where it passes. Section 6: an array of 96 separators, three a ball.
const CUBICS: &[Limit] = &[
    ("coincident", &[(33.0, Reported)]),
    ("overlapping", &[(33.0, Reported)]),
    ("concentric", &[(65.0, Reported)]),
    ("common-entry", &[(2.0, SilentlyWrong), (13.0, Right), (33.0, Reported)]),
    ("distance", &[(10.0, SilentlyWrong), (30.0, Right), (1e6, SilentlyWrong)]),
    ("radius-ratio", &[(10.0, SilentlyWrong)]),
    ("background", &[(10.0, SilentlyWrong), (100.0, Right)]),
    ("strength", &[(1.0, SilentlyWrong), (10.0, Right)]),
    ("exponent", &[(1.0, SilentlyWrong)]),
    ("cut", &[(1.0, SilentlyWrong)]),
    ("neck", &[(0.1, SilentlyWrong), (-0.1, Right), (1e-3, SilentlyWrong)]),
    ("sheet", &[(0.1, SilentlyWrong)]),
    ("carved", CARVED),
    ("effective-radii", &[(0.8, SilentlyWrong), (1.0, Right), (1.5, SilentlyWrong)]),
    ("wide-lens", &[(38.0, SilentlyWrong), (120.0, Right), (150.0, SilentlyWrong), (170.0, Right)]),
    ("narrow-lens", &[(38.0, SilentlyWrong), (1.0, Right)]),
    ("nudged", &[(0.5, SilentlyWrong)]),
    ("image", &[(2.0, SilentlyWrong)]),
    ("redrawn", &[(20.0, SilentlyWrong)]),
    ("shuffled", &[(20.0, SilentlyWrong)]),
];

/// The limits of `kanamori` and of `kanamori+fine`: a finer clipping helps neither against lists that are
/// too short nor against an f32 distance from 10⁶ radii away.
///
/// Section 7: points that coincide are lost, and more balls than a list of 14 holds are drawn as supports
/// (section 4.2).
const PEELING: &[Limit] = &[
    ("coincident", &[(2.0, SilentlyWrong)]),
    ("overlapping", &[(15.0, Reported)]),
    ("concentric", &[(65.0, Reported)]),
    ("common-entry", &[(2.0, SilentlyWrong)]),
    ("distance", &[(1e4, Coarse), (1e6, Broken)]),
    ("cut", &[(1.0, Reported)]),
    ("kink", &[(0.1, Reported)]),
    ("carved", CARVED),
];

/// The limits of each configuration, by case. An outcome holds to the end of the case's values or to the
/// next outcome; what is not listed is right. Measured on a software adapter.
const LIMITS: &[(&str, &[Limit])] = &[
    ("kanamori", PEELING),
    ("kanamori+fine", PEELING),
    // Undecided where it reports it: an f32 field this close to T.
    (
        "kanamori-robust",
        &[
            ("distance", &[(1e5, Coarse)]),
            ("threshold-near-zero", &[(1e-12, Reported)]),
            ("grazing", &[(1e-2, Reported), (1e-3, Right), (1e-5, Reported), (1e-6, Right)]),
            ("carved", CARVED),
        ],
    ),
    // Section 3: a surface into which no centre projects is missed. Broken: distances of 10⁶ radii, radii 10⁶
    // apart, strengths of 10⁶ T, T below 10⁻⁵, where a secant search in f32 is suspected and not looked into.
    (
        "bvh",
        &[
            ("distance", &[(10.0, SilentlyWrong), (30.0, Right), (1e4, Coarse), (1e6, Broken)]),
            ("radius-ratio", &[(10.0, SilentlyWrong), (1e3, Right), (1e6, Broken)]),
            ("strength", &[(1.0, SilentlyWrong), (10.0, Right), (1e6, Broken)]),
            ("exponent", &[(1.0, SilentlyWrong), (4.0, Right)]),
            ("threshold-near-zero", &[(0.1, SilentlyWrong), (1e-2, Right), (1e-6, Broken)]),
            ("threshold-near-maximum", &[(1e-5, Coarse), (1e-6, Right)]),
            ("neck", &[(0.1, SilentlyWrong), (-0.1, Right), (1e-3, SilentlyWrong)]),
            ("sheet", &[(-0.1, SilentlyWrong)]),
            ("carved", CARVED),
            ("effective-radii", &[(2.5, SilentlyWrong), (3.0, Right)]),
            ("nudged", &[(0.25, SilentlyWrong), (1e-2, Right)]),
        ],
    ),
    // The same.
    (
        "fbvh",
        &[
            ("distance", &[(10.0, SilentlyWrong), (30.0, Right), (1e4, Coarse), (1e6, Broken)]),
            ("radius-ratio", &[(10.0, SilentlyWrong), (1e3, Right), (1e6, Broken)]),
            ("strength", &[(1.0, SilentlyWrong), (10.0, Right), (1e6, Broken)]),
            ("exponent", &[(1.0, SilentlyWrong), (4.0, Right)]),
            (
                "threshold-near-zero",
                &[(0.1, SilentlyWrong), (1e-2, Right), (1e-8, Broken), (1e-12, Right)],
            ),
            ("neck", &[(0.1, SilentlyWrong), (-0.1, Right), (1e-3, SilentlyWrong)]),
            ("sheet", &[(-0.1, SilentlyWrong)]),
            ("carved", CARVED),
            ("effective-radii", &[(2.5, SilentlyWrong), (3.0, Right)]),
        ],
    ),
    // An f32 distance from afar; at T = 10⁻¹² the surface is where v is 10⁻⁶, a few roundings of 1.
    (
        "fbvh-certified",
        &[
            ("distance", &[(1e5, Coarse)]),
            ("threshold-near-zero", &[(1e-12, Reported)]),
            ("carved", CARVED),
        ],
    ),
    // f64 all the way, but for the t that is handed out.
    ("fbvh-certified-cpu", &[("distance", &[(1e5, Coarse)])]),
    (
        "kanamori-cpu",
        &[
            ("distance", &[(1e5, Coarse)]),
            ("cut", &[(1.0, Reported)]),
            ("kink", &[(0.1, Reported)]),
            ("carved", CARVED),
        ],
    ),
    ("illes", RUNNING_CUBICS),
    ("illes-rebuilt", CUBICS),
    // Degree six at most, and the same array; an f32 distance from afar.
    (
        "illes-exact",
        &[
            ("coincident", &[(33.0, Reported)]),
            ("overlapping", &[(33.0, Reported)]),
            ("concentric", &[(65.0, Reported)]),
            ("common-entry", &[(33.0, Reported)]),
            ("distance", &[(3e4, Coarse), (1e6, Broken)]),
            ("exponent", &[(4.0, Reported)]),
            ("cut", &[(1.0, Reported)]),
            ("kink", &[(0.1, Reported)]),
            ("carved", CARVED),
        ],
    ),
    // An array for ten balls.
    (
        "illes-exact+30",
        &[
            ("coincident", &[(13.0, Reported)]),
            ("overlapping", &[(13.0, Reported)]),
            ("concentric", &[(29.0, Reported)]),
            ("common-entry", &[(13.0, Reported)]),
            ("distance", &[(3e4, Coarse), (1e6, Broken)]),
            ("exponent", &[(4.0, Reported)]),
            ("cut", &[(1.0, Reported)]),
            ("kink", &[(0.1, Reported)]),
            ("carved", CARVED),
            ("effective-radii", &[(3.0, Reported)]),
            ("redrawn", &[(1000.0, Reported)]),
            ("shuffled", &[(1000.0, Reported)]),
        ],
    ),
    // Degree six at most; from 10⁶ radii away, an f32 distance is no better than a wrong front.
    (
        "illes-robust",
        &[
            ("distance", &[(3e4, Coarse), (1e6, Broken)]),
            ("exponent", &[(4.0, Reported)]),
            ("cut", &[(1.0, Reported)]),
            ("kink", &[(0.1, Reported)]),
            ("carved", CARVED),
        ],
    ),
    ("illes-compute", RUNNING_CUBICS),
];

/// What is expected of a configuration at one of the case's values.
pub fn expected(method: &str, case: &Case, value: f64) -> Outcome {
    let index = |value: f64| case.values.iter().position(|&known| known == value);
    let of_method = LIMITS.iter().filter(|(name, _)| *name == method);
    let mut of_case =
        of_method.flat_map(|(_, limits)| *limits).filter(|(name, _)| *name == case.name);
    let steps = of_case.next().map_or(&[][..], |(_, steps)| *steps);
    let mut reached = steps.iter().filter(|(from, _)| index(*from) <= index(value));
    reached.next_back().map_or(Right, |(_, outcome)| *outcome)
}

#[cfg(test)]
mod tests {
    use bench_scenes::cases;

    use super::*;
    use harness::configuration::variants::stability_configurations;

    #[test]
    fn every_limit_is_of_a_configuration_and_at_values_of_a_case() {
        for (method, limits) in LIMITS {
            assert!(
                stability_configurations()
                    .iter()
                    .any(|configuration| configuration.name == *method),
                "{method}"
            );
            for (name, steps) in *limits {
                let case = cases().iter().find(|case| case.name == *name);
                let values = case.unwrap_or_else(|| panic!("{method}: no case {name}")).values;
                let indices: Vec<_> = steps
                    .iter()
                    .map(|(value, _)| values.iter().position(|known| known == value))
                    .collect();
                assert!(indices.iter().all(Option::is_some), "{method}, {name}: {steps:?}");
                assert!(indices.is_sorted(), "{method}, {name}: {steps:?}");
            }
        }
    }

    #[test]
    fn an_outcome_holds_until_the_next() {
        let case = cases().iter().find(|case| case.name == "overlapping").expect("known");
        let at = |value| expected("kanamori", case, value);
        assert_eq!([at(14.0), at(15.0), at(140.0)], [Right, Reported, Reported]);
        assert_eq!(expected("no such configuration", case, 4096.0), Right);
    }
}
