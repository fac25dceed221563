//! Stability cases: scenes with one parameter that is turned until something breaks.
//!
//! Unless a case says otherwise, balls have radius 1 and strength 1, the kernel is the quartic, and
//! T = 0.25, so that a ball alone shows at the core radius 1/√2.

mod crowds;
mod extremes;
mod eyes;
mod pictures;
mod shapes;

use metaball_core::View;

use crate::error::LoadError;
use crate::random::Random;
use crate::small::Shot;
use crate::{BenchScene, Kind};

/// A family of scenes with a parameter.
#[derive(Debug)]
pub struct Case {
    /// What to ask for.
    pub name: &'static str,
    /// What it is about.
    pub subject: Subject,
    /// One sentence on what is hard about it.
    pub about: &'static str,
    /// What the number means, and its unit.
    pub parameter: &'static str,
    /// The numbers to try, from easy to hard.
    pub values: &'static [f64],
    /// Those of them that a quick look tries.
    pub quick: &'static [f64],
    /// Pixels across and down at a value.
    size: fn(f64) -> (u32, u32),
    /// What is drawn.
    pub drawing: Drawing,
    make: fn(f64) -> Result<Shot, LoadError>,
}

/// What a case is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Subject {
    /// Many balls over one point.
    Crowds,
    /// Distances, sizes, strengths and thresholds.
    Extremes,
    /// What is thin, near, or only just touched.
    Shapes,
    /// Where the eye is.
    Eyes,
    /// Lenses, image sizes, and drawing again.
    Pictures,
}

/// What is drawn of a case's scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Drawing {
    /// One frame.
    Once,
    /// The same frame twice, which should be the same to the last bit.
    Twice,
    /// A frame, and another of the [shuffled](BenchScene::shuffled) scene.
    Shuffled,
}

impl Subject {
    /// As a heading says it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Crowds => "Crowds over one point",
            Self::Extremes => "Distances, sizes and thresholds",
            Self::Shapes => "Thin, near and tangent",
            Self::Eyes => "The eye",
            Self::Pictures => "Lenses and pictures",
        }
    }
}

impl Case {
    /// The scene at a value of the parameter, one of `values` or any other.
    ///
    /// # Errors
    /// When the value makes no legal scene or camera, which none of `values` does.
    pub fn scene(&self, value: f64) -> Result<BenchScene, LoadError> {
        let (scene, camera) = (self.make)(value)?;
        Ok(BenchScene {
            name: format!("{}={value}", self.name),
            about: self.about.to_owned(),
            scene,
            camera,
            path: Vec::new(),
            kind: Kind::General,
        })
    }

    /// The scene and its view at a value: an odd number of pixels across and down wherever the
    /// number is not what the case is about, so that one ray is the view axis.
    ///
    /// # Errors
    /// As [`Case::scene`].
    pub fn view(&self, value: f64) -> Result<(BenchScene, View), LoadError> {
        let scene = self.scene(value)?;
        let (width, height) = (self.size)(value);
        let view = View::new(scene.camera, width, height)?;
        Ok((scene, view))
    }
}

impl BenchScene {
    /// The same balls in another order, without their colours.
    ///
    /// # Errors
    /// None that the scene itself would not have had.
    pub fn shuffled(&self) -> Result<Self, LoadError> {
        let mut balls: Vec<_> = self.scene.balls().collect();
        let mut random = Random::new(8);
        for last in (1..balls.len()).rev() {
            balls.swap(last, (random.unit() * (last + 1) as f64) as usize);
        }
        let scene = metaball_core::Scene::new(balls, self.scene.kernel(), self.scene.threshold())?;
        Ok(Self { scene, ..self.clone() })
    }
}

/// All cases, by subject.
pub fn cases() -> &'static [Case] {
    CASES
}

/// Pixels where nothing else is asked for.
const SIZE: fn(f64) -> (u32, u32) = |_| (33, 25);

/// Fewer where there are many balls on every ray.
const CROWD_SIZE: fn(f64) -> (u32, u32) = |count| if count < 500.0 { (33, 25) } else { (9, 7) };

/// Numbers of balls: Kanamori's list size K = 14 with its neighbours and its tenfold, and the balls
/// that fill the longest list of eight targets (29) and the array of Illés and Szécsi (32).
const COUNTS: &[f64] = &[1.0, 2.0, 13.0, 14.0, 15.0, 29.0, 30.0, 32.0, 33.0, 65.0, 140.0, 1000.0];

/// COUNTS and thousands.
const CROWDS: &[f64] =
    &[1.0, 2.0, 13.0, 14.0, 15.0, 29.0, 30.0, 32.0, 33.0, 65.0, 140.0, 1000.0, 2048.0, 4096.0];

