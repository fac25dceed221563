//! The search that replaces peeling: its structs and its limits. That it is right is tested with the other
//! methods, in `tests/src/trials`.

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer, RenderError, Targets, render};
use metaball_core::{Camera, Hit, Kernel, Metaball, Scene, Verdict, View};
use metaball_shaders::{compose, host_layout, struct_layout};

use crate::robust::{Entry, INTERVAL_CAPACITY, Renderer, State};

fn draw(gpu: &Gpu, scene: &Scene, camera: Camera) -> Result<Vec<Hit>, RenderError> {
    let view = View::new(camera, 24, 18).expect("a size");
    let mut renderer = Renderer::new("kanamori-robust", false);
    renderer.build(gpu, scene)?;
    let targets = Targets::new(gpu, 24, 18, false, false)?;
    render(gpu, &mut renderer, &targets, &view)?;
    targets.read_hits(gpu)
}

#[test]
fn host_structs_are_their_twins() {
    let variant = metaball_core::gpu::Specialization::without_balls().variant();
    let twin = |name| {
        let module = compose("kanamori_robust/search", &variant).expect("composes");
        struct_layout(&module, name).expect("the module uses the struct")
    };
    assert_eq!(twin("Entry"), host_layout!(Entry { near, ball }));
    assert_eq!(twin("State"), host_layout!(State { stage, first, base, low, probe, high }));
}

/// Overlap beyond the capacity of an interval is refused with the number, not drawn wrong; as much as the
/// capacity is drawn.
#[test]
fn more_than_the_limit_is_refused_by_number() {
    let Some(gpu) = Gpu::for_test() else { return };
    let camera = Camera::look_at(Vec3::Z * 4.0, Vec3::ZERO, Vec3::Y, 38.0).expect("legal");
    let coincident = |balls: u32| {
        let ball = Metaball { center: Vec3::ZERO, radius: 1.0, strength: 1e-4 };
        Scene::new(vec![ball; balls as usize], Kernel::QUARTIC, 0.25).expect("legal")
    };
    let hits = draw(&gpu, &coincident(INTERVAL_CAPACITY), camera).expect("draws");
    assert!(hits.iter().any(|hit| hit.verdict == Verdict::Hit));
    match draw(&gpu, &coincident(INTERVAL_CAPACITY + 1), camera) {
        Err(RenderError::Unsupported { reason, .. }) => {
            assert_eq!(
                reason,
                "needed at most 8192 balls that reach one interval of a ray, found more"
            );
        }
        outcome => panic!("{:?}", outcome.map(|hits| hits.len())),
    }
}
