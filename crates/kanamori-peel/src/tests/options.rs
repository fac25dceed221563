//! What options may change, and what they must not.

use std::collections::BTreeMap;

use glam::Vec3;
use metaball_core::gpu::{Gpu, IsoRenderer, RenderError, Targets, render};
use metaball_core::{Camera, Hit, Kernel, Metaball, Scene, Verdict, View, Work};

use super::random::Random;
use crate::tiles::most_layers;
use crate::{Clipping, Options, Outline, Registration, Renderer};

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
    facts: BTreeMap<&'static str, f64>,
}

fn built(gpu: &Gpu, options: Options) -> Renderer {
    let mut renderer = Renderer::new("kanamori", options, true);
    renderer.build(gpu, &scene()).expect("builds");
    renderer
}

/// From outside all supports.
fn draw(gpu: &Gpu, options: Options) -> Picture {
    draw_from(gpu, &mut built(gpu, options), 9.0, (64, 48))
}

/// From a point on the axis; at 0 the eye is inside supports.
fn draw_from(gpu: &Gpu, renderer: &mut Renderer, z: f32, (width, height): (u32, u32)) -> Picture {
    let eye = Vec3::new(0.0, 0.0, z);
    let camera = Camera::look_at(eye, eye - Vec3::Z, Vec3::Y, 40.0).expect("legal");
    let view = View::new(camera, width, height).expect("legal");
    let targets = Targets::new(gpu, width, height, false, true).expect("targets");
    render(gpu, renderer, &targets, &view).expect("draws");
    Picture {
        hits: targets.read_hits(gpu).expect("reads"),
        work: targets.read_work(gpu).expect("reads").expect("was counted"),
        facts: renderer.frame_facts(gpu).expect("reads").into_iter().collect(),
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
    let drawn = |picture: &Picture| picture.facts["balls drawn"];
    let (fewer, more) = (drawn(&culled), drawn(&all));
    assert!(fewer < 140.0 && more > 145.0, "{fewer} of 150 balls drawn with culling, else {more}");
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
    let short = draw(&gpu, Options { list_capacity: 2, ..Options::default() });
    assert!(short.hits.iter().any(|hit| hit.fallback));
}

/// Tiles, where they are filled, and what is rasterised decide which fragments are drawn when, and
/// nothing else: one point a ball and ray, found by the same instructions. Pictures are equal to the
/// last bit, from outside and from within supports, and where the grid does not divide the picture.
#[test]
fn tiles_and_outlines_change_nothing() {
    const VIEWS: [(f32, (u32, u32)); 3] = [(9.0, (64, 48)), (1.0, (37, 21)), (0.0, (9, 37))];
    let Some(gpu) = Gpu::for_test() else { return };
    let pictures = |options| {
        let mut renderer = built(&gpu, options);
        VIEWS.map(|(z, size)| draw_from(&gpu, &mut renderer, z, size).hits)
    };
    let published = Options::default();
    let culled = pictures(published);
    assert!(culled.iter().all(|hits| hits.iter().any(Hit::is_hit)));
    for options in [
        Options { tiles: 1, ..published },
        Options { tiles: 16, registration: Registration::Adapter, ..published },
        Options { outline: Outline::Tessellation, ..published },
    ] {
        assert!(pictures(options) == culled, "{options:?}");
    }
    let all = pictures(Options { culling: false, ..published });
    let tessellated = Options { outline: Outline::Tessellation, culling: false, ..published };
    assert!(pictures(Options { tiles: 5, ..tessellated }) == all);
}

/// Balls that are in many tiles overflow the buffers that a scene begins with, wherever they are registered;
/// the frame is drawn again with larger ones, and is the same to the last bit as with one tile, which needs
/// none.
#[test]
fn registrations_beyond_the_capacity_are_drawn_with_more() {
    let Some(gpu) = Gpu::for_test() else { return };
    let unculled = Options { culling: false, ..Options::default() };
    let attempt = |options| {
        let mut renderer = built(&gpu, options);
        let before = renderer.registration_capacity();
        let picture = draw_from(&gpu, &mut renderer, 9.0, (64, 48));
        (
            picture,
            [before, renderer.registration_capacity()].map(|capacity| capacity.expect("is built")),
        )
    };
    let (one_tile, [before, after]) = attempt(Options { tiles: 1, ..unculled });
    assert_eq!(before, after);
    assert!(one_tile.hits.iter().filter(|hit| hit.is_hit()).count() > 500);
    for registration in [Registration::Host, Registration::Adapter] {
        let (picture, [before, after]) = attempt(Options { tiles: 16, registration, ..unculled });
        let registered = picture.facts["registrations"] as u32;
        assert!(before < registered && registered <= after, "{before}, {registered}, {after}");
        assert!(picture.hits == one_tile.hits, "{registration:?}");
    }
}

/// A row of apart balls without a surface, one behind the other: two points each, and a layer without one.
/// A frame that runs out of layers is drawn again with more; the next has a quarter more than it took,
/// be that more or less than before.
#[test]
fn layers_follow_the_scene() {
    let Some(gpu) = Gpu::for_test() else { return };
    for registration in [Registration::Host, Registration::Adapter] {
        let options = Options { registration, ..Options::default() };
        let mut renderer = Renderer::new("kanamori", options, true);
        for count in [100, 0, 1, 50] {
            let balls: Vec<_> = (0..count)
                .map(|index| Metaball {
                    center: Vec3::new(0.0, 0.0, -0.3 * index as f32),
                    radius: 0.1,
                    strength: 0.01,
                })
                .collect();
            let row = Scene::new(balls, Kernel::Wyvill, 0.9).expect("legal");
            renderer.build(&gpu, &row).expect("builds");
            let needed = most_layers(count);
            for _ in 0..2 {
                let picture = draw_from(&gpu, &mut renderer, 1.0, (49, 33));
                assert!(picture.hits.iter().all(|hit| hit.verdict == Verdict::Miss));
                let deepest = picture.work.iter().map(|work| work.layers).max();
                assert_eq!(deepest, Some(needed));
                assert_eq!(picture.facts["layers"], f64::from(needed));
            }
            assert_eq!(renderer.layer_limit(), needed + needed.div_ceil(4));
        }
    }
}

/// Without culling, of which the host has no knowledge, the adapter registers what the host does.
#[test]
fn host_and_adapter_register_the_same() {
    let Some(gpu) = Gpu::for_test() else { return };
    for tiles in [1, 8, 16] {
        let of = |registration| {
            let options = Options { tiles, registration, culling: false, ..Options::default() };
            draw(&gpu, options).facts["registrations"]
        };
        let (host, adapter) = (of(Registration::Host), of(Registration::Adapter));
        // A rectangle's edge may round to the other side of a tile's.
        assert!((host - adapter).abs() <= 2.0 && host >= 145.0, "{host} and {adapter}");
    }
}

/// The stackless form and the original recursion find what the short stack finds, up to the threshold
/// and to touches: ranges that are narrow and still reach the axis count as roots there (Campagna et
/// al.'s point, section 5.4).
#[test]
fn clipping_variants_agree() {
    let Some(gpu) = Gpu::for_test() else { return };
    let published = draw(&gpu, Options::default());
    for clipping in [Clipping::Iterative, Clipping::Original] {
        let other = draw(&gpu, Options { clipping, ..Options::default() });
        let differ = |our: &Hit, their: &Hit| {
            our.verdict != their.verdict || our.is_hit() && (our.t - their.t).abs() > 2e-3
        };
        let differing =
            published.hits.iter().zip(&other.hits).filter(|(our, their)| differ(our, their));
        let count = differing.count();
        // Silhouettes make up a few hundredths of the picture; a touch takes a share of them.
        assert!(count <= 30, "{clipping:?}: {count} of {} pixels differ", other.hits.len());
    }
}

/// A ball that the ray only touches comes up twice or not at all (section 4.2): rays that miss have
/// an even number of points, and end with the layer in which none is left, or take no layer, in tiles
/// without balls. The balls touch the rays of
/// single pixels to within a few units in the last place, and none is strong enough for a surface.
#[test]
fn touched_balls_come_up_twice_or_not_at_all() {
    let Some(gpu) = Gpu::for_test() else { return };
    let eye = Vec3::new(0.3, -0.2, 4.0);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 50.0).expect("legal");
    let view = View::new(camera, 32, 24).expect("legal");
    let targets = Targets::new(&gpu, 32, 24, false, true).expect("targets");
    let rays = {
        let mut renderer = Renderer::new("kanamori", Options::default(), true);
        renderer.build(&gpu, &scene()).expect("builds");
        render(&gpu, &mut renderer, &targets, &view).expect("draws");
        targets.read_rays(&gpu, &view).expect("reads")
    };
    let mut random = Random::new(4);
    let balls = rays.iter().map(|ray| {
        let radius = 0.02 + 0.03 * random.unit();
        let off_axis = ray.direction.any_orthonormal_vector();
        let nudge = 1.0 + (8.0 * random.unit() - 4.0).round() * f32::EPSILON;
        let center = eye + (2.0 + 4.0 * random.unit()) * ray.direction + radius * nudge * off_axis;
        Metaball { center, radius, strength: 0.01 }
    });
    let scene = Scene::new(balls.collect::<Vec<_>>(), Kernel::Wyvill, 0.9).expect("legal");
    for options in [Options::default(), Options { culling: false, tiles: 1, ..Options::default() }]
    {
        let mut renderer = Renderer::new("kanamori", options, true);
        renderer.build(&gpu, &scene).expect("builds");
        render(&gpu, &mut renderer, &targets, &view).expect("draws");
        let work = targets.read_work(&gpu).expect("reads").expect("was counted");
        let hits = targets.read_hits(&gpu).expect("reads");
        assert!(hits.iter().all(|hit| !hit.is_hit()));
        let is_odd = |work: &Work| work.layers % 2 == 1;
        assert!(
            work.iter().all(|work| work.layers == 0 || is_odd(work)),
            "an odd number of points"
        );
        let met = work.iter().filter(|work| work.layers > 1).count();
        assert!(met > 100 && met < rays.len(), "{met} of {} rays meet a ball", rays.len());
    }
}

/// Steps of a search on average and at most.
fn iterations(work: &[Work]) -> (f64, u32) {
    let sum = |of: fn(&Work) -> u32| work.iter().map(of).sum::<u32>();
    let mean = f64::from(sum(|work| work.iterations)) / f64::from(sum(|work| work.leaf_tests));
    (mean, work.iter().map(|work| work.longest_search).max().unwrap_or(0))
}

/// The paper: 2.3 iterations on average and at most 8 (section 5.4). An interval is finished when
/// its range is as narrow as the threshold, or nothing is left; we count the step that finds so.
#[test]
fn clipping_takes_few_iterations() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (mean, longest) = iterations(&draw(&gpu, Options::default()).work);
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
    let reason = refused(Options { tiles: 17, ..Options::default() });
    assert_eq!(reason, "tiles on a side: needed 1 to 16, found 17");
    let reason = refused(Options { threshold: 0.0, ..Options::default() });
    assert_eq!(reason, "clipping threshold: needed 1e-6 to 0.5, found 0");
    let reason = refused(Options { stack_size: 5, ..Options::default() });
    assert_eq!(reason, "clipping stack size: needed 1 to 4, found 5");
}
