//! The bounds against the field itself, in f64.

use glam::{DVec3, Vec3};
use metaball_core::{Camera, Hit, Metaball, Ray, Scene, Verdict, View};
use proptest::prelude::*;

use super::*;
use crate::{Options, Tracer, Tree};

/// F − T and its gradient.
fn field(kernel: Kernel, threshold: f32, terms: &[Term], point: DVec3) -> (f64, DVec3) {
    let start = (-f64::from(threshold), DVec3::ZERO);
    terms.iter().fold(start, |(value, gradient), term| {
        let offset = point - Vec3::from(term.center).as_dvec3();
        let inverse = f64::from(term.inverse_radius);
        let s = offset.length_squared() * inverse * inverse;
        let q = f64::from(term.strength);
        let slope = if s < 1.0 { kernel.slope(s) } else { 0.0 };
        let value = value + if s < 1.0 { q * kernel.value(s) } else { 0.0 };
        (value, gradient + 2.0 * q * slope * inverse * inverse * offset)
    })
}

/// What is wrong with a polynomial's bounds at a point of the box, given in its coordinates.
fn complaint(
    (kernel, threshold, terms): (Kernel, f32, &[Term]),
    polynomial: &LeafPolynomial,
    point: [f32; 3],
    canary: f64,
) -> Option<String> {
    let scale: [f64; 3] = array_of(|axis| f64::from(polynomial.scale[axis]));
    let world = |point: DVec3| DVec3::from(array_of(|axis| point.to_array()[axis] / scale[axis]));
    let value = |point: DVec3| {
        let monomials = EXPONENTS.iter().zip(polynomial.coefficients);
        monomials
            .map(|([i, j, k], c)| {
                let power = |x: f64, n: &u8| x.powi(i32::from(*n));
                f64::from(c) * power(point.x, i) * power(point.y, j) * power(point.z, k)
            })
            .sum::<f64>()
    };
    let point = Vec3::from(point).as_dvec3();
    let (truth, gradient) = field(kernel, threshold, terms, world(point));
    let error = f64::from(polynomial.error) * canary;
    let off = (truth - value(point)).abs();
    if off > error {
        return Some(format!("{off} where {error} is promised"));
    }
    for (axis, scale) in scale.into_iter().enumerate() {
        const STEP: f64 = 1e-4;
        let step = DVec3::AXES[axis] * STEP;
        let slope = (value(point + step) - value(point - step)) / (2.0 * STEP) * scale;
        let off = (gradient.to_array()[axis] - slope).abs();
        let promised = polynomial.slope_errors[axis] + polynomial.steepness_error;
        let promised = f64::from(promised) * canary;
        // What the difference quotient misses.
        let slack = 1e-6 * f64::from(polynomial.magnitude) * scale;
        if off > promised + slack {
            return Some(format!("slope {axis}: {off} where {promised} is promised"));
        }
    }
    None
}

fn kernels() -> impl Strategy<Value = Kernel> {
    let kernels = Kernel::all().filter(|&kernel| kernel != Kernel::Perlin);
    prop_oneof![Just(Kernel::QUARTIC), prop::sample::select(kernels.collect::<Vec<_>>())]
}

/// Balls whose supports reach the box or nearly, of radii that differ by up to `ratio`.
fn terms(ratio: f32) -> impl Strategy<Value = Vec<Term>> {
    let ball = (prop::array::uniform3(-1.6f32..1.6), 0.0f32..1.0, 0.1f32..2.0);
    let term = ball.prop_map(move |(center, share, strength)| Term {
        center,
        inverse_radius: ratio.powf(share - 0.5).recip(),
        strength,
    });
    prop::collection::vec(term, 1..60)
}

fn half_sides() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(0.02f32..0.6)
}

fn make(
    kernel: Kernel,
    threshold: f32,
    terms: &[Term],
    half: [f32; 3],
    cells: Cells,
) -> Option<LeafPolynomial> {
    let half = Vec3::from(half);
    let bounds = Aabb { min: -half, max: half };
    LeafPolynomial::new(Arch::new(), kernel, threshold, terms, &bounds, cells)
}

proptest! {
    #[test]
    fn the_field_is_within_the_bounds(
        kernel in kernels(),
        terms in (1.0f32..30.0).prop_flat_map(terms),
        half in half_sides(),
        threshold in 0.05f32..5.0,
        points in prop::collection::vec(prop::array::uniform3(-1.0f32..=1.0), 200),
    ) {
        let made = [Cells::COARSE, Cells::FINE].map(|cells| make(kernel, threshold, &terms, half, cells));
        for polynomial in made.iter().flatten() {
            for &point in &points {
                let found = complaint((kernel, threshold, &terms), polynomial, point, 1.0);
                prop_assert_eq!(found, None, "{:?}", point);
            }
        }
    }
}

