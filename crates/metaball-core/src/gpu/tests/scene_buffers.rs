//! The device memory that a scene takes: what it needs, and no more.

use glam::Vec3;

use crate::gpu::{Gpu, SceneBuffers, SceneHeader};
use crate::{Color, Generality, Kernel, Metaball, Scene};

const BALLS: usize = 10;

fn scene(ball: impl Fn(usize) -> Metaball) -> Scene {
    Scene::new((0..BALLS).map(ball), Kernel::QUARTIC, 0.5).expect("legal")
}

fn equal_balls() -> Scene {
    scene(|index| Metaball::new(Vec3::X * index as f32, 1.0))
}

/// Bytes without the header.
fn bytes(gpu: &Gpu, scene: &Scene) -> usize {
    let all = SceneBuffers::new(gpu, scene).expect("small").bytes();
    all as usize - size_of::<SceneHeader>()
}

#[test]
fn a_scene_takes_what_it_needs() {
    let Some(gpu) = Gpu::for_test() else { return };
    let bytes = |scene: &Scene| bytes(&gpu, scene);
    let supports = 16 * BALLS;
    assert_eq!(bytes(&equal_balls()), supports);
    let strengths =
        scene(|index| Metaball { strength: 1.0 + index as f32, ..Metaball::new(Vec3::ZERO, 1.0) });
    assert_eq!(bytes(&strengths), supports + 4 * BALLS);
    let colors = vec![Color::srgb(255, 0, 0); BALLS];
    let colored = equal_balls().with_colors(colors).expect("one each");
    assert_eq!(bytes(&colored), supports + 4 * BALLS);
}

/// And what it is made to take, so that the other numbers are not zero by mistake.
#[test]
fn a_generalized_scene_takes_more() {
    let Some(gpu) = Gpu::for_test() else { return };
    let more = |generality| {
        let general = equal_balls().generalized(generality);
        bytes(&gpu, &general) - bytes(&gpu, &equal_balls())
    };
    let expected = [16, 16, 0, 4 * BALLS, 4 * BALLS];
    assert_eq!(Generality::ALL.map(more), expected);
}
