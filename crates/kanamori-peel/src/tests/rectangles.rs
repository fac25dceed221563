//! Rectangles against spheres projected point by point.

use glam::{DVec2, DVec3, Vec3};
use metaball_core::gpu::{Frame, Gpu, IsoRenderer, Targets};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

use crate::balls::Placed;
use crate::{Options, Renderer};

/// Spheres in front of, beside, across, around and behind the eye and its plane; the eye is at the
/// origin and looks along −z.
fn balls() -> Vec<Metaball> {
    let mut balls = vec![
        Metaball::new(Vec3::new(0.0, 0.0, -5.0), 1.0),
        Metaball::new(Vec3::new(2.0, -1.0, -5.0), 1.0),
        Metaball::new(Vec3::new(2.0, 0.0, -0.8), 1.0),
        Metaball::new(Vec3::new(-2.0, 0.3, -0.8), 1.0),
        Metaball::new(Vec3::new(0.2, 1.5, 0.4), 1.0),
        Metaball::new(Vec3::new(1.3, 0.0, 0.9), 1.0),
        Metaball::new(Vec3::new(0.3, 0.2, 0.1), 1.0),
        Metaball::new(Vec3::new(0.0, 0.0, 1.2), 1.0),
        Metaball::new(Vec3::new(0.0, 0.0, 1.0001), 1.0),
        Metaball::new(Vec3::new(300.0, -200.0, -1000.0), 0.5),
    ];
    let step = |index: usize, prime: f32| (index as f32 * prime).fract() * 6.0 - 3.0;
    balls.extend((1..200).map(|index| Metaball {
        center: Vec3::new(step(index, 0.618), step(index, 0.414), step(index, 0.732)),
        radius: 0.1 + 0.008 * index as f32,
        strength: 1.0,
    }));
    balls
}

/// The clip space box around the visible points of a sphere; `None` where none is seen.
fn projected(ball: &Metaball, view: &View) -> Option<(DVec2, DVec2)> {
    const STEPS: u32 = 200;
    let half_height = f64::from(view.camera().half_height());
    let half =
        DVec2::new(half_height * f64::from(view.width()) / f64::from(view.height()), half_height);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for row in 0..=STEPS {
        let (sine, cosine) = (std::f64::consts::PI * f64::from(row) / f64::from(STEPS)).sin_cos();
        for column in 0..2 * STEPS {
            let turn = std::f64::consts::PI * f64::from(column) / f64::from(STEPS);
            let normal = DVec3::new(sine * turn.cos(), sine * turn.sin(), cosine);
            let point = ball.center.as_dvec3() + f64::from(ball.radius) * normal;
            if point.z < 0.0 {
                let position = DVec2::new(point.x, point.y) / -point.z / half;
                if position.abs().max_element() <= 1.0 {
                    low = low.min(position);
                    high = high.max(position);
                }
            }
        }
    }
    (low.x <= high.x).then_some((low, high))
}

/// The rectangles that the adapter makes.
fn placed(gpu: &Gpu, balls: &[Metaball], view: &View) -> Vec<Placed> {
    let scene = Scene::new(balls.iter().copied(), Kernel::QUARTIC, 0.5).expect("legal");
    let mut renderer =
        Renderer::new("kanamori", Options { culling: false, ..Options::default() }, false);
    renderer.build(gpu, &scene).expect("builds");
    let targets = Targets::new(gpu, view.width(), view.height(), false, false).expect("targets");
    let mut frame = Frame::begin(gpu, &targets, view).expect("begins");
    renderer.encode(&mut frame).expect("encodes");
    frame.finish().expect("finishes");
    gpu.read(renderer.placed().expect("built")).expect("reads")
}

/// Every visible point of a sphere lies in its rectangle. Where the rectangle ends inside the
/// picture, points come as near to its edge as the grid of points allows: the outline between two
/// of them, a turn of π/200 apart, is missed by (π/200)²/8 = 3e-5 of the radius, seen from no
/// nearer than the tangent; with the slack of a twentieth of a pixel this stays below a pixel.
#[test]
fn rectangles_hold_and_fit_spheres() {
    let Some(gpu) = Gpu::for_test() else { return };
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 75.0).expect("legal");
    let view = View::new(camera, 96, 72).expect("legal");
    let balls = balls();
    let pixel = DVec2::new(2.0 / 96.0, 2.0 / 72.0);
    let (mut seen, mut fitted) = (0, 0);
    for (ball, placed) in balls.iter().zip(placed(&gpu, &balls, &view)) {
        let low = DVec2::from(placed.low.map(f64::from));
        let high = DVec2::from(placed.high.map(f64::from));
        let Some((lowest, highest)) = projected(ball, &view) else { continue };
        seen += 1;
        let is_held = low.cmple(lowest).all() && high.cmpge(highest).all();
        assert!(is_held, "{ball:?}: {placed:?} leaves out {lowest} or {highest}");
        // A sphere that the picture's edge cuts may reach further outside of it.
        if low.min_element() > -1.0 && high.max_element() < 1.0 {
            fitted += 1;
            let is_tight = (lowest - low).cmple(pixel).all() && (high - highest).cmple(pixel).all();
            assert!(is_tight, "{ball:?}: {placed:?} is loose around {lowest} to {highest}");
        }
    }
    assert!(seen > 30 && fitted > 5, "{seen} seen, {fitted} fitted");
}

/// What lies wholly behind the eye's plane is not drawn, and supports around the eye are known.
#[test]
fn what_is_behind_is_left_out() {
    let Some(gpu) = Gpu::for_test() else { return };
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 75.0).expect("legal");
    let view = View::new(camera, 96, 72).expect("legal");
    let balls = balls();
    for (ball, placed) in balls.iter().zip(placed(&gpu, &balls, &view)) {
        let is_behind = ball.center.z > 1.001 * ball.radius;
        assert!(!is_behind || placed.low == placed.high, "{ball:?}: {placed:?}");
        let is_around = ball.center.length() < ball.radius;
        assert_eq!(placed.around == 1, is_around, "{ball:?}");
    }
}
