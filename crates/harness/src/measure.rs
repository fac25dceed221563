//! Drawing with methods and timing them: warm before timing, one after the other in turn, never from
//! the same viewpoint twice.

use std::collections::BTreeMap;
use std::time::Duration;

use metaball_core::gpu::{self, BuildReport, FrameReport, Gpu, IsoRenderer, RenderError, Targets};
use metaball_core::{Aabb, Camera, Hit, Scene, View, ViewError};

use crate::canvas::Canvas;
use crate::record::{Samples, WorkPerRay};
use crate::renderer::{Built, Renderer};
use crate::stats::median;

/// A renderer that has built its structure for a scene and drawn it once: warm, and with buffers as
/// large as its first frame needed.
pub struct PreparedRenderer<'s> {
    /// What building took.
    pub build: BuildReport,
    /// What it found in the frame drawn last apart from timing, row by row from the top left.
    pub hits: Vec<Hit>,
    built: Built<'s>,
}

/// How many frames are timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// This many, where that does not take too long.
    pub most: usize,
    /// A method that has spent so much on them is not timed again, once it has two.
    pub enough: Duration,
}

impl Sampling {
    /// So many frames, however long they take.
    pub const fn exactly(frames: usize) -> Self {
        Self { most: frames, enough: Duration::MAX }
    }

    /// Five frames, or what fits into four seconds.
    pub const QUICK: Self = Self { most: 5, enough: Duration::from_secs(4) };
}

/// Times of complete frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Wall time of each frame, from the start of encoding to the fence; of a method on the CPU, that of
    /// tracing the rays.
    pub frame_ms: Samples,
    /// Median milliseconds of each pass, over the frames that have it.
    pub passes: BTreeMap<String, f64>,
}

impl<'s> PreparedRenderer<'s> {
    /// Builds for the scene and draws the view. Targets of the canvas have work counters if the renderer
    /// counts.
    ///
    /// # Errors
    /// When the renderer cannot do the scene, or its frame stays incomplete.
    pub fn prepare(
        canvas: Canvas<'_>,
        renderer: Renderer,
        scene: &'s Scene,
        view: &View,
    ) -> Result<Self, RenderError> {
        let (mut built, build) = renderer.build(canvas.gpu(), scene)?;
        let drawn = canvas.draw(&mut built, view)?;
        Ok(Self { build, hits: canvas.hits(drawn)?, built })
    }

    /// Draws a frame on a canvas like the one that it was prepared with.
    ///
    /// # Errors
    /// When the frame stays incomplete, or the device fails.
    pub fn draw(&mut self, canvas: Canvas<'_>, view: &View) -> Result<FrameReport, RenderError> {
        Ok(canvas.draw(&mut self.built, view)?.report)
    }

    /// Draws another view, on a canvas of any size: `hits` are of that one now.
    ///
    /// # Errors
    /// When its frame stays incomplete.
    pub fn redraw(&mut self, canvas: Canvas<'_>, view: &View) -> Result<(), RenderError> {
        let drawn = canvas.draw(&mut self.built, view)?;
        self.hits = canvas.hits(drawn)?;
        Ok(())
    }

    /// Bytes that it holds by now, for the scene and for its frames: on the adapter, or, on the CPU, in
    /// main memory.
    pub fn device_bytes(&self) -> u64 {
        self.build.device_bytes + self.built.frame_bytes()
    }
}

