//! The scenes that have a name.

use metaball_core::Kernel;
use particle_files::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, ReadOptions, framing, parse};

use crate::bench_scene::{BenchScene, Kind};
use crate::cameras::orbit;
use crate::error::LoadError;
use crate::figures::{self, ScenePath};
use crate::generate;
use crate::small::{self, Shot};

/// A scene that has a name.
#[derive(Debug)]
pub struct KnownScene {
    /// The spec that [`load`](crate::load()) takes.
    pub name: &'static str,
    /// One sentence on what it shows.
    pub about: &'static str,
    /// Whether it has at most a few hundred balls: tests run every method on these.
    pub small: bool,
    /// How strictly verdicts on its rays may be compared.
    pub kind: Kind,
    source: Source,
}

#[derive(Debug)]
enum Source {
    /// A generator's spec.
    Generated(&'static str),
    /// A file of this package, and where it is seen from (from the middle to the eye).
    Data(&'static str, &'static [u8], [f32; 3]),
    /// A figure of a paper, seen along a path.
    Figure(fn() -> Result<ScenePath, LoadError>),
    /// Made by hand.
    Small(fn() -> Result<Shot, LoadError>),
}

use Source::{Data, Figure, Generated, Small};

/// All known scenes, the large ones first.
pub fn known() -> &'static [KnownScene] {
    KNOWN
}

const fn large(name: &'static str, about: &'static str, source: Source) -> KnownScene {
    KnownScene { name, about, small: false, kind: Kind::General, source }
}

const fn small(name: &'static str, about: &'static str, source: Source) -> KnownScene {
    KnownScene { name, about, small: true, kind: Kind::General, source }
}

const fn clear(name: &'static str, about: &'static str, source: Source) -> KnownScene {
    KnownScene { name, about, small: true, kind: Kind::Clear, source }
}

