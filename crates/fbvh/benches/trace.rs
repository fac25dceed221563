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

criterion_group!(benches, trace);
criterion_main!(benches);