/// Small numbers on both sides of nothing.
const AROUND_ZERO: &[f64] = &[0.1, -0.1, 1e-3, -1e-3, 1e-5, -1e-5, 1e-6, -1e-6, 0.0];

const CASES: &[Case] = &[
    Case {
        name: "few",
        subject: Subject::Crowds,
        about: "Almost no balls.",
        parameter: "number of balls",
        values: &[3.0, 2.0, 1.0, 0.0],
        quick: &[0.0],
        size: SIZE,
        drawing: Drawing::Once,
        make: crowds::few,
    },
    Case {
        name: "coincident",
        subject: Subject::Crowds,
        about: "So many equal balls at one place: lists and arrays overflow.",
        parameter: "number of balls",
        values: CROWDS,
        quick: &[2.0, 33.0],
        size: CROWD_SIZE,
        drawing: Drawing::Once,
        make: crowds::coincident,
    },
    Case {
        name: "crowd",
        subject: Subject::Crowds,
        about: "So many balls whose centres lie within a tenth of a radius.",
        parameter: "number of balls",
        values: CROWDS,
        quick: &[15.0, 33.0],
        size: CROWD_SIZE,
        drawing: Drawing::Once,
        make: crowds::crowd,
    },
    Case {
        name: "concentric",
        subject: Subject::Crowds,
        about: "Balls of different radii, from 1 to 2, with one centre.",
        parameter: "number of balls",
        values: COUNTS,
        quick: &[14.0],
        size: CROWD_SIZE,
        drawing: Drawing::Once,
        make: crowds::concentric,
    },
    Case {
        name: "common-entry",
        subject: Subject::Crowds,
        about: "Balls of different radii whose supports the view axis enters at one point (Kanamori, figure 9a).",
        parameter: "number of balls",
        values: COUNTS,
        quick: &[2.0],
        size: CROWD_SIZE,
        drawing: Drawing::Once,
        make: crowds::common_entry,
    },
    Case {
        name: "veiled",
        subject: Subject::Crowds,
        about: "So many weak balls in a row, below T, before the surface (Kanamori, figure 9c).",
        parameter: "number of balls",
        values: &[0.0, 1.0, 13.0, 14.0, 15.0, 65.0, 140.0, 1000.0],
        quick: &[65.0],
        size: CROWD_SIZE,
        drawing: Drawing::Once,
        make: crowds::veiled,
    },
    Case {
        name: "distance",
        subject: Subject::Extremes,
        about: "A pair of balls seen from afar through a lens that keeps their size.",
        parameter: "distance from the eye, radii",
        values: &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::distance,
    },
    Case {
        name: "offset",
        subject: Subject::Extremes,
        about: "A pair of balls and the eye, moved away from the origin together.",
        parameter: "offset on every axis, radii",
        values: &[0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::offset,
    },
    Case {
        name: "scale",
        subject: Subject::Extremes,
        about: "A pair of balls and the eye, all made larger or smaller.",
        parameter: "scale, radii",
        values: &[1.0, 1e-2, 1e2, 1e-4, 1e4, 1e-6, 1e6, 1e-9, 1e9, 1e-12, 1e12],
        quick: &[1e-6],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::scale,
    },
    Case {
        name: "radius-ratio",
        subject: Subject::Extremes,
        about: "A small ball that sits on a large one, seen from near.",
        parameter: "large radius over small radius",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e3],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::radius_ratio,
    },
    Case {
        name: "background",
        subject: Subject::Extremes,
        about: "One weak ball larger than the scene and the eye's distance, around twenty balls.",
        parameter: "radius of the large ball",
        values: &[10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        quick: &[1e4],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::background,
    },
    Case {
        name: "strength",
        subject: Subject::Extremes,
        about: "A strong ball beside one of strength 1.",
        parameter: "strength of the strong ball",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e8],
        quick: &[1e4],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::strength,
    },
    Case {
        name: "exponent",
        subject: Subject::Extremes,
        about: "A pair of balls under power kernels of growing degree.",
        parameter: "exponent of the kernel",
        values: &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
        quick: &[4.0],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::exponent,
    },
    Case {
        name: "threshold-near-zero",
        subject: Subject::Extremes,
        about: "The surface nears the rims of the supports.",
        parameter: "threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-12],
        quick: &[1e-5],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::threshold_near_zero,
    },
    Case {
        name: "threshold-near-maximum",
        subject: Subject::Extremes,
        about: "The surface shrinks to a speck at the centre; none is left at 0 and below.",
        parameter: "the field's maximum minus the threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0, -1e-3, -1.0],
        quick: &[1e-2],
        size: SIZE,
        drawing: Drawing::Once,
        make: extremes::threshold_near_maximum,
    },
    Case {
        name: "grazing",
        subject: Subject::Shapes,
        about: "The silhouette of a ball through the middle of the picture, nearer and nearer.",
        parameter: "half the height of the picture, radii",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
        quick: &[1e-2],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::grazing,
    },
    Case {
        name: "neck",
        subject: Subject::Shapes,
        about: "Two balls joined by a neck for positive values, apart for negative ones.",
        parameter: "the field in the middle over T, minus 1",
        values: AROUND_ZERO,
        quick: &[1e-3],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::neck,
    },
    Case {
        name: "sheet",
        subject: Subject::Shapes,
        about: "Five by five balls in a plane: a sheet for positive values, a net for negative ones.",
        parameter: "the field in the middle of four balls over T, minus 1",
        values: AROUND_ZERO,
        quick: &[1e-3],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::sheet,
    },
    Case {
        name: "two-levels",
        subject: Subject::Shapes,
        about: "Two balls over several thresholds: one surface, a neck, two, none (Illés and Szécsi, \
                figure 2).",
        parameter: "threshold",
        values: &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.1],
        quick: &[0.5, 1.1],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::two_levels,
    },
    Case {
        name: "effective-radii",
        subject: Subject::Shapes,
        about: "A lattice of balls whose radii are swept, from apart to one body (Illés and Szécsi, \
                figure 3).",
        parameter: "radius, spacings of the lattice",
        values: &[0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0],
        quick: &[1.25],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::effective_radii,
    },
    Case {
        name: "touching",
        subject: Subject::Shapes,
        about: "Two balls whose supports touch or nearly so; they overlap for negative values.",
        parameter: "gap between the supports, radii",
        values: AROUND_ZERO,
        quick: &[0.0],
        size: SIZE,
        drawing: Drawing::Once,
        make: shapes::touching,
    },
    Case {
        name: "eye-at-support",
        subject: Subject::Eyes,
        about: "The eye at the rim of a support, inside it for negative values.",
        parameter: "distance of the eye from the rim, radii",
        values: AROUND_ZERO,
        quick: &[0.0],
        size: SIZE,
        drawing: Drawing::Once,
        make: eyes::at_support,
    },
    Case {
        name: "eye-at-surface",
        subject: Subject::Eyes,
        about: "The eye at the surface, inside it for negative values.",
        parameter: "distance of the eye from the surface, radii",
        values: AROUND_ZERO,
        quick: &[-1e-3],
        size: SIZE,
        drawing: Drawing::Once,
        make: eyes::at_surface,
    },
    Case {
        name: "behind-the-eye",
        subject: Subject::Eyes,
        about: "A weak ball behind the image plane, whose support reaches before it up to 1.",
        parameter: "distance of its centre behind the eye, radii",
        values: &[0.01, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.1, 2.0, 10.0],
        quick: &[0.5],
        size: SIZE,
        drawing: Drawing::Once,
        make: eyes::behind,
    },
    Case {
        name: "wide-lens",
        subject: Subject::Pictures,
        about: "A wide lens before twenty balls.",
        parameter: "vertical field of view, degrees",
        values: &[38.0, 90.0, 120.0, 150.0, 170.0, 179.0, 179.9],
        quick: &[150.0],
        size: SIZE,
        drawing: Drawing::Once,
        make: pictures::lens,
    },
    Case {
        name: "narrow-lens",
        subject: Subject::Pictures,
        about: "A narrow lens before twenty balls.",
        parameter: "vertical field of view, degrees",
        values: &[38.0, 10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4],
        quick: &[0.1],
        size: SIZE,
        drawing: Drawing::Once,
        make: pictures::lens,
    },
    Case {
        name: "nudged",
        subject: Subject::Pictures,
        about: "The camera moved sideways by part of a pixel before twenty balls.",
        parameter: "part of a pixel",
        values: &[0.5, 0.25, 0.1, 1e-2, 1e-3, 1e-4],
        quick: &[0.25],
        size: SIZE,
        drawing: Drawing::Once,
        make: pictures::nudged,
    },
    Case {
        name: "image",
        subject: Subject::Pictures,
        about: "Twenty balls in pictures from one pixel to a strip 64 high.",
        parameter: "pixels across",
        values: &[1.0, 2.0, 64.0, 1024.0, 4096.0, 8192.0],
        quick: &[64.0],
        size: |across| (across.round() as u32, across.round().min(64.0) as u32),
        drawing: Drawing::Once,
        make: pictures::strip,
    },
    Case {
        name: "redrawn",
        subject: Subject::Pictures,
        about: "So many balls of random size; the same frame is drawn twice.",
        parameter: "number of balls",
        values: &[1.0, 20.0, 100.0, 1000.0],
        quick: &[20.0],
        size: SIZE,
        drawing: Drawing::Twice,
        make: pictures::cloud,
    },
    Case {
        name: "shuffled",
        subject: Subject::Pictures,
        about: "So many balls of random size, drawn in another order.",
        parameter: "number of balls",
        values: &[2.0, 20.0, 100.0, 1000.0],
        quick: &[20.0],
        size: SIZE,
        drawing: Drawing::Shuffled,
        make: pictures::cloud,
    },
];

