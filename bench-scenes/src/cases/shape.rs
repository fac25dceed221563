//! What is thin, near, or only just touched. No camera lies in a plane of symmetry, where points of
//! rays would coincide.

use glam::{DVec3, Vec3};
use metaball_core::{Camera, Kernel, Metaball, Scene};

use super::case::{AROUND_ZERO, Case, Category, SIZE};
use crate::error::LoadError;
use crate::small::{Shot, THRESHOLD, looking, quartic};

pub(super) const CASES: &[Case] = &[
    Case {
        name: "grazing",
        category: Category::Shape,
        about: "The silhouette of a ball through the middle of the picture, nearer and nearer.",
        parameter: "half the height of the picture, radii",
        values: &[0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
        quick: &[1e-2],
        size: SIZE,
        redraw: None,
        make: grazing,
    },
    Case {
        name: "neck",
        category: Category::Shape,
        about: "Two balls joined by a neck for positive values, apart for negative ones.",
        parameter: "the field in the middle over T, minus 1",
        values: AROUND_ZERO,
        quick: &[1e-3],
        size: SIZE,
        redraw: None,
        make: neck,
    },
    Case {
        name: "sheet",
        category: Category::Shape,
        about: "Five by five balls in a plane: a sheet for positive values, a net for negative ones.",
        parameter: "the field in the middle of four balls over T, minus 1",
        values: AROUND_ZERO,
        quick: &[1e-3],
        size: SIZE,
        redraw: None,
        make: sheet,
    },
    Case {
        name: "two-levels",
        category: Category::Shape,
        about: "Two balls over several thresholds: one surface, a neck, two, none (Illés and Szécsi, \
                figure 2).",
        parameter: "threshold",
        values: &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.1],
        quick: &[0.5, 1.1],
        size: SIZE,
        redraw: None,
        make: two_levels,
    },
    Case {
        name: "effective-radii",
        category: Category::Shape,
        about: "A lattice of balls whose radii are swept, from apart to one body (Illés and Szécsi, \
                figure 3).",
        parameter: "radius, spacings of the lattice",
        values: &[0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0],
        quick: &[1.25],
        size: SIZE,
        redraw: None,
        make: effective_radii,
    },
    Case {
        name: "touching",
        category: Category::Shape,
        about: "Two balls whose supports touch or nearly so; they overlap for negative values.",
        parameter: "gap between the supports, radii",
        values: AROUND_ZERO,
        quick: &[0.0],
        size: SIZE,
        redraw: None,
        make: touching,
    },
    Case {
        name: "kink",
        category: Category::Shape,
        about: "Two Gaussians, of which the rim of one, where its slope jumps, is near the surface of the other \
                or, for negative values, inside it.",
        parameter: "gap between the rim and the surface, radii",
        values: AROUND_ZERO,
        quick: &[1e-3, 0.0],
        size: SIZE,
        redraw: None,
        make: kink,
    },
    Case {
        name: "carved",
        category: Category::Shape,
        about: "A negative ball around the neck of two: it thins it for positive values, and cuts it through for \
                negative ones.",
        parameter: "the field in the middle over T, minus 1",
        values: AROUND_ZERO,
        quick: &[1e-3],
        size: SIZE,
        redraw: None,
        make: carved,
    },
];

/// Two balls so far to either side of the origin along x.
pub(super) fn pair(half_distance: f64) -> Result<Scene, LoadError> {
    let center = Vec3::X * half_distance as f32;
    quartic([-center, center].map(|center| Metaball::new(center, 1.0)))
}

/// One ball, whose silhouette stands upright in the middle of a picture `2 value` high.
fn grazing(value: f64) -> Result<Shot, LoadError> {
    const DISTANCE: f64 = 3.0;
    let core = Kernel::QUARTIC.ratio_at(f64::from(THRESHOLD)).unwrap_or(1.0);
    let scene = quartic([Metaball::new(Vec3::ZERO, 1.0)])?;
    let silhouette = Vec3::X * core as f32;
    let eye = silhouette + Vec3::Z * DISTANCE as f32;
    let fov = 2.0 * (value / DISTANCE).atan().to_degrees();
    Ok((scene, Camera::look_at(eye, silhouette, Vec3::Y, fov as f32)?))
}

fn neck(value: f64) -> Result<Shot, LoadError> {
    // Each ball gives half of the field in the middle.
    let each = 0.5 * f64::from(THRESHOLD) * (1.0 + value);
    let ratio = Kernel::QUARTIC.ratio_at(each).unwrap_or(1.0);
    Ok((pair(ratio)?, looking(Vec3::new(0.3, 0.2, 2.0), Vec3::ZERO)?))
}

/// The negative ball is so wide that it is the neck's middle where the field is least.
fn carved(value: f64) -> Result<Shot, LoadError> {
    const HALF_DISTANCE: f64 = 0.7;
    const RADIUS: f32 = 2.0;
    let added = 2.0 * Kernel::QUARTIC.value(HALF_DISTANCE * HALF_DISTANCE);
    let taken = added - f64::from(THRESHOLD) * (1.0 + value);
    let negative = Metaball { center: Vec3::ZERO, radius: RADIUS, strength: -taken as f32 };
    let scene = quartic(pair(HALF_DISTANCE)?.balls().chain([negative]))?;
    Ok((scene, looking(Vec3::new(0.3, 0.2, 4.0), Vec3::ZERO)?))
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

fn touching(value: f64) -> Result<Shot, LoadError> {
    Ok((pair(1.0 + 0.5 * value)?, looking(Vec3::new(0.3, 0.2, 6.0), Vec3::ZERO)?))
}

fn kink(value: f64) -> Result<Shot, LoadError> {
    let kernel = Kernel::gaussian(2.0)?;
    let core = kernel.ratio_at(f64::from(THRESHOLD)).unwrap_or(1.0);
    let scene = pair(0.5 * (1.0 + core + value))?.with_kernel(kernel);
    Ok((scene, looking(Vec3::new(1.2, 0.9, 4.0), Vec3::ZERO)?))
}

fn two_levels(value: f64) -> Result<Shot, LoadError> {
    let scene = pair(0.5)?.with_kernel(Kernel::Wyvill).with_threshold(value as f32)?;
    Ok((scene, looking(Vec3::new(0.7, 0.6, 5.0), Vec3::ZERO)?))
}

fn effective_radii(value: f64) -> Result<Shot, LoadError> {
    let sites = (0..75).map(|site| {
        Vec3::new((site % 5 - 2) as f32, (site / 25 - 1) as f32, (site / 5 % 5 - 2) as f32)
    });
    let scene = quartic(sites.map(|site| Metaball::new(site, value as f32)))?;
    Ok((scene.with_kernel(Kernel::Wyvill), looking(Vec3::new(6.0, 7.0, 12.0), Vec3::ZERO)?))
}
