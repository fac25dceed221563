//! A picture on the CPU is the same byte for byte, however and wherever it is drawn.

use std::hash::Hasher;

use fbvh::{Options, Tracer, Tree};
use glam::Vec3;
use metaball_core::{Camera, Color, Kernel, Metaball, NO_LIMIT, Scene, View};
use metaball_light::cpu::{PathTracer, Rows};
use metaball_light::{Effects, Film, Floor, Lamp, Occlusion, Panorama, Surface};
use rayon::ThreadPoolBuilder;

const SIZE: (u32, u32) = (53, 37);

/// Twenty balls on a spiral of exact numbers, since generators round as a machine's library does.
fn scene() -> Scene {
    let ball = |index: i32| {
        let (x, y) = ((index * 7 % 20 - 10) as f32, (index * 3 % 20 - 10) as f32);
        Metaball::new(Vec3::new(x, y, (index - 10) as f32) / 8.0, 0.75 + (index % 4) as f32 / 16.0)
    };
    let colors = (0..20u8).map(|index| Color::srgb(12 * index, 255 - 12 * index, 128)).collect();
    let scene = Scene::new((0..20).map(ball), Kernel::QUARTIC, 0.25).expect("legal");
    scene.with_colors(colors).expect("a colour a ball")
}

fn view() -> View {
    let eye = Vec3::new(2.0, 1.5, 4.0);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 45.0).expect("a camera");
    View::new(camera, SIZE.0, SIZE.1).expect("a size")
}

/// Everything that an opaque surface and a fluid have, in two pictures.
fn effects() -> [Effects; 2] {
    let view = view();
    let base = Effects::phong(view.camera());
    let floor =
        Floor { middle: Vec3::new(0.0, -1.5, 0.0), reach: 6.0, color: Vec3::splat(0.5), tile: 0.5 };
    let pixels = (0..32).map(|index| Vec3::splat(index as f32 / 32.0));
    let panorama = Panorama::new(8, 4, pixels).expect("light");
    let soft = Lamp { diameter: 5.0, ..base.lamps[0] };
    [
        Effects {
            surface: Surface::Opaque { reflectivity: 0.3 },
            lamps: vec![soft, base.lamps[1]],
            shadows: true,
            occlusion: Some(Occlusion { rays: 5, reach: NO_LIMIT }),
            bounces: 2,
            floor: Some(floor),
            ..base.clone()
        },
        Effects {
            surface: Surface::Fluid { refraction: 1.33, absorption: Vec3::new(0.5, 0.2, 0.1) },
            bounces: 6,
            floor: Some(floor),
            environment: metaball_light::Environment::Panorama(panorama),
            ..base
        },
    ]
}

/// What `draw` makes of the picture with these effects.
fn picture<T>(effects: &Effects, draw: impl FnOnce(&PathTracer<'_, Tracer<'_, Scene>>) -> T) -> T {
    let scene = scene();
    let tree = Tree::build(&scene, &Options::certified()).expect("legal");
    let tracer = Tracer::new(&tree, &scene);
    let picture = PathTracer::new(&tracer, &scene, &view(), effects, 3, 11);
    draw(&picture.expect("every query is answered"))
}

#[test]
fn threads_and_bands_change_nothing() {
    for effects in effects() {
        let whole = picture(&effects, |picture| picture.rows(0..SIZE.1));
        assert!(whole.rays.paths > 5_000 && whole.rays.undecided == 0, "{:?}", whole.rays);
        let pool = ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        let threaded = picture(&effects, |picture| pool.install(|| picture.rows(0..SIZE.1)));
        assert_eq!(threaded, whole);
        let bands =
            picture(&effects, |picture| [0..16, 16..32, 32..SIZE.1].map(|band| picture.rows(band)));
        let light: Vec<_> = bands.iter().flat_map(|Rows { light, .. }| light).copied().collect();
        assert_eq!(light, whole.light);
    }
}

/// A single sample goes through the middles of pixels, where paths may begin with hits that are known.
#[test]
fn first_hits_that_are_known_change_nothing() {
    for effects in effects() {
        let scene = scene();
        let tree = Tree::build(&scene, &Options::certified()).expect("legal");
        let tracer = Tracer::new(&tree, &scene);
        let mut canary = false;
        for samples in [1, 3] {
            let picture = PathTracer::new(&tracer, &scene, &view(), &effects, samples, 11);
            let picture = picture.expect("every query is answered");
            let rows = 16..SIZE.1;
            let (wanted, mut hits) = (picture.rows(rows.clone()), picture.first_hits(rows.clone()));
            assert_eq!(picture.rows_behind(rows.clone(), &hits), wanted);
            hits.rotate_right(1);
            canary |= picture.rows_behind(rows, &hits) != wanted;
        }
        assert!(canary, "hits of other pixels passed");
    }
}

/// Sums of the light's bits as they were first drawn, on x86-64 with AVX2: another machine, another
/// compiler or another library that draws another picture fails here.
#[test]
fn every_machine_draws_these_bits() {
    let sums = effects().map(|effects| {
        let Rows { light, .. } = picture(&effects, |picture| picture.rows(0..SIZE.1));
        let film = Film { width: SIZE.0, height: SIZE.1, light };
        let mut sum = Fnv(0xcbf2_9ce4_8422_2325);
        for light in &film.light {
            sum.write(&light.to_array().map(f32::to_le_bytes).concat());
        }
        sum.write(&film.develop(0.5).rgba);
        sum.finish()
    });
    assert_eq!(sums, [0x1169_d9a5_12c9_afc8, 0xc21b_fca5_f088_1018]);
}

/// FNV-1a, which is the same everywhere.
struct Fnv(u64);

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
