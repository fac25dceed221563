//! The shared pictures, made by the adapter and by the CPU, are the same.

use bench_scenes::{Overrides, load};
use fbvh::Options;
use metaball_core::gpu::{self, Gpu, IsoRenderer, Shading, Targets};
use metaball_core::shade::{self, CpuPicture};
use metaball_core::{Picture, View};

/// Hits of the same frame under both shadings. WGSL lets `pow` err by 16 units in the last place
/// of the logarithm it goes through, 1e-5 of a channel here, which moves a value by at most one
/// step where it lies next to a rounding boundary. Blended colours go through two roundings.
#[test]
fn both_shadings_agree() {
    let Some(gpu) = Gpu::for_test() else { return };
    for (name, steps) in [("strengths-100", 1), ("colors-100", 2), ("eye-inside-surface", 1)] {
        let bench = load(name, &Overrides::default()).expect("known");
        let scene = &bench.scene;
        let view = View::new(bench.camera, 64, 48).expect("a size");
        let targets = Targets::new(&gpu, 64, 48, scene.colors().is_some(), false).expect("memory");
        let mut renderer = fbvh::gpu::Renderer::new("fbvh", Options::fitted(), false);
        renderer.build(&gpu, scene).expect("built");
        gpu::render(&gpu, &mut renderer, &targets, &view).expect("drawn");
        let rays = targets.read_rays(&gpu, &view).expect("read");
        let hits = targets.read_hits(&gpu).expect("read");
        for picture in [Picture::Phong, Picture::Normal, Picture::Depth, Picture::Color] {
            let wanted = Shading::new(&gpu).draw(&targets, &view, scene, picture).expect("shaded");
            let on_cpu = CpuPicture::of(picture).expect("needs no adapter");
            let found = shade::draw(scene, &view, &rays, &hits, on_cpu);
            assert_eq!(found.range, wanted.range);
            let bytes = found.image.rgba.iter().zip(&wanted.image.rgba);
            let worst = bytes.map(|(found, wanted)| found.abs_diff(*wanted)).max();
            assert!(worst <= Some(steps), "{name}, {picture:?}: {worst:?}");
        }
    }
}