const KNOWN: &[KnownScene] = &[
    large(
        "molecule",
        "Rhodopsin, 5,547 atoms with their hydrogens, in the colours of the elements.",
        Data("md_1u19.pdb.gz", include_bytes!("../data/md_1u19.pdb.gz"), [1.0, 0.15, 0.2]),
    ),
    large(
        "molecule-large",
        "A ribosome, 165,175 atoms, in the colours of the elements.",
        Data("6zu5.cif.gz", include_bytes!("../data/6zu5.cif.gz"), [0.5, 0.3, 1.0]),
    ),
    large(
        "dam-break",
        "A simulated dam break, 30,720 particles of water 0.6 s after the dam is gone.",
        Data("dam-break.balls", include_bytes!("../data/dam-break.balls"), [0.5, 0.4, 1.0]),
    ),
    large("scattered-30k", "30,000 equal balls, sparse.", Generated("scattered:30000")),
    large("scattered-100k", "100,000 equal balls, sparse.", Generated("scattered:100000")),
    large("tornado-4k", "A tornado of 4,000 balls, dense.", Generated("tornado:4000")),
    large("tornado-128k", "A tornado of 128,000 balls, dense.", Generated("tornado:128000")),
    large("pool-10k", "A tank of fluid of 10,000 balls, dense.", Generated("pool:10000")),
    large(
        "random-1k",
        "1,000 balls of random radii (Kanamori, figure 1).",
        Generated("random:1000"),
    ),
    large(
        "fluid-120k",
        "A tank of 120,000 balls (Kanamori, figure 10, left).",
        Figure(figures::fluid),
    ),
    large(
        "fluid-close-up",
        "The same from near, at the splash (Kanamori, figure 10, right).",
        Figure(figures::fluid_close_up),
    ),
    large(
        "fountain-100k",
        "A fountain of 100,000 balls (Kanamori, figure 12).",
        Generated("fountain:100000"),
    ),
    large("mud-200k", "A tongue of mud of 200,000 balls, in three views.", Generated("mud:200000")),
    small("one-power-1", "One ball, power kernel α = 1.", Small(|| small::one_power(1))),
    small("one-power-2", "One ball, power kernel α = 2.", Small(|| small::one_power(2))),
    small("one-power-3", "One ball, power kernel α = 3.", Small(|| small::one_power(3))),
    small("one-power-4", "One ball, power kernel α = 4.", Small(|| small::one_power(4))),
    small("one-power-5", "One ball, power kernel α = 5.", Small(|| small::one_power(5))),
    small("one-power-6", "One ball, power kernel α = 6.", Small(|| small::one_power(6))),
    small("one-power-7", "One ball, power kernel α = 7.", Small(|| small::one_power(7))),
    small("one-power-8", "One ball, power kernel α = 8.", Small(|| small::one_power(8))),
    small("one-wyvill", "One ball, Wyvill's kernel.", Small(|| small::one(Kernel::Wyvill))),
    small("one-perlin", "One ball, Perlin's kernel.", Small(|| small::one(Kernel::Perlin))),
    small(
        "two-cubic-spline",
        "Two balls with one surface, the cubic spline of SPH.",
        Small(|| small::two(Kernel::CubicSpline)),
    ),
    small("two-merging", "Two balls with one surface.", Small(small::two_merging)),
    small(
        "five-close-up",
        "Five balls that fill 80 % of the picture, Wyvill's kernel (Kanamori, section 6).",
        Small(figures::five_close_up),
    ),
    small(
        "fifteen-coincident",
        "Fifteen balls with one centre, one more than Kanamori's lists hold.",
        Small(small::fifteen_coincident),
    ),
    small(
        "far-from-origin",
        "Twelve balls of radius 1, more than 10,000 from the origin.",
        Small(small::far_from_origin),
    ),
    small(
        "radius-ratio-1000",
        "Forty balls on the surface of one a thousand times as large.",
        Small(small::radius_ratio_1000),
    ),
    small("random-200", "200 balls of random radii, Wyvill's kernel.", Generated("random:200")),
    small("strengths-100", "100 balls of strengths from 0.3 to 3.", Small(small::strengths)),
    small("colors-100", "The same with a colour for each ball.", Small(small::colors)),
    small(
        "eye-inside-support",
        "The eye in four supports but outside the surface.",
        Small(small::eye_inside_support),
    ),
    clear(
        "eye-inside-surface",
        "The eye in the solid: every ray is inside.",
        Small(small::eye_inside_surface),
    ),
    clear("empty", "No ball: an empty picture.", Small(small::empty)),
    clear(
        "threshold-too-high",
        "T above the field's maximum: an empty picture.",
        Small(small::threshold_too_high),
    ),
    clear("filling", "Three balls that fill the picture: every ray hits.", Small(small::filling)),
];

impl KnownScene {
    /// The generator's spec that it is a name for, if it is one.
    pub(crate) fn spec(&self) -> Option<&'static str> {
        match self.source {
            Generated(spec) => Some(spec),
            Data(..) | Figure(_) | Small(_) => None,
        }
    }

    /// Makes the scene.
    ///
    /// # Errors
    /// None that a test would not have found: the data are part of this package.
    pub fn scene(&self) -> Result<BenchScene, LoadError> {
        let (scene, camera, path) = match self.source {
            Generated(spec) => {
                let Some(recipe) = generate::parse(spec)? else {
                    unreachable!("{spec} names a generator");
                };
                let made = recipe.scene()?;
                (made.scene, made.camera, made.path)
            }
            Data(file, bytes, seen_from) => {
                let particles = parse(file, bytes, &ReadOptions::default())?;
                let scene = particles.into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD)?;
                let (bounds, seen_from) = (scene.bounds(), seen_from.into());
                (scene, framing(&bounds, seen_from), orbit(&bounds, seen_from))
            }
            Figure(make) => {
                let (scene, path) = make()?;
                (scene, path[0], path)
            }
            Small(make) => {
                let (scene, camera) = make()?;
                (scene, camera, Vec::new())
            }
        };
        Ok(BenchScene {
            name: self.name.to_owned(),
            about: self.about.to_owned(),
            scene,
            camera,
            path,
            kind: self.kind,
            file: None,
        })
    }
}
