//! How long building takes, in balls a second: scattered balls for its growth with their number, a
//! tornado, a tank of fluid and a molecule for its growth with their overlap. Before each the size of the
//! tree is printed, and the most memory that building took beside the scene, in bytes a ball.
//!
//! With `TEN_MILLION` in the environment, ten million scattered balls too.

use std::env;
use std::hint::black_box;

use bench_scenes::Overrides;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fbvh::{Options, Tree};
use metaball_core::Scene;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const SCENES: [&str; 6] = [
    "scattered:10000",
    "scattered:100000",
    "scattered:1000000",
    "tornado:128000",
    "pool:1000000",
    "molecule",
];

const STRUCTURES: [(&str, Options); 3] = [
    ("bvh", Options::modified_bvh()),
    ("fbvh", Options::fitted()),
    ("fbvh-certified", Options::certified()),
];

/// Builds once, and says how large the tree is and how much memory that took.
fn size(scene: &Scene, options: &Options) -> String {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let tree = Tree::build(scene, options).expect("legal options");
    let a_ball = |bytes: usize| bytes as f64 / scene.len() as f64;
    format!(
        "{:.1} list entries and {:.0} bytes a ball, {:.0} bytes at the peak, {} leaves",
        a_ball(tree.lists().len()),
        a_ball(MEMORY.current_usage() - before),
        a_ball(MEMORY.peak_usage() - before),
        tree.leaf_count()
    )
}

fn build(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("build");
    group.sample_size(10);
    let largest = env::var_os("TEN_MILLION").map(|_| "scattered:10000000");
    for name in SCENES.into_iter().chain(largest) {
        let scene = bench_scenes::load(name, &Overrides::default()).expect("a known scene").scene;
        group.throughput(Throughput::Elements(scene.len() as u64));
        for (structure, options) in STRUCTURES {
            eprintln!("{structure}/{name}: {}", size(&scene, &options));
            group.bench_with_input(BenchmarkId::new(structure, name), &scene, |bencher, scene| {
                bencher.iter(|| Tree::build(black_box(scene), &options));
            });
        }
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
