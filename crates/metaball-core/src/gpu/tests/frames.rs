//! Frames, their reports and their errors.

use std::time::Duration;

use glam::Vec3;

use super::sphere::{HEIGHT, Sphere, colored, hits, scene, targets, view, view_from};
use crate::gpu::{Frame, FrameStatus, Gpu, IsoRenderer, RenderError, Targets, render};
use crate::{Hit, Kernel, Scene, Verdict, View, Work};

/// The hits of the unit sphere in f64, along the exact rays.
fn exact_hits(view: &View) -> Vec<Option<(f64, Vec3)>> {
    let eye = view.camera().eye().as_dvec3();
    let pixels = 0..view.pixels() as u32;
    pixels
        .map(|index| {
            let (column, row) = (index % view.width(), index / view.width());
            let direction = view.camera().exact_direction(column, row, view.width(), view.height());
            let along = -eye.dot(direction);
            let squared = 1.0 - (eye + along * direction).length_squared();
            (squared >= 0.0).then(|| {
                let t = along - squared.sqrt();
                (t, (eye + t * direction).normalize().as_vec3())
            })
        })
        .collect()
}

/// A ray's direction errs by 2e-6 at most (see the test of rays), which moves it by 1e-5 at a distance
/// of 5 and so 1 − d² by 2e-5, d the ray's distance from the centre: t = along − √(1 − d²) moves by
/// 2e-5/(2√(1 − d²)). Rays with 1 − d² below 1e-2 are left out, the rest err by 1e-4; so do unit
/// normals on a unit sphere.
#[test]
fn hits_arrive_as_they_were_written() {
    let Some(gpu) = Gpu::for_test() else { return };
    let found = hits(&gpu, &mut Sphere::new(), &scene(), &view());
    let mut compared = 0;
    for (hit, exact) in found.iter().zip(exact_hits(&view())) {
        let eye_to_rim = (5.0f64 * 5.0 - 1.0).sqrt();
        match exact {
            Some((t, normal)) if eye_to_rim - t > 0.1 => {
                assert_eq!(hit.verdict, Verdict::Hit);
                assert!((f64::from(hit.t) - t).abs() < 1e-4, "{} for {t}", hit.t);
                assert!((hit.normal - normal).length() < 1e-4, "{} for {normal}", hit.normal);
                compared += 1;
            }
            Some(_) => {}
            None => assert_eq!(*hit, Hit::MISS),
        }
    }
    assert!(compared > 200, "compared {compared} hits");
}

#[test]
fn a_start_inside_says_so() {
    let Some(gpu) = Gpu::for_test() else { return };
    let found = hits(&gpu, &mut Sphere::new(), &scene(), &view_from(0.5));
    assert!(found.iter().all(|hit| hit.verdict == Verdict::Inside && hit.t == 0.0));
}

#[test]
fn no_balls_are_an_empty_picture() {
    let Some(gpu) = Gpu::for_test() else { return };
    let empty = Scene::new([], Kernel::Perlin, 0.5).expect("legal");
    let found = hits(&gpu, &mut Sphere::new(), &empty, &view());
    assert!(found.iter().all(|hit| *hit == Hit::MISS));
}

#[test]
fn pixels_that_nobody_writes_are_undecided() {
    let Some(gpu) = Gpu::for_test() else { return };
    let targets = targets(&gpu, &scene(), false);
    let view = view();
    Frame::begin(&gpu, &targets, &view).expect("begins").finish().expect("finishes");
    let found = targets.read_hits(&gpu).expect("reads");
    assert!(found.iter().all(|hit| hit.verdict == Verdict::Undecided));
}

#[test]
fn capacities_grow_until_the_frame_is_complete() {
    let Some(gpu) = Gpu::for_test() else { return };
    let enough = hits(&gpu, &mut Sphere::new(), &scene(), &view());
    let mut small = Sphere { capacity: 3, ..Sphere::new() };
    let grown = hits(&gpu, &mut small, &scene(), &view());
    assert_eq!(small.capacity, HEIGHT);
    assert_eq!(grown, enough);
}

#[test]
fn an_incomplete_frame_is_an_error() {
    let Some(gpu) = Gpu::for_test() else { return };
    let targets = targets(&gpu, &scene(), false);
    let mut stuck = Sphere { capacity: HEIGHT - 1, can_grow: false, ..Sphere::new() };
    stuck.build(&gpu, &scene()).expect("builds");
    let error = render(&gpu, &mut stuck, &targets, &view()).expect_err("one row is missing");
    let RenderError::Incomplete { method: "sphere", status } = error else { panic!("{error}") };
    let missing = FrameStatus { unfinished: targets.width(), needed: [0, HEIGHT, 0, 0] };
    assert_eq!(status, missing);
}

