//! Tests of what is not public.

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer, Targets, render};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

use crate::sort::by_effective_distance;
use crate::{Options, Renderer, Sort};

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
