//! How long the CPU takes to trace a picture: primary rays of 640 × 480 pixels, in the order of the
//! pixels, on all threads of rayon's pool. α = 2 and T = 0.25 throughout.

use std::hint::black_box;

use bench_scenes::Overrides;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fbvh::{Options, Tracer, Tree};
use metaball_core::View;

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

const SCENES: [&str; 5] =
    ["scattered:10000", "scattered:100000", "pool:10000", "tornado:128000", "molecule"];

const STRUCTURES: [(&str, Options); 3] = [
    ("bvh", Options::modified_bvh()),
    ("fbvh", Options::fitted()),
    ("fbvh-certified", Options::certified()),
];

fn trace(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("trace");
    group.sample_size(10);
    for name in SCENES {
        let bench = bench_scenes::load(name, &Overrides::default()).expect("a known scene");
        let rays = View::new(bench.camera, WIDTH, HEIGHT).expect("a legal size").rays();
        group.throughput(Throughput::Elements(rays.len() as u64));
        for (structure, options) in STRUCTURES {
            let tree = Tree::build(&bench.scene, &options).expect("legal options");
            let tracer = Tracer::new(&tree, &bench.scene);
            group.bench_with_input(BenchmarkId::new(structure, name), &rays, |bencher, rays| {
                bencher.iter(|| tracer.picture_hits(black_box(rays), WIDTH as usize));
            });
        }
    }
}

/// By density, with a threshold of half the field's mean inside, so that hits stay. The tracer is kept from
/// sample to sample, as from frame to frame.
fn density(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("density");
    group.sample_size(10);
    for (density, threshold) in [(5, 0.57), (45, 5.0), (150, 17.0), (500, 57.0)] {
        for generator in ["scattered", "pool", "tornado"] {
            let name = format!("{generator}:10000:{density}");
            let overrides = Overrides { threshold: Some(threshold), ..Overrides::default() };
            let bench = bench_scenes::load(&name, &overrides).expect("a known scene");
            let rays = View::new(bench.camera, WIDTH, HEIGHT).expect("a legal size").rays();
            group.throughput(Throughput::Elements(rays.len() as u64));
            let tree = Tree::build(&bench.scene, &Options::certified()).expect("legal options");
            let id = |what| BenchmarkId::new(what, &name);
            group.bench_with_input(id("first-picture"), &rays, |bencher, rays| {
                bencher.iter(|| {
                    Tracer::new(&tree, &bench.scene).picture_hits(black_box(rays), WIDTH as usize)
                });
            });
            let tracer = Tracer::new(&tree, &bench.scene);
            group.bench_with_input(id("later-pictures"), &rays, |bencher, rays| {
                bencher.iter(|| tracer.picture_hits(black_box(rays), WIDTH as usize));
            });
        }
    }
}

criterion_group!(benches, trace, density);
criterion_main!(benches);
