//! How long the CPU takes to trace a picture: primary rays of 640 × 480 pixels, in the order of the
//! pixels, on all threads of rayon's pool. α = 2 and T = 0.25 throughout.

use std::hint::black_box;

use bench_scenes::Overrides;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fbvh::{Options, TraceOptions, Tracer, Tree};
use metaball_core::{Camera, Ray};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

const SCENES: [&str; 5] =
    ["scattered:10000", "scattered:100000", "pool:10000", "tornado:128000", "molecule"];

const STRUCTURES: [(&str, Options); 3] = [
    ("bvh", Options::modified_bvh()),
    ("fbvh", Options::fitted()),
    ("fbvh-certified", Options::certified()),
];

fn rays_of(camera: &Camera) -> Vec<Ray> {
    let ray = |pixel| {
        let (column, row) = (pixel % WIDTH, pixel / WIDTH);
        let direction = camera.exact_direction(column, row, WIDTH, HEIGHT);
        Ray::new(camera.eye(), direction.as_vec3())
    };
    (0..WIDTH * HEIGHT).map(ray).collect()
}

fn trace(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("trace");
    group.sample_size(10);
    for name in SCENES {
        let bench = bench_scenes::load(name, &Overrides::default()).expect("a known scene");
        let rays = rays_of(&bench.camera);
        group.throughput(Throughput::Elements(rays.len() as u64));
        for (structure, options) in STRUCTURES {
            let tree = Tree::build(&bench.scene, &options).expect("legal options");
            let tracer = Tracer::new(&tree, &bench.scene, TraceOptions::DEFAULT);
            group.bench_with_input(BenchmarkId::new(structure, name), &rays, |bencher, rays| {
                bencher.iter(|| tracer.picture_hits(black_box(rays), WIDTH as usize));
            });
        }
    }
}

criterion_group!(benches, trace);
criterion_main!(benches);
