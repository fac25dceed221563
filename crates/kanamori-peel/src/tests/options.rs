//! What options may change, and what they must not.

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer, RenderError, Targets, Work, render};
use metaball_core::{Camera, Hit, Kernel, Metaball, Scene, View};

use super::random::Random;
use crate::{Options, Renderer};

/// Random balls of random radii, as in the paper's figure 1.
fn scene() -> Scene {
    let mut random = Random::new(3);
    let balls: Vec<_> = (0..150)
        .map(|_| {
            let [x, y, z] = [(); 3].map(|()| 6.0 * random.unit() - 3.0);
            Metaball::new(Vec3::new(x, y, z), 0.4 + 0.6 * random.unit())
        })
        .collect();
    Scene::new(balls, Kernel::Wyvill, 0.3).expect("legal")
}

struct Picture {
    hits: Vec<Hit>,
    work: Vec<Work>,
    drawn: u32,
}

fn draw(gpu: &Gpu, options: Options) -> Picture {
    let camera =
        Camera::look_at(Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO, Vec3::Y, 40.0).expect("legal");
    let view = View::new(camera, 64, 48).expect("legal");
    let mut renderer = Renderer::new("kanamori", options, true);
    renderer.build(gpu, &scene()).expect("builds");
    let targets = Targets::new(gpu, 64, 48, false, true).expect("targets");
    render(gpu, &mut renderer, &targets, &view).expect("draws");
    Picture {
        hits: targets.read_hits(gpu).expect("reads"),
        work: targets.read_work(gpu).expect("reads").expect("was counted"),
        drawn: renderer.balls_drawn(gpu).expect("reads"),
    }
}

/// Hits may differ by what the root finder leaves open: half the threshold of an interval of at
/// most two radii, on either side.
fn assert_same(ours: &Picture, theirs: &Picture) {
    for (pixel, (our, their)) in ours.hits.iter().zip(&theirs.hits).enumerate() {
        assert_eq!(our.verdict, their.verdict, "pixel {pixel}");
        if our.is_hit() {
            assert!((our.t - their.t).abs() <= 2e-3, "pixel {pixel}: {our:?} against {their:?}");
        }
    }
}

#[test]
fn culling_changes_work_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let culled = draw(&gpu, Options::default());
    let all = draw(&gpu, Options { culling: false, ..Options::default() });
    assert!(all.hits.iter().filter(|hit| hit.is_hit()).count() > 500);
    assert_same(&culled, &all);
    let (fewer, more) = (culled.drawn, all.drawn);
    assert!(fewer < 140 && more > 145, "{fewer} of 150 balls were drawn with culling, else {more}");
}

#[test]
fn lists_and_stacks_of_other_lengths_draw_the_same() {
    let Some(gpu) = Gpu::for_test() else { return };
    let published = draw(&gpu, Options::default());
    assert!(published.hits.iter().all(|hit| !hit.fallback));
    for stack_size in [1, 4] {
        assert_same(&published, &draw(&gpu, Options { stack_size, ..Options::default() }));
    }
    assert_same(&published, &draw(&gpu, Options { list_capacity: 30, ..Options::default() }));
    assert_same(&published, &draw(&gpu, Options::robust()));
    let short = draw(&gpu, Options { list_capacity: 2, ..Options::default() });
    assert!(short.hits.iter().any(|hit| hit.fallback));
}

/// The paper: 2.3 iterations on average and at most 8 (section 5.4). An interval is finished when
/// its range is as narrow as the threshold, or nothing is left; we count the step that finds so.
#[test]
fn clipping_takes_few_iterations() {
    let Some(gpu) = Gpu::for_test() else { return };
    let work = draw(&gpu, Options::default()).work;
    let sum = |of: fn(&Work) -> u32| work.iter().map(of).sum::<u32>();
    let mean = f64::from(sum(|work| work.iterations)) / f64::from(sum(|work| work.leaf_tests));
    // Rays with one search tell how long a single one is.
    let single = work.iter().filter(|work| work.leaf_tests == 1);
    let longest = single.map(|work| work.iterations).max().expect("there are such rays");
    assert!(mean <= 2.3 && longest <= 8, "{mean} on average, at most {longest}");
}

#[test]
fn options_out_of_range_are_named() {
    let Some(gpu) = Gpu::for_test() else { return };
    let refused = |options| match Renderer::new("kanamori", options, false).build(&gpu, &scene()) {
        Err(RenderError::Unsupported { method: "kanamori", reason }) => reason,
        outcome => panic!("{options:?}: {outcome:?}"),
    };
    let reason = refused(Options { list_capacity: 31, ..Options::default() });
    assert!(reason.starts_with("list capacity: needed 1 to "), "{reason}");
    let reason = refused(Options { threshold: 0.0, ..Options::default() });
    assert_eq!(reason, "clipping threshold: needed 1e-6 to 0.5, found 0");
    let reason = refused(Options { stack_size: 5, ..Options::default() });
    assert_eq!(reason, "clipping stack size: needed 1 to 4, found 5");
}
