//! What the fuzz target does with its bytes; `tests/fuzz.rs` runs it over a corpus of its own.
//!
//! The first bytes choose an arrangement, a kernel, a threshold and a ray's start; the rest are
//! balls. *Tame* balls lie on a coarse grid, so that many coincide, nest, touch, or lie in a plane or
//! on a line, one may be huge, and some may be negative: certified answers must be the oracle's. *Wild* balls are any bits
//! at all: a field that is no scene must be refused by builders as by [`Scene::new`], and nothing may
//! panic.

use fbvh::{BuildError, Field, Options, Tracer, Tree};
use glam::Vec3;
use metaball_core::reference::Oracle;
use metaball_core::{Kernel, Metaball, Ray, Scene, Support};

/// Balls that nothing has checked.
struct Unchecked {
    balls: Vec<Metaball>,
    kernel: Kernel,
    threshold: f32,
}

impl Field for Unchecked {
    fn ball_count(&self) -> usize {
        self.balls.len()
    }

    fn support(&self, ball: usize) -> Support {
        let Metaball { center, radius, .. } = self.balls[ball];
        Support { center, radius }
    }

    fn strength(&self, ball: usize) -> f32 {
        self.balls[ball].strength
    }

    fn kernel(&self) -> Kernel {
        self.kernel
    }

    fn threshold(&self) -> f32 {
        self.threshold
    }
}

/// What some bytes were.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Too few to say anything.
    TooFew,
    /// No legal scene, and refused.
    Refused,
    /// A scene; so many of its rays hit.
    Traced(usize),
}

/// Builds every structure over the bytes' balls and sends rays through it.
///
/// # Panics
/// Where an answer is wrong.
pub(crate) fn build_and_trace(bytes: &[u8]) -> Outcome {
    let Some((&[arrangement, kernel, threshold, x, y, z], balls)) = bytes.split_first_chunk::<6>()
    else {
        return Outcome::TooFew;
    };
    let kernels: Vec<Kernel> = Kernel::all().collect();
    let is_tame = arrangement % 4 != 0;
    let field = Unchecked {
        balls: if is_tame { tame(arrangement, balls) } else { wild(balls) },
        kernel: kernels[usize::from(kernel) % kernels.len()],
        // 0 among them, which is refused.
        threshold: f32::from(threshold) / 64.0,
    };
    let start = Vec3::from([x, y, z].map(|byte| f32::from(byte as i8) / 8.0));
    let scene = Scene::new(field.balls.iter().copied(), field.kernel, field.threshold);
    let structures = [Options::modified_bvh(), Options::fitted(), Options::certified()];
    let trees = structures.map(|options| Tree::build(&field, &options));
    let Ok(scene) = scene else {
        assert!(trees.iter().all(Result::is_err), "built, though it is no scene");
        return Outcome::Refused;
    };

    let oracle = Oracle::new(&scene);
    let ends = field.balls.iter().take(16).map(|ball| ball.center).chain([Vec3::X, Vec3::ZERO]);
    let mut hits = 0;
    for end in ends {
        let whole = Ray::new(start, (end - start).normalize_or(Vec3::Z));
        let later = Ray { t_min: start.distance(end), ..whole };
        let rays = [whole, later];
        let traced = trees.iter().zip(structures).flat_map(|tree| rays.map(|ray| (ray, tree)));
        for (ray, (tree, options)) in traced {
            if matches!(tree, Err(BuildError::NegativeOfPublished { .. })) {
                continue;
            }
            let tree = tree.as_ref().expect("a scene has a tree");
            let tracer = Tracer::new(tree, &field);
            let (hit, any, exit) =
                (tracer.first_hit(&ray), tracer.any_hit(&ray), tracer.first_exit(&ray));
            assert!(!hit.is_hit() || hit.t >= ray.t_min, "{ray:?}: {hit:?}");
            assert_eq!(exit.is_ok(), options == Options::certified());
            if options != Options::certified() || !is_tame {
                continue;
            }
            let truth = oracle.first_hit(&ray);
            if !truth.is_ambiguous() {
                assert_eq!(
                    (hit.verdict, any),
                    (truth.verdict, truth.verdict),
                    "{ray:?} {hit:?} {truth:?} {}",
                    field.kernel
                );
                hits += usize::from(hit.is_hit());
            }
        }
    }
    Outcome::Traced(hits)
}

/// Three bytes a ball: centre on a grid, flattened as the arrangement says, and radius.
fn tame(arrangement: u8, bytes: &[u8]) -> Vec<Metaball> {
    let onto = match arrangement % 4 {
        1 => Vec3::ONE,
        2 => Vec3::new(1.0, 0.0, 1.0),
        _ => Vec3::X,
    };
    let ball = |(at, &[a, b, c]): (usize, &[u8; 3])| {
        let coordinate = |byte: u8| f32::from(byte % 16) / 2.0 - 4.0;
        let huge = if at == 0 && arrangement >= 128 { 100.0 } else { 1.0 };
        let center = onto * Vec3::new(coordinate(a), coordinate(b), coordinate(c));
        let takes_away = arrangement & 64 != 0 && at % 3 == 2;
        let strength = (1.0 + f32::from(b / 16) / 8.0) * if takes_away { -0.5 } else { 1.0 };
        Metaball { center, radius: huge * (0.25 + f32::from(a / 16) / 8.0), strength }
    };
    bytes.as_chunks::<3>().0.iter().take(200).enumerate().map(ball).collect()
}

/// Twenty bytes a ball: five floats, whatever they are.
fn wild(bytes: &[u8]) -> Vec<Metaball> {
    let ball = |bytes: &[u8; 20]| {
        let (floats, _) = bytes.as_chunks::<4>();
        let number = |at: usize| f32::from_le_bytes(floats[at]);
        Metaball {
            center: Vec3::new(number(0), number(1), number(2)),
            radius: number(3),
            strength: number(4),
        }
    };
    bytes.as_chunks::<20>().0.iter().take(50).map(ball).collect()
}
