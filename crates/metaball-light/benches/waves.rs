//! How fast the CPU answers each kind of ray that a lit picture sends, and draws the pictures that
//! are made of them: 640 × 480 pixels, on all threads of rayon's pool. Rays a second of whole pictures
//! count every ray, and hold sorting, sampling and shading.

use std::hint::black_box;

use bench_scenes::{BenchScene, Overrides};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fbvh::{Options, Tracer, Tree};
use metaball_core::{NO_LIMIT, Scene, View};
use metaball_light::cpu::PathTracer;
use metaball_light::{Effects, Occlusion, Surface};

const SIZE: (u32, u32) = (640, 480);

const SCENES: [&str; 5] =
    ["scattered:10000", "scattered:100000", "pool:10000", "tornado:128000", "molecule"];

/// The effects of each kind of wave.
fn effects(view: &View) -> [(&'static str, Effects); 5] {
    let base = Effects::phong(view.camera());
    let mirror = Surface::Opaque { reflectivity: 0.3 };
    let water = Surface::Fluid { refraction: 1.33, absorption: glam::Vec3::ZERO };
    [
        ("primary", base.clone()),
        ("shadows", Effects { shadows: true, ..base.clone() }),
        (
            "occlusion",
            Effects { occlusion: Some(Occlusion { rays: 16, reach: NO_LIMIT }), ..base.clone() },
        ),
        ("mirrors", Effects { surface: mirror, bounces: 3, ..base.clone() }),
        ("fluid", Effects { surface: water, bounces: 8, ..base }),
    ]
}

fn waves(criterion: &mut Criterion) {
    for name in SCENES {
        let mut group = criterion.benchmark_group(format!("light/{name}"));
        group.sample_size(10);
        let BenchScene { scene, camera, .. } =
            bench_scenes::load(name, &Overrides::default()).expect("a known scene");
        let view = View::new(camera, SIZE.0, SIZE.1).expect("a legal size");
        let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
        let tracer = Tracer::new(&tree, &scene);
        for (effect, effects) in effects(&view) {
            let picture = picture(&tracer, &scene, &view, &effects);
            let rays = picture.rows(0..SIZE.1).rays;
            group.throughput(Throughput::Elements(rays.paths + rays.shadows));
            group.bench_function(BenchmarkId::from_parameter(effect), |bencher| {
                bencher.iter(|| black_box(&picture).rows(0..SIZE.1));
            });
        }
        group.finish();
    }
}

fn picture<'a>(
    tracer: &'a Tracer<'a, Scene>,
    scene: &'a Scene,
    view: &View,
    effects: &Effects,
) -> PathTracer<'a, Tracer<'a, Scene>> {
    PathTracer::new(tracer, scene, view, effects, 1, 0).expect("every query is answered")
}

criterion_group!(benches, waves);
criterion_main!(benches);