/// A ball, or some around, none near, and very small ones: what there is a polynomial for, and that its
/// bounds are within reach of what is there.
#[test]
fn bounds_are_neither_wrong_nor_idle() {
    let cloud = |count: usize, radius: f32| -> Vec<Term> {
        let share = |at: usize, factor: f64| (at as f64 * factor).fract() as f32 * 3.0 - 1.5;
        let center = |at| [share(at, 0.618_034), share(at, 0.754_877), share(at, 0.569_84)];
        (0..count)
            .map(|at| Term { center: center(at), inverse_radius: radius.recip(), strength: 1.0 })
            .collect()
    };
    let points: Vec<[f32; 3]> = (0..1000)
        .map(|at| array_of(|axis| [(at % 10), at / 10 % 10, at / 100][axis] as f32 / 4.5 - 1.0))
        .collect();
    let cases = [(100, 4.0, Cells::FINE), (400, 20.0, Cells::FINE), (400, 20.0, Cells::COARSE)];
    for (count, threshold, cells) in cases {
        let terms = cloud(count, 1.0);
        let half = [0.3, 0.25, 0.3];
        let polynomial = make(Kernel::QUARTIC, threshold, &terms, half, cells).expect("worthwhile");
        let field = (Kernel::QUARTIC, threshold, terms.as_slice());
        let wrong = |canary: f64| {
            points.iter().filter_map(|&point| complaint(field, &polynomial, point, canary)).count()
        };
        assert_eq!(wrong(1.0), 0);
        assert!(wrong(0.1) > 0, "bounds ten times too wide");
    }
    // Balls far smaller than the box are no polynomial.
    let none = |kernel, threshold, radius, half| {
        make(kernel, threshold, &cloud(100, radius), half, Cells::FINE).is_none()
    };
    assert!(none(Kernel::QUARTIC, 0.2, 0.05, [0.3; 3]));
    assert!(none(Kernel::QUARTIC, 4.0, 1.0, [0.3, 0.0, 0.3]));
    assert!(none(Kernel::Perlin, 4.0, 1.0, [0.3; 3]));
    assert!(none(Kernel::QUARTIC, f32::MAX, 1e-30, [0.3; 3]));
}

/// A cube full of balls whose supports hold some 80 others, and the surface in their midst.
fn dense(kernel: Kernel) -> Scene {
    let share = |at: usize, factor: f64| (at as f64 * factor).fract() as f32 * 4.0;
    let ball = |at: usize| {
        let center = [share(at, 0.819_173), share(at, 0.671_044), share(at, 0.549_7)];
        Metaball::new(center.into(), if at.is_multiple_of(3) { 0.8 } else { 1.0 })
    };
    let part = |ball: Metaball| {
        let distance = ball.center.distance_squared(Vec3::splat(2.0));
        kernel.value(f64::from(distance / (ball.radius * ball.radius)).min(1.0))
    };
    let middle = (0..1500).map(|at| part(ball(at))).sum::<f64>();
    Scene::new((0..1500).map(ball), kernel, 0.5 * middle as f32).expect("legal")
}

/// Rays alone never ask for a polynomial: they are what rays in packets are held against, to the last bit.
#[test]
fn polynomials_change_no_answer() {
    let power = |exponent| Kernel::power(exponent).expect("legal");
    for kernel in [Kernel::QUARTIC, power(1), power(3), power(6), Kernel::Wyvill] {
        let scene = dense(kernel);
        // Close by, so that many rays meet a leaf.
        let middle = Aabb { min: Vec3::splat(1.5), max: Vec3::splat(2.5) };
        let camera = Camera::framing(&middle, Vec3::new(0.4, 0.3, 1.0));
        let rays = View::new(camera, 96, 72).expect("a legal size").rays();
        let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
        let tracer = Tracer::new(&tree, &scene);
        let alone: Vec<Hit> = rays.iter().map(|ray| tracer.first_hit(ray)).collect();
        // Free rays: from points of the picture's hits, all ways.
        let away = |(at, hit): (usize, &Hit)| {
            let origin = rays[at].origin + hit.t * rays[at].direction + 1e-4 * hit.normal;
            let way =
                Vec3::new((at % 7) as f32 - 3.0, (at % 5) as f32 - 2.0, (at % 11) as f32 - 5.5);
            Ray::new(origin, (hit.normal * 4.0 + way).normalize())
        };
        let hits = alone.iter().enumerate().filter(|(_, hit)| hit.is_hit());
        let free: Vec<Ray> = hits.map(away).collect();
        let any: Vec<Verdict> = free.iter().map(|ray| tracer.any_hit(ray)).collect();
        let hit = alone.iter().filter(|hit| hit.is_hit()).count();
        assert!(hit > 1000, "{hit} of {}", alone.len());
        assert!(any.contains(&Verdict::Hit) && any.contains(&Verdict::Miss));
        assert_eq!(tracer.tree.polynomials.fine(), 0);
        for _ in 0..4 {
            assert_eq!(tracer.picture_hits(&rays, 96), alone, "{kernel}");
            assert_eq!(tracer.any_hits(&free), any, "{kernel}");
        }
        assert!(tracer.tree.polynomials.fine() > 0, "{kernel}: no polynomial was used");
    }
}
