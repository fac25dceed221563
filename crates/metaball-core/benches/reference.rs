//! How long the reference takes for the rays of a small picture that balls fill.
//!
//! `cargo bench -p metaball-core`. A picture of 640 × 480 takes a hundred times as long.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use metaball_core::reference::Oracle;
use metaball_core::{Kernel, Metaball, Ray, Scene};

const COLUMNS: usize = 64;
const ROWS: usize = 48;

fn pictures(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("reference");
    group.throughput(Throughput::Elements((COLUMNS * ROWS) as u64)).sample_size(10);
    let steepest = Kernel::power(8).expect("8 is an exponent");
    for kernel in [Kernel::QUARTIC, steepest, Kernel::Wyvill, Kernel::Perlin] {
        let scene = chain(kernel);
        let rays = rays(13.0);
        let oracle = Oracle::new(&scene);
        group.bench_function(format!("chain-5500-{kernel}"), |bench| {
            bench.iter(|| oracle.first_hits(&rays));
        });
    }
    for overlap in [0.5, 8.0] {
        let scene = scattered(overlap);
        let rays = rays(1.0);
        let oracle = Oracle::new(&scene);
        group.bench_function(format!("scattered-100000-overlap-{overlap}"), |bench| {
            bench.iter(|| oracle.first_hits(&rays));
        });
    }
    group.finish();
}

/// Rays from an eye outside a cube of this half side through a grid in its middle.
fn rays(half: f32) -> Vec<Ray> {
    let eye = Vec3::new(0.3, 0.4, 3.5) * half;
    (0..COLUMNS * ROWS)
        .map(|pixel| {
            let across = (pixel % COLUMNS) as f32 / COLUMNS as f32 - 0.5;
            let down = (pixel / COLUMNS) as f32 / ROWS as f32 - 0.5;
            let target = 2.0 * half * Vec3::new(4.0 / 3.0 * across, -down, 0.0);
            Ray::new(eye, (target - eye).normalize())
        })
        .collect()
}

/// A chain folded into a sphere of radius 13: about 40 supports over each point inside.
fn chain(kernel: Kernel) -> Scene {
    let mut random = Random(1);
    let mut end = Vec3::ZERO;
    let balls: Vec<_> = (0..5_500)
        .map(|_| {
            end = loop {
                let next = end + 1.5 * random.in_cube().normalize_or(Vec3::X);
                if next.length() < 13.0 {
                    break next;
                }
            };
            Metaball::new(end, 2.2 + 0.6 * random.unit())
        })
        .collect();
    Scene::new(balls, kernel, 0.5).expect("legal")
}

/// 100,000 balls in a cube of side 2, `overlap` supports over each point.
fn scattered(overlap: f32) -> Scene {
    let mut random = Random(2);
    let radius = (overlap * 8.0 / 1e5 * 0.75 / std::f32::consts::PI).cbrt();
    let balls: Vec<_> = (0..100_000).map(|_| Metaball::new(random.in_cube(), radius)).collect();
    Scene::new(balls, Kernel::QUARTIC, 0.2).expect("legal")
}

/// SplitMix64: repeatable scenes.
struct Random(u64);

impl Random {
    /// In [0, 1).
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    /// In the cube from −1 to 1.
    fn in_cube(&mut self) -> Vec3 {
        2.0 * Vec3::new(self.unit(), self.unit(), self.unit()) - 1.0
    }
}

criterion_group!(benches, pictures);
criterion_main!(benches);