/// Draws every view with every renderer, in turn: A B A B, so that a machine that grows hot or busy
/// is so for all. A renderer that fails has an error instead of a timing and is not drawn with again, nor is one
/// that has had `enough` of at least two frames. Calls `after_frame` for each view and renderer.
pub fn time_all(
    canvas: Canvas<'_>,
    renderers: &mut [PreparedRenderer<'_>],
    views: &[View],
    enough: Duration,
    mut after_frame: impl FnMut(),
) -> Vec<Result<Timing, RenderError>> {
    let mut frames: Vec<Result<Frames, RenderError>> =
        renderers.iter().map(|_| Ok(Frames::default())).collect();
    for view in views {
        for (renderer, frames) in renderers.iter_mut().zip(&mut frames) {
            if let Ok(taken) = frames
                && !(taken.wall_ms.len() >= LEAST_FRAMES && taken.total() >= enough)
            {
                match renderer.draw(canvas, view) {
                    Ok(report) => taken.add(report.wall, &report.passes),
                    Err(error) => *frames = Err(error),
                }
            }
            after_frame();
        }
    }
    frames.into_iter().map(|frames| frames.map(Frames::summary)).collect()
}

/// Draws one frame with a renderer that counts its work, one of its own: counting slows a shader
/// down.
///
/// # Errors
/// As [`PreparedRenderer::prepare`].
pub fn count_work(
    gpu: &Gpu,
    mut renderer: Box<dyn IsoRenderer>,
    scene: &Scene,
    view: &View,
) -> Result<WorkPerRay, RenderError> {
    renderer.build(gpu, scene)?;
    let colors = scene.colors().is_some();
    let targets = Targets::new(gpu, view.width(), view.height(), colors, true)?;
    gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let work = targets.read_work(gpu)?.unwrap_or_default();
    Ok(WorkPerRay::mean(&work))
}

/// The views to time a scene from: along the path, or at `camera` where there is none, each moved by
/// up to two pixels, so that no frame is the one before. The same for every call.
///
/// # Errors
/// When the size is no image size.
pub fn views(
    camera: &Camera,
    path: &[Camera],
    bounds: &Aabb,
    (width, height): (u32, u32),
    count: usize,
) -> Result<Vec<View>, ViewError> {
    let view = |sample: usize| {
        let camera = match path {
            [] => camera,
            path => &path[sample * path.len() / count],
        };
        let (right, up) = shift(sample + 1);
        let reach = 4.0 * pixel_at(camera, bounds, height);
        View::new(camera.shifted(right * reach, up * reach), width, height)
    };
    (0..count).map(view).collect()
}

/// An even spread of points over the square from −½ to ½: multiples of the inverse of the plastic
/// number and of its square, modulo 1.
fn shift(index: usize) -> (f32, f32) {
    let share = |step: f64| ((index as f64 * step).fract() - 0.5) as f32;
    (share(0.754_877_666), share(0.569_840_291))
}

/// A pixel's height where the scene is, scene units; enough for the camera to move at all.
fn pixel_at(camera: &Camera, bounds: &Aabb, height: u32) -> f32 {
    let distance = if bounds.is_empty() {
        1.0
    } else {
        camera.eye().distance(bounds.center()).max(0.5 * bounds.extent().length())
    };
    let pixel = 2.0 * camera.half_height() * distance / height as f32;
    pixel.max(2.0 * f32::EPSILON * camera.eye().abs().max_element())
}

#[derive(Default)]
struct Frames {
    wall_ms: Vec<f64>,
    passes_ms: BTreeMap<String, Vec<f64>>,
}

/// Frames of even the slowest method: one alone has no spread.
const LEAST_FRAMES: usize = 2;

impl Frames {
    fn total(&self) -> Duration {
        Duration::from_secs_f64(1e-3 * self.wall_ms.iter().sum::<f64>())
    }

    fn add(&mut self, wall: Duration, passes: &[(String, Duration)]) {
        self.wall_ms.push(milliseconds(wall));
        for (label, time) in passes {
            self.passes_ms.entry(label.clone()).or_default().push(milliseconds(*time));
        }
    }

    fn summary(self) -> Timing {
        let passes = self
            .passes_ms
            .into_iter()
            .filter_map(|(label, times)| Some((label, median(&times)?)))
            .collect();
        Timing { frame_ms: Samples::new(self.wall_ms), passes }
    }
}

/// A duration in milliseconds.
pub fn milliseconds(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn frames_are_summed_up_by_pass() {
        let mut frames = Frames::default();
        let ms = Duration::from_millis;
        frames.add(ms(10), &[("rays".into(), ms(1)), ("trace".into(), ms(9))]);
        frames.add(ms(30), &[("rays".into(), ms(3)), ("trace".into(), ms(27))]);
        frames.add(ms(20), &[("rays".into(), ms(2))]);
        assert_eq!(frames.total(), ms(60));
        let timing = frames.summary();
        assert_eq!(timing.frame_ms.median, 20.0);
        assert_eq!(timing.frame_ms.samples, [10.0, 30.0, 20.0]);
        let passes = [("rays".to_owned(), 2.0), ("trace".to_owned(), 18.0)];
        assert_eq!(timing.passes, BTreeMap::from(passes));
    }

    #[test]
    fn no_view_is_the_one_before() {
        for far in [0.0, 1e6] {
            let bounds = Aabb::around_sphere(Vec3::splat(far), 1.0);
            let camera = Camera::framing(&bounds, Vec3::Z);
            let path = [camera, camera.shifted(10.0, 0.0)];
            for path in [&path[..], &[]] {
                let views = views(&camera, path, &bounds, (64, 48), 12).expect("a size");
                let eyes: Vec<_> = views.iter().map(|view| view.camera().eye()).collect();
                assert_eq!(eyes.len(), 12);
                assert!(eyes.windows(2).all(|pair| pair[0] != pair[1]));
                let moved = eyes[0].distance(eyes[11]);
                assert_eq!(moved > 5.0, !path.is_empty(), "{moved}");
            }
        }
    }
}
