//! How long building takes, in balls a second: scattered balls for its growth with their number, a
//! dense cloud and a tank of fluid for its growth with their overlap. The size of each tree is printed
//! before: list entries per ball, and leaves.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fbvh::{Options, Tree};
use glam::Vec3;
use metaball_core::{Kernel, Metaball, Scene};

/// Numbers from 0 to 1, the same in every run.
fn random() -> impl FnMut() -> f32 {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32
    }
}

fn scene(balls: impl Iterator<Item = Metaball>) -> Scene {
    Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal balls")
}

/// Balls in a cube, of which half a ball covers each point and four overlap each ball.
fn scattered(count: usize) -> Scene {
    const COVER: f32 = 0.5;
    let mut random = random();
    let radius = (COVER * 0.75 / std::f32::consts::PI / count as f32).cbrt();
    scene((0..count).map(|_| Metaball::new(Vec3::new(random(), random(), random()), radius)))
}

/// A bent funnel in which about fifty balls overlap each ball.
fn dense(count: usize) -> Scene {
    let mut random = random();
    let radius = 0.554 / (count as f32).cbrt();
    scene((0..count).map(|_| {
        let (height, turn) = (random(), random() * std::f32::consts::TAU);
        let width = (0.08 + 0.35 * height * height) * random().sqrt();
        let bend = 0.1 * Vec3::new((6.0 * height).sin(), 0.0, (6.0 * height).cos());
        Metaball::new(
            bend + Vec3::new(width * turn.cos(), 2.0 * height, width * turn.sin()),
            radius,
        )
    }))
}

/// A tank filled at random, in which about forty balls overlap each ball.
fn pool(count: usize) -> Scene {
    let mut random = random();
    let radius = 1.75 / (count as f32).cbrt();
    scene((0..count).map(|_| {
        let (x, z) = (random(), random());
        let height = 0.5 + 0.05 * ((9.0 * x).sin() + (7.0 * z).cos());
        Metaball::new(Vec3::new(x, height * random(), z), radius)
    }))
}

const STRUCTURES: [(&str, Options); 3] = [
    ("bvh", Options::modified_bvh()),
    ("fbvh", Options::fitted()),
    ("fbvh-certified", Options::certified()),
];

fn build(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("build");
    group.sample_size(10);
    let scenes = [10_000, 100_000, 1_000_000]
        .map(|count| (format!("scattered-{count}"), scattered(count)))
        .into_iter()
        .chain([("dense-128000".to_owned(), dense(128_000))])
        .chain([("pool-1000000".to_owned(), pool(1_000_000))]);
    for (name, scene) in scenes {
        group.throughput(Throughput::Elements(scene.len() as u64));
        for (structure, options) in STRUCTURES {
            let stats = Tree::build(&scene, &options).expect("legal options").stats();
            let entries = stats.list_entries as f64 / scene.len() as f64;
            eprintln!(
                "{structure}/{name}: {entries:.1} list entries per ball, {} leaves",
                stats.leaves
            );
            group.bench_with_input(BenchmarkId::new(structure, &name), &scene, |bencher, scene| {
                bencher.iter(|| Tree::build(black_box(scene), &options));
            });
        }
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