#[test]
fn every_pass_is_timed_and_labels_are_summed() {
    let Some(gpu) = Gpu::for_test() else { return };
    let targets = targets(&gpu, &scene(), false);
    let view = view();
    let mut renderer = Sphere::new();
    renderer.build(&gpu, &scene()).expect("builds");
    let mut frame = Frame::begin(&gpu, &targets, &view).expect("begins");
    renderer.encode(&mut frame).expect("encodes");
    frame.cpu("sort", || std::thread::sleep(Duration::from_millis(2)));
    renderer.encode(&mut frame).expect("encodes");
    frame.cpu("sort", || std::thread::sleep(Duration::from_millis(2)));
    let report = frame.finish().expect("finishes");

    let labels: Vec<_> = report.passes.iter().map(|(label, _)| label.as_str()).collect();
    if gpu.report().timestamps {
        assert_eq!(labels, ["rays", "trace", "cpu:sort"]);
        assert_eq!(report.untimed_passes, 0);
        assert!(report.passes.iter().all(|(_, duration)| !duration.is_zero()));
    } else {
        assert_eq!(labels, ["cpu:sort"]);
        assert_eq!(report.untimed_passes, 3);
    }
    let total: Duration = report.passes.iter().map(|(_, duration)| *duration).sum();
    let (_, sort) = report.passes.last().expect("labels");
    assert!(*sort >= Duration::from_millis(4) && total <= report.wall);
}

#[test]
fn passes_beyond_the_query_set_are_counted() {
    let Some(gpu) = Gpu::for_test() else { return };
    let targets = targets(&gpu, &scene(), false);
    let view = view();
    let mut frame = Frame::begin(&gpu, &targets, &view).expect("begins");
    for _ in 0..2050 {
        frame.compute("idle", |_| {});
    }
    let report = frame.finish().expect("finishes");
    // A set of 4096 times 2048 passes; the first is the rays'.
    let timed = if gpu.report().timestamps { 2048 } else { 0 };
    assert_eq!(report.untimed_passes, 2051 - timed);
}

#[test]
fn colours_and_work_exist_when_requested() {
    let Some(gpu) = Gpu::for_test() else { return };
    let view = view();
    let mut renderer = Sphere { counting: true, ..Sphere::new() };
    let targets = targets(&gpu, &colored(), true);
    renderer.build(&gpu, &colored()).expect("builds");
    // Twice: a frame begins with no work done.
    for _ in 0..2 {
        render(&gpu, &mut renderer, &targets, &view).expect("renders");
    }
    let hits = targets.read_hits(&gpu).expect("reads");
    let colors = targets.read_colors(&gpu).expect("reads").expect("requested");
    let work = targets.read_work(&gpu).expect("reads").expect("requested");
    for ((hit, color), work) in hits.iter().zip(&colors).zip(&work) {
        assert_eq!(work.balls, 1);
        assert_eq!(work.evaluations, u32::from(hit.is_hit()));
        if hit.is_hit() {
            // Alone, the ball has the whole field. Decoding and encoding move a byte by nothing.
            assert_eq!(color.to_srgb(), [200, 40, 10]);
        }
    }

    let plain = super::sphere::targets(&gpu, &scene(), false);
    assert_eq!(plain.read_colors(&gpu).expect("reads"), None);
    assert_eq!(plain.read_work(&gpu).expect("reads"), None);
    let counted = size_of::<Work>() + size_of::<u32>();
    assert_eq!(targets.bytes() - plain.bytes(), (counted * view.pixels()) as u64);
}

#[test]
fn misuse_is_an_error() {
    let Some(gpu) = Gpu::for_test() else { return };
    let small = Targets::new(&gpu, 8, 8, false, false).expect("small enough");
    let view = view();
    let error = Frame::begin(&gpu, &small, &view).expect_err("another size");
    assert!(matches!(error, RenderError::ViewSize { needed: (8, 8), .. }), "{error}");

    let targets = targets(&gpu, &scene(), false);
    let first = Frame::begin(&gpu, &targets, &view).expect("begins");
    let error = Frame::begin(&gpu, &targets, &view).expect_err("in use");
    assert!(matches!(error, RenderError::TargetsInUse), "{error}");
    drop(first);
    Frame::begin(&gpu, &targets, &view).expect("free again").finish().expect("finishes");

    let error = Targets::new(&gpu, 0, 8, false, false).expect_err("no pixels");
    assert!(matches!(error, RenderError::PictureSize { width: 0, .. }), "{error}");
    let error = Targets::new(&gpu, 400_000, 400_000, false, false).expect_err("too many pixels");
    assert!(matches!(error, RenderError::TooLarge { what: "rays", .. }), "{error}");
}

#[test]
fn what_wgpu_refuses_is_an_error_and_not_a_panic() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Targets with work for a pipeline without.
    let targets = targets(&gpu, &scene(), true);
    let mut renderer = Sphere::new();
    renderer.build(&gpu, &scene()).expect("builds");
    let error = render(&gpu, &mut renderer, &targets, &view()).expect_err("layouts differ");
    assert!(matches!(error, RenderError::Refused { .. }), "{error}");

    // The device is none the worse.
    renderer.counting = true;
    renderer.build(&gpu, &scene()).expect("builds");
    render(&gpu, &mut renderer, &targets, &view()).expect("renders");
}
