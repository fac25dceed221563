//! Stability cases: scenes with one parameter that is turned until something breaks.
//!
//! Unless a case says otherwise, balls have radius 1 and strength 1, the kernel is the quartic, and
//! T = 0.25, so that a ball alone shows at the core radius 1/√2.

use glam::{DVec3, Vec3};
use metaball_core::{Camera, Kernel, Metaball, Scene};

use crate::error::LoadError;
use crate::random::Random;
use crate::small::{Shot, THRESHOLD, looking, quartic};
use crate::{BenchScene, Kind};

/// A scene with a parameter.
#[derive(Debug)]
pub struct Case {
    /// What to ask for.
    pub name: &'static str,
    /// One sentence on what is hard about it.
    pub about: &'static str,
    /// What the number means, and its unit.
    pub parameter: &'static str,
    /// The numbers to try, from easy to hard.
    pub values: &'static [f64],
    make: fn(f64) -> Result<Shot, LoadError>,
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
}

/// All cases.
pub fn cases() -> &'static [Case] {
    CASES
}

/// Numbers of balls, among them Kanamori's list size K = 14 with its neighbours and its tenfold.
const COUNTS: &[f64] = &[1.0, 2.0, 13.0, 14.0, 15.0, 32.0, 33.0, 64.0, 65.0, 139.0, 140.0];

/// COUNTS and crowds that only some variants claim.
const CROWDS: &[f64] =
    &[1.0, 2.0, 13.0, 14.0, 15.0, 32.0, 33.0, 64.0, 65.0, 139.0, 140.0, 141.0, 1000.0, 4096.0];

/// Small numbers on both sides of nothing.
const AROUND_ZERO: &[f64] = &[0.1, -0.1, 1e-3, -1e-3, 1e-5, -1e-5, 1e-6, -1e-6, 0.0];