/// A parameter that counts.
fn number(value: f64) -> usize {
    value.round() as usize
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use metaball_core::{Kernel, Metaball, Scene};

    use super::*;

    fn field(scene: &Scene, point: DVec3) -> f64 {
        let ball = |ball: Metaball| {
            let squared = point.distance_squared(ball.center.as_dvec3());
            let radius = f64::from(ball.radius);
            f64::from(ball.strength) * scene.kernel().value(squared / (radius * radius))
        };
        scene.balls().map(ball).sum()
    }

    fn case(name: &str) -> &'static Case {
        cases().iter().find(|case| case.name == name).expect("a case of that name")
    }

    #[test]
    fn every_value_makes_a_scene() {
        for case in cases() {
            assert!(case.values.len() >= 4, "{}: too few values to see a limit", case.name);
            for &value in case.values {
                let made = case.view(value);
                assert!(made.is_ok(), "{} at {value}: {made:?}", case.name);
            }
        }
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = cases().iter().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), cases().len());
    }

    #[test]
    fn impossible_values_are_refused() {
        assert!(case("scale").scene(f64::NAN).is_err());
        assert!(case("threshold-near-zero").scene(-1.0).is_err());
        assert!(case("wide-lens").scene(180.0).is_err());
    }

    /// The axis passes the ball at its silhouette, up to the rounding of the eye to f32, 6e-8; the top
    /// of the picture is as far above it as the value says, to a few roundings of the lens.
    #[test]
    fn grazing_is_as_near_as_it_says() {
        for &value in case("grazing").values {
            let (_, view) = case("grazing").view(value).expect("legal");
            let camera = view.camera();
            let core = Kernel::QUARTIC.ratio_at(0.25).expect("taken");
            assert!((f64::from(camera.eye().x) - core).abs() < 1.2e-7);
            assert!((3.0 * f64::from(camera.half_height()) / value - 1.0).abs() < 1e-6);
            assert_eq!((view.width() % 2, view.height() % 2), (1, 1));
        }
    }

    #[test]
    fn quick_values_are_values() {
        for case in cases() {
            assert!(!case.quick.is_empty(), "{}", case.name);
            for value in case.quick {
                assert!(case.values.contains(value), "{} at {value}", case.name);
            }
        }
    }

    #[test]
    fn cases_stand_by_subject() {
        assert!(cases().windows(2).all(|pair| pair[0].subject <= pair[1].subject));
    }

    #[test]
    fn shuffling_keeps_the_balls() {
        let scene = case("shuffled").scene(100.0).expect("legal");
        let shuffled = scene.shuffled().expect("legal");
        let sorted = |scene: &Scene| {
            let mut balls: Vec<_> = scene.balls().map(|ball| ball.center.to_array()).collect();
            balls.sort_by(|a, b| a[0].total_cmp(&b[0]));
            balls
        };
        assert_ne!(scene.scene, shuffled.scene);
        assert_eq!(sorted(&scene.scene), sorted(&shuffled.scene));
    }

    /// The roundings of centres and T to f32, 6e-8 each, times slopes up to 4.
    #[test]
    fn necks_and_sheets_are_as_thin_as_they_say() {
        for (name, point) in [("neck", DVec3::ZERO), ("sheet", DVec3::new(0.6, 0.6, 0.0))] {
            for &value in case(name).values {
                let scene = case(name).scene(value).expect("legal").scene;
                let found = field(&scene, point) / f64::from(scene.threshold()) - 1.0;
                assert!((found - value).abs() < 1e-6, "{name} at {value}: {found}");
            }
        }
    }

    /// What stands before the surface or around it must not be a surface itself.
    #[test]
    fn weak_balls_stay_below_the_threshold() {
        let veiled = case("veiled").scene(65.0).expect("legal");
        for step in 0..640 {
            let point = DVec3::new(0.0, 0.0, 0.1 * f64::from(step) + 0.1);
            assert!(field(&veiled.scene, point) < 0.2);
        }
        for &value in case("behind-the-eye").values {
            let made = case("behind-the-eye").scene(value).expect("legal");
            assert!(field(&made.scene, DVec3::ZERO) < 0.25);
        }
    }
}
