//! Generated scenes of any size: `name:count[:density[:seed]]`.
//!
//! A generator places balls and gives them relative sizes; their common scale follows from the
//! density, which means the same for all of them: the supports of so many other balls hold a ball's
//! centre, on average. All is made with exact operations from integers, so that a spec gives the
//! same balls on every platform. Some of them move: their still scene is frame 0.

mod cloud;
mod fountain;
mod lattice;
mod mud;
mod pool;
mod tornado;

use glam::Vec3;
use metaball_core::{Aabb, Camera, Kernel, Metaball, Scene};
use particle_files::framing;

use crate::cameras::{come_near, walk_around};
use crate::density::{Placed, scale_for};
use crate::error::LoadError;
use crate::random::Random;
use crate::{BenchScene, Kind};

/// The seed of specs that name none.
const SEED: u64 = 1;

/// The most balls a spec may ask for: 2²⁴, two gigabytes while they are placed.
const MOST_BALLS: usize = 1 << 24;

/// A way to fill space with balls.
#[derive(Debug)]
pub struct Generator {
    /// The first word of its spec.
    pub name: &'static str,
    /// One sentence on what it makes.
    pub about: &'static str,
    /// Mean number of other balls' supports that hold a ball's centre, where a spec names none.
    pub density: f64,
    /// The falloff.
    pub kernel: Kernel,
    /// T.
    pub threshold: f32,
    place: Place,
    /// From the middle of the balls to the eye.
    seen_from: Vec3,
    /// The path of cameras, from the balls' bounds and `seen_from`.
    path: fn(&Aabb, Vec3) -> Vec<Camera>,
}

/// Places so many balls.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Once and for all.
    Still(fn(usize, &mut Random) -> Vec<Placed>),
    /// At a time in seconds; the still scene's is 0.
    Moving(fn(usize, &mut Random, f64) -> Vec<Placed>),
}

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
            place: Place::Still(cloud::scattered),
            seen_from: Vec3::new(0.5, 0.35, 1.0),
            path: walk_around,
        },
        Generator {
            name: "random",
            about: "Balls of random radii at random in a cube (Kanamori, figure 1).",
            density: 3.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            place: Place::Still(cloud::random),
            seen_from: Vec3::new(0.5, 0.35, 1.0),
            path: walk_around,
        },
        Generator {
            name: "tornado",
            about: "A funnel of swirling bands over a skirt of dust, dense (Gourmel, figure 8a, b).",
            density: 45.0,
            kernel: Kernel::QUARTIC,
            threshold: 0.2,
            place: Place::Moving(tornado::tornado),
            seen_from: Vec3::new(0.0, 0.25, 1.0),
            path: walk_around,
        },
        Generator {
            name: "pool",
            about: "A tank of fluid with waves and a splash, dense (Gourmel, figure 8e).",
            density: 45.0,
            kernel: Kernel::QUARTIC,
            threshold: 0.2,
            place: Place::Still(pool::pool),
            seen_from: Vec3::new(0.4, 0.45, 1.0),
            path: walk_around,
        },
        Generator {
            name: "fountain",
            about: "Jets that rise, spread and fall into a basin (Kanamori, figure 12).",
            density: 12.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            place: Place::Moving(fountain::fountain),
            seen_from: Vec3::new(0.0, 0.35, 1.0),
            path: walk_around,
        },
        Generator {
            name: "mud",
            about: "A tongue of mud at the foot of a slope, seen from nearer and nearer (Illés and \
                    Szécsi, figure 7).",
            density: 20.0,
            kernel: Kernel::Wyvill,
            threshold: 0.5,
            place: Place::Still(mud::mud),
            seen_from: Vec3::new(1.0, 0.75, 0.55),
            path: come_near,
        },
    ];
    GENERATORS
}

/// What a spec asks for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe {
    generator: &'static Generator,
    count: usize,
    density: f64,
    seed: u64,
}

/// What `name:count[:density[:seed]]` asks for; `None` when the first word is no generator's.
pub(crate) fn parse(spec: &str) -> Result<Option<Recipe>, LoadError> {
    let (name, numbers) = spec.split_once(':').unwrap_or((spec, ""));
    let Some(generator) = generators().iter().find(|generator| generator.name == name) else {
        return Ok(None);
    };
    let refused = |part: &str, needed: String, found: &str| LoadError::Parameter {
        name: format!("{part} of {spec:?}"),
        needed,
        found: format!("{found:?}"),
    };

    let mut numbers = numbers.split(':');
    let count = numbers.next().unwrap_or_default();
    let density = numbers.next();
    let seed = numbers.next();
    if let Some(more) = numbers.next() {
        return Err(refused("end", format!("{name}:count[:density[:seed]]"), more));
    }
    let count =
        count.parse().ok().filter(|count: &usize| *count <= MOST_BALLS).ok_or_else(|| {
            refused("count", format!("a number of balls up to {MOST_BALLS}"), count)
        })?;
    let density = match density {
        None => generator.density,
        Some(text) => text
            .parse()
            .ok()
            .filter(|d: &f64| *d > 0.0)
            .ok_or_else(|| refused("density", "a number above 0".to_owned(), text))?,
    };
    let seed = match seed {
        None => SEED,
        Some(text) => text
            .parse()
            .map_err(|_| refused("seed", "an integer from 0 to 2⁶⁴ − 1".to_owned(), text))?,
    };
    // A ball has at most all others around it.
    if density + 1.0 >= count as f64 {
        let needed = format!("more than {} balls for a density of {density}", density + 1.0);
        return Err(refused("count", needed, &count.to_string()));
    }
    Ok(Some(Recipe { generator, count, density, seed }))
}

