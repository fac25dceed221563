//! The list of generators.

use glam::Vec3;
use metaball_core::Kernel;

use super::generator::{Generator, Layout};
use super::{cloud, fountain, mud, pool, tornado};
use crate::cameras::{approach, orbit};

/// All generators.
///
/// Gourmel's scenes (2010, figure 8) have their quartic at T = 0.2, Kanamori's (2008) have Wyvill's
/// kernel at T = 0.5, and so has Illés and Szécsi's, of which no threshold is printed; no paper gives
/// positions or radii.
pub fn generators() -> &'static [Generator] {
    const GENERATORS: &[Generator] = &[
        Generator {
            name: "scattered",
            about: "Equal balls at random in a cube, sparse (Gourmel, figure 8f).",
            density: 1.3,
            kernel: Kernel::QUARTIC,
            threshold: 0.2,
            layout: Layout::Still(cloud::scattered),
            seen_from: Vec3::new(0.5, 0.35, 1.0),
            path: orbit,
        },
        Generator {
            name: "random",
            about: "Balls of random radii at random in a cube (Kanamori, figure 1).",
            density: 3.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            layout: Layout::Still(cloud::random),
            seen_from: Vec3::new(0.5, 0.35, 1.0),
            path: orbit,
        },
        Generator {
            name: "tornado",
            about: "A funnel of swirling bands over a skirt of dust, dense (Gourmel, figure 8a, b).",
            density: 45.0,
            kernel: Kernel::QUARTIC,
            threshold: 0.2,
            layout: Layout::Moving(tornado::tornado),
            seen_from: Vec3::new(0.0, 0.25, 1.0),
            path: orbit,
        },
        Generator {
            name: "pool",
            about: "A tank of fluid with waves and a splash, dense (Gourmel, figure 8e).",
            density: 45.0,
            kernel: Kernel::QUARTIC,
            threshold: 0.2,
            layout: Layout::Still(pool::pool),
            seen_from: Vec3::new(0.4, 0.45, 1.0),
            path: orbit,
        },
        Generator {
            name: "fountain",
            about: "Jets that rise, spread and fall into a basin (Kanamori, figure 12).",
            density: 12.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            layout: Layout::Moving(fountain::fountain),
            seen_from: Vec3::new(0.0, 0.35, 1.0),
            path: orbit,
        },
        Generator {
            name: "mud",
            about: "A tongue of mud at the foot of a slope, seen from nearer and nearer (Illés and \
                    Szécsi, figure 7).",
            density: 20.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            layout: Layout::Still(mud::mud),
            seen_from: Vec3::new(1.0, 0.75, 0.55),
            path: approach,
        },
    ];
    GENERATORS
}