const CASES: &[Case] = &[
    Case {
        name: "grazing",
        about: "The view axis passes a ball at its silhouette; inside it for positive values.",
        parameter: "depth of the axis below tangency, radii",
        values: &[0.1, -0.1, 1e-2, -1e-2, 1e-3, -1e-3, 1e-4, -1e-4, 1e-5, -1e-5, 1e-6, -1e-6],
        make: grazing,
    },
    Case {
        name: "two-levels",
        about: "Two balls over several thresholds: one surface, a neck, two, none (Illés and Szécsi, \
                figure 2).",
        parameter: "threshold",
        values: &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.1],
        make: |value| {
            let scene = pair(0.5)?.with_kernel(Kernel::Wyvill).with_threshold(value as f32)?;
            Ok((scene, looking(Vec3::new(0.0, 0.6, 5.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "effective-radii",
        about: "A lattice of balls whose radii are swept, from apart to one body (Illés and Szécsi, \
                figure 3).",
        parameter: "radius, spacings of the lattice",
        values: &[0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0],
        make: |value| {
            let sites = (0..75).map(|site| {
                Vec3::new((site % 5 - 2) as f32, (site / 25 - 1) as f32, (site / 5 % 5 - 2) as f32)
            });
            let scene = quartic(sites.map(|site| Metaball::new(site, value as f32)))?;
            Ok((scene.with_kernel(Kernel::Wyvill), looking(Vec3::new(6.0, 7.0, 12.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "coincident",
        about: "So many equal balls at one place: lists and arrays overflow.",
        parameter: "number of balls",
        values: CROWDS,
        make: |value| {
            let balls = vec![Metaball::new(Vec3::ZERO, 1.0); number(value)];
            Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "crowd",
        about: "So many balls whose centres lie within a tenth of a radius.",
        parameter: "number of balls",
        values: CROWDS,
        make: |value| {
            let mut random = Random::new(1);
            let balls = (0..number(value))
                .map(|_| Metaball::new(0.1 * random.in_ball().as_vec3(), 1.0))
                .collect::<Vec<_>>();
            Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "concentric",
        about: "Balls of different radii, from 1 to 2, with one centre.",
        parameter: "number of balls",
        values: COUNTS,
        make: |value| {
            let balls = radii(value).map(|radius| Metaball::new(Vec3::ZERO, radius));
            Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 7.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "common-entry",
        about: "Balls of different radii whose supports the view axis enters at one point \
                (Kanamori, figure 9a).",
        parameter: "number of balls",
        values: COUNTS,
        make: |value| {
            let balls = radii(value).map(|radius| Metaball::new(Vec3::NEG_Z * radius, radius));
            Ok((quartic(balls)?, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::NEG_Z)?))
        },
    },
    Case {
        name: "veiled",
        about: "So many weak balls in a row, below T, before the surface (Kanamori, figure 9c).",
        parameter: "number of balls",
        values: &[0.0, 1.0, 13.0, 14.0, 15.0, 65.0, 140.0, 1000.0],
        make: |value| {
            // Supports overlap in pairs: the field before the last ball stays at 0.14 or below.
            let last = number(value) as f32;
            let veil = (0..number(value)).map(|index| Metaball {
                center: Vec3::new(0.0, 0.0, last - index as f32 + 0.5),
                radius: 0.7,
                strength: 0.1,
            });
            let balls = veil.chain([Metaball::new(Vec3::NEG_Z, 1.0)]);
            // A lens that keeps the last ball's size.
            let (eye, distance) = (Vec3::Z * (last + 3.0), last + 4.0);
            let fov = 2.0 * (1.4 / distance).atan().to_degrees();
            Ok((quartic(balls)?, Camera::look_at(eye, Vec3::NEG_Z, Vec3::Y, fov)?))
        },
    },
    Case {
        name: "distance",
        about: "A pair of balls seen from afar through a lens that keeps their size.",
        parameter: "distance from the eye, radii",
        values: &[5.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 1e6],
        make: |value| {
            let fov = 2.0 * (1.6 / value).atan().to_degrees();
            let eye = Vec3::new(0.0, 0.0, value as f32);
            Ok((pair(0.5)?, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
        },
    },
    Case {
        name: "offset",
        about: "A pair of balls and the eye, moved away from the origin together.",
        parameter: "offset on every axis, radii",
        values: &[0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        make: |value| {
            let offset = Vec3::splat(value as f32);
            let balls = [-0.5, 0.5].map(|x| Metaball::new(offset + Vec3::X * x, 1.0));
            Ok((quartic(balls)?, looking(offset + Vec3::new(0.0, 0.0, 5.0), offset)?))
        },
    },
    Case {
        name: "scale",
        about: "A pair of balls and the eye, all made larger or smaller.",
        parameter: "scale, radii",
        values: &[1.0, 1e-2, 1e2, 1e-4, 1e4, 1e-6, 1e6, 1e7, 1e-12, 1e12],
        make: |value| {
            let scale = value as f32;
            let balls = [-0.5, 0.5].map(|x| Metaball::new(Vec3::X * (x * scale), scale));
            Ok((quartic(balls)?, looking(Vec3::Z * (5.0 * scale), Vec3::ZERO)?))
        },
    },
    Case {
        name: "radius-ratio",
        about: "A small ball that sits on a large one, seen from near.",
        parameter: "large radius over small radius",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e8],
        make: |value| {
            let small = value.recip() as f32;
            let surface = std::f32::consts::FRAC_1_SQRT_2;
            let top = Vec3::Z * (surface + 0.5 * small);
            let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(top, small)];
            let eye = top + small * Vec3::new(1.0, 1.5, 4.0);
            Ok((quartic(balls)?, looking(eye, top)?))
        },
    },
    Case {
        name: "threshold-near-zero",
        about: "The surface nears the rims of the supports.",
        parameter: "threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-12],
        make: |value| {
            let scene = pair(0.8)?.with_threshold(value as f32)?;
            Ok((scene, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "threshold-near-maximum",
        about: "The surface shrinks to a speck at the centre; none is left at 0 and below.",
        parameter: "the field's maximum minus the threshold",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0, -1e-3, -1.0],
        make: |value| {
            let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
            let scene = scene.with_threshold((1.0 - value) as f32)?;
            // The quartic is 1 − 2r²: the speck fills half the picture's height while it is there.
            let speck = (0.5 * value.max(1e-6)).sqrt();
            let fov = 2.0 * (2.0 * speck / 3.0).atan().to_degrees();
            let eye = Vec3::new(0.0, 0.0, 3.0);
            Ok((scene, Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov as f32)?))
        },
    },
    Case {
        name: "neck",
        about: "Two balls joined by a neck for positive values, apart for negative ones.",
        parameter: "the field in the middle over T, minus 1",
        values: AROUND_ZERO,
        make: |value| {
            // Each ball gives half of the field in the middle.
            let each = 0.5 * f64::from(THRESHOLD) * (1.0 + value);
            let ratio = Kernel::QUARTIC.ratio_at(each).unwrap_or(1.0);
            Ok((pair(ratio)?, looking(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "sheet",
        about: "Five by five balls in a plane: a sheet for positive values, a net for negative ones.",
        parameter: "the field in the middle of four balls over T, minus 1",
        values: AROUND_ZERO,
        make: sheet,
    },
    Case {
        name: "touching",
        about: "Two balls whose supports touch or nearly so; they overlap for negative values.",
        parameter: "gap between the supports, radii",
        values: AROUND_ZERO,
        make: |value| {
            Ok((pair(1.0 + 0.5 * value)?, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "eye-at-support",
        about: "The eye at the rim of a support, inside it for negative values.",
        parameter: "distance of the eye from the rim, radii",
        values: AROUND_ZERO,
        make: |value| eye_at(1.0 + value),
    },
    Case {
        name: "eye-at-surface",
        about: "The eye at the surface, inside it for negative values.",
        parameter: "distance of the eye from the surface, radii",
        values: AROUND_ZERO,
        make: |value| eye_at(std::f64::consts::FRAC_1_SQRT_2 + value),
    },
    Case {
        name: "behind-the-eye",
        about: "A weak ball behind the image plane, whose support reaches before it up to 1.",
        parameter: "distance of its centre behind the eye, radii",
        values: &[0.01, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.1, 2.0, 10.0],
        make: |value| {
            let behind = Metaball { center: Vec3::Z * value as f32, radius: 1.0, strength: 0.2 };
            let balls = [behind, Metaball::new(Vec3::NEG_Z * 1.5, 1.0)];
            Ok((quartic(balls)?, looking(Vec3::ZERO, Vec3::NEG_Z)?))
        },
    },
    Case {
        name: "background",
        about: "One weak ball larger than the scene and the eye's distance, around twenty balls.",
        parameter: "radius of the large ball",
        values: &[10.0, 100.0, 1e3, 1e4, 1e5, 1e6],
        make: |value| {
            let large = Metaball { center: Vec3::ZERO, radius: value as f32, strength: 0.2 };
            let mut random = Random::new(6);
            let balls = (0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0));
            let scene = quartic([large].into_iter().chain(balls))?;
            Ok((scene, looking(Vec3::new(0.0, 2.0, 8.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "strength",
        about: "A strong ball beside one of strength 1.",
        parameter: "strength of the strong ball",
        values: &[1.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e8],
        make: |value| {
            let strong =
                Metaball { center: Vec3::NEG_X * 0.8, radius: 1.0, strength: value as f32 };
            let scene = quartic([strong, Metaball::new(Vec3::X * 0.8, 1.0)])?;
            Ok((scene, looking(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO)?))
        },
    },
    Case {
        name: "field-of-view",
        about: "A wide or a narrow lens before twenty balls.",
        parameter: "vertical field of view, degrees",
        values: &[38.0, 90.0, 150.0, 170.0, 179.0, 10.0, 1.0, 0.1, 0.01],
        make: |value| {
            let mut random = Random::new(7);
            let balls = (0..20).map(|_| Metaball::new(2.0 * random.in_ball().as_vec3(), 1.0));
            let eye = Vec3::new(0.3, 0.2, 6.0);
            let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, value as f32)?;
            Ok((quartic(balls.collect::<Vec<_>>())?, camera))
        },
    },
    Case {
        name: "few",
        about: "Almost no balls.",
        parameter: "number of balls",
        values: &[3.0, 2.0, 1.0, 0.0],
        make: |value| {
            let balls = (0..number(value)).map(|index| Metaball::new(Vec3::X * index as f32, 1.0));
            Ok((quartic(balls)?, looking(Vec3::new(1.0, 0.0, 6.0), Vec3::X)?))
        },
    },
];

/// A parameter that counts.
fn number(value: f64) -> usize {
    value.round() as usize
}

/// So many radii at equal steps from 1 to 2.
fn radii(value: f64) -> impl Iterator<Item = f32> {
    let last = (number(value).max(2) - 1) as f32;
    (0..number(value)).map(move |index| 1.0 + index as f32 / last)
}

/// Two balls so far to either side of the origin along x.
fn pair(half_distance: f64) -> Result<Scene, LoadError> {
    let center = Vec3::X * half_distance as f32;
    quartic([-center, center].map(|center| Metaball::new(center, 1.0)))
}

/// One ball that the view axis passes by its core radius less `value` from its centre.
fn grazing(value: f64) -> Result<Shot, LoadError> {
    let core = Kernel::QUARTIC.ratio_at(f64::from(THRESHOLD)).unwrap_or(1.0);
    let right = (value - core) as f32;
    let scene = quartic([Metaball::new(Vec3::X * right, 1.0)])?;
    Ok((scene, looking(Vec3::Z * 3.0, Vec3::ZERO)?))
}

fn sheet(value: f64) -> Result<Shot, LoadError> {
    // So wide that the field is least in the middle of four balls.
    const SPACING: f64 = 1.2;
    const HALF: i32 = 2;
    let sites = (-HALF..=HALF).flat_map(|row| {
        (-HALF..=HALF)
            .map(move |column| SPACING * DVec3::new(f64::from(column), f64::from(row), 0.0))
    });
    let middle = SPACING * DVec3::new(0.5, 0.5, 0.0);
    let field: f64 =
        sites.clone().map(|site| Kernel::QUARTIC.value(site.distance_squared(middle))).sum();
    let scene = quartic(sites.map(|site| Metaball::new(site.as_vec3(), 1.0)))?
        .with_threshold((field / (1.0 + value)) as f32)?;
    Ok((scene, looking(Vec3::new(1.5, 3.0, 9.0), Vec3::ZERO)?))
}

/// One ball seen along −z from so far off its centre.
fn eye_at(distance: f64) -> Result<Shot, LoadError> {
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let eye = Vec3::Z * distance as f32;
    Ok((scene, Camera::look_at(eye, eye - Vec3::Z, Vec3::Y, 90.0)?))
}

#[cfg(test)]
mod tests {
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
                let made = case.scene(value);
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
        assert!(case("field-of-view").scene(180.0).is_err());
    }

    /// Up to the rounding of the centre to f32, 6e-8.
    #[test]
    fn grazing_is_as_near_as_it_says() {
        for &value in case("grazing").values {
            let made = case("grazing").scene(value).expect("legal");
            let center = f64::from(made.scene.ball(0).center.x);
            let core = Kernel::QUARTIC.ratio_at(0.25).expect("taken");
            assert!((core - center.abs() - value).abs() < 1.2e-7);
        }
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