impl Generator {
    /// Whether its balls move.
    pub fn moves(&self) -> bool {
        matches!(self.place, Place::Moving(_))
    }
}

impl Recipe {
    /// The still scene.
    pub(crate) fn scene(&self) -> Result<BenchScene, LoadError> {
        let placed = self.placed(0.0);
        let scene = self.scaled(&placed, scale_for(&placed, self.density))?;
        let (bounds, seen_from) = (scene.bounds(), self.generator.seen_from);
        Ok(BenchScene {
            name: self.name(),
            about: self.generator.about.to_owned(),
            camera: framing(&bounds, seen_from),
            path: (self.generator.path)(&bounds, seen_from),
            kind: Kind::General,
            scene,
        })
    }

    /// The same with all its parts named.
    pub(crate) fn name(&self) -> String {
        format!("{}:{}:{}:{}", self.generator.name, self.count, self.density, self.seed)
    }

    pub(crate) fn generator(&self) -> &'static Generator {
        self.generator
    }

    /// From the middle of the balls to the eye.
    pub(crate) fn seen_from(&self) -> Vec3 {
        self.generator.seen_from
    }

    /// The scale of the balls at all times: that of the still scene.
    pub(crate) fn scale(&self) -> f64 {
        scale_for(&self.placed(0.0), self.density)
    }

    /// The balls after so many seconds.
    pub(crate) fn at(&self, time: f64, scale: f64) -> Result<Scene, LoadError> {
        self.scaled(&self.placed(time), scale)
    }

    fn placed(&self, time: f64) -> Vec<Placed> {
        let random = &mut Random::new(self.seed);
        match self.generator.place {
            Place::Still(place) => place(self.count, random),
            Place::Moving(place) => place(self.count, random, time),
        }
    }

    fn scaled(&self, placed: &[Placed], scale: f64) -> Result<Scene, LoadError> {
        let balls = placed
            .iter()
            .map(|ball| Metaball::new(ball.center.as_vec3(), (scale * ball.size) as f32));
        Ok(Scene::new(balls, self.generator.kernel, self.generator.threshold)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Overrides, load, mean_overlap};

    fn scene(spec: &str) -> Scene {
        load(spec, &Overrides::default()).expect("legal").scene
    }

    /// FNV-1a over the bits of all centres and radii.
    fn fingerprint(scene: &Scene) -> u64 {
        let numbers = scene.supports().iter().flat_map(|s| s.center.extend(s.radius).to_array());
        numbers
            .flat_map(|number| number.to_bits().to_le_bytes())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            })
    }

    /// Records of different machines may only be compared if their balls are the same, to the bit.
    #[test]
    fn a_spec_is_the_same_scene_everywhere() {
        let found: Vec<(&str, u64)> = generators()
            .iter()
            .map(|generator| {
                (generator.name, fingerprint(&scene(&format!("{}:500", generator.name))))
            })
            .collect();
        let expected = [
            ("scattered", 0x39714a8416b30f93),
            ("random", 0x1ab5b387e5eb617a),
            ("tornado", 0xf57f9ed8e0b09073),
            ("pool", 0x32461d46e849d0ba),
            ("fountain", 0xd975846822022b5b),
            ("mud", 0x2dc38b66b2662ed4),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn seeds_and_counts_change_the_balls() {
        for generator in generators() {
            let name = generator.name;
            let [one, two] = [1, 2].map(|seed| scene(&format!("{name}:300:20:{seed}")));
            assert_eq!(one.len(), 300);
            assert_ne!(fingerprint(&one), fingerprint(&two));
        }
    }

    /// The density is set over the same pairs that it is measured over, up to 2,828 balls all of them:
    /// what remains is the rounding of the radius to f32, a pair or two.
    #[test]
    fn the_density_is_what_the_spec_says() {
        for generator in generators() {
            for density in [2.0, 50.0] {
                let scene = scene(&format!("{}:1000:{density}", generator.name));
                let found = mean_overlap(&scene);
                assert!((found - density).abs() < 0.005, "{}: {found}", generator.name);
            }
        }
    }

    #[test]
    fn refusals_name_the_part_of_the_spec() {
        let refusal = |spec: &str| parse(spec).expect_err("refused").to_string();
        assert_eq!(
            refusal("pool"),
            "count of \"pool\": needed a number of balls up to 16777216, found \"\""
        );
        assert!(refusal("pool:x").contains("found \"x\""));
        assert!(refusal("pool:99999999").contains("needed a number of balls up to"));
        assert!(
            refusal("pool:100:-1").starts_with("density of \"pool:100:-1\": needed a number above")
        );
        assert!(refusal("pool:100:NaN").starts_with("density"));
        assert!(refusal("pool:100:5:1.5").starts_with("seed"));
        assert!(refusal("pool:100:5:1:2").starts_with("end"));
        assert_eq!(
            refusal("pool:20"),
            "count of \"pool:20\": needed more than 46 balls for a density of 45, found \"20\""
        );
        assert!(refusal("pool:20:inf").contains("needed more than inf balls"));
        assert!(parse("lake:20").expect("not a generator").is_none());
    }
}
