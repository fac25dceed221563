//! Tests of what is not public.

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer, Targets, render};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

use crate::sort::by_effective_distance;
use crate::{Gather, Options, Piece, Renderer, Sort};

/// Overlapping balls, every third of them twice, so that separators coincide.
fn crowd() -> Scene {
    let balls = (0..60_u32).map(|index| {
        let seed = index - u32::from(index % 3 == 2);
        let [x, y, z] = [0x9e37_79b9_u32, 0x85eb_ca6b, 0xc2b2_ae35]
            .map(|factor| (seed.wrapping_mul(factor) >> 24) as f32 / 128.0 - 1.0);
        Metaball { center: Vec3::new(x, y, z), radius: 0.6, strength: 0.1 }
    });
    Scene::new(balls, Kernel::Wyvill, 0.3).expect("legal")
}

/// A ray that waits keeps what it has: with a small budget the running sum draws the same picture, bit for
/// bit, and pieces made anew one whose sums are in another order. Roots move by roundings of sums of a few
/// hundredths over slopes above T in a radius: below 1e-5.
#[test]
fn rays_that_wait_lose_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (scene, eye) = (crowd(), Vec3::new(0.0, 0.0, 4.0));
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 40.0).expect("legal");
    let view = View::new(camera, 20, 15).expect("legal");
    let targets = Targets::new(&gpu, 20, 15, false, false).expect("small");
    let draw = |mut renderer: Renderer| {
        renderer.build(&gpu, &scene).expect("builds");
        render(&gpu, &mut renderer, &targets, &view).expect("draws");
        (targets.read_hits(&gpu).expect("readable"), renderer.resumes())
    };
    let published = Options::PUBLISHED;
    for (options, allowed) in [
        (published, 0.0),
        (Options { gather: Gather::Tiles, array_capacity: 24, ..published }, 0.0),
        (Options { piece: Piece::Rebuilt, ..published }, 1e-5),
        (Options { piece: Piece::Robust, array_capacity: 24, ..published }, 1e-5),
    ] {
        let renderer = || Renderer::new("illes", options, false);
        let (whole, none) = draw(renderer());
        assert_eq!(none, 0, "{options:?}");
        let (resumed, dispatches) = draw(renderer().with_budget(25));
        assert!(dispatches > 1, "{options:?}: no ray waits");
        for (resumed, whole) in resumed.iter().zip(&whole) {
            let is_near = resumed.t == whole.t || (resumed.t - whole.t).abs() <= allowed;
            assert!(
                is_near && resumed.verdict == whole.verdict,
                "{options:?}: {resumed:?}, {whole:?}"
            );
        }
    }
}

/// Every third ball has the centre of the one before it; the eye is among them, so that some
/// distances are negative. Coordinates are small multiples of powers of two and the eye is at one:
/// all but the root is exact, and the root is rounded the same way wherever it is right to half a
/// unit. Where an adapter's is not, the order may differ where two distances nearly agree.
#[test]
fn the_adapter_sorts_as_the_host_does() {
    let Some(gpu) = Gpu::for_test() else { return };
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 60.0).expect("legal");
    let view = View::new(camera, 8, 6).expect("legal");
    let targets = Targets::new(&gpu, 8, 6, false, false).expect("small");
    let options = Options { sort: Sort::Adapter, ..Options::default() };
    for count in [1_u32, 2, 1023, 1025, 9000] {
        let balls = (0..count).map(|index| {
            let seed = index - u32::from(index % 3 == 2);
            let [x, y, z] = [0x9e37_79b9_u32, 0x85eb_ca6b, 0xc2b2_ae35]
                .map(|factor| (seed.wrapping_mul(factor) >> 24) as f32 / 32.0 - 4.0);
            Metaball { center: Vec3::new(x, y, z), radius: 0.5, strength: 0.01 }
        });
        let scene = Scene::new(balls, Kernel::QUARTIC, 100.0).expect("legal");
        let mut renderer = Renderer::new("illes", options, false);
        renderer.build(&gpu, &scene).expect("builds");
        render(&gpu, &mut renderer, &targets, &view).expect("draws");
        let order = renderer.order(&gpu).expect("readable").expect("built");
        assert_eq!(order, by_effective_distance(scene.supports(), &camera), "{count} balls");
    }
}
