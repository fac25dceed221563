//! Frames one after the other, through three threads.
//!
//! # Theory
//! Gourmel et al. 2010, figure 7: the structure of the next frame is built on the CPU while the GPU
//! draws this one. One thread makes the scene of a frame and builds for it, this one draws, a third
//! encodes and writes the picture.
//!
//! # Changes versus the paper
//! Balls are moved on the CPU, or read from a file, where the paper moves them on the GPU and copies
//! them to the host.
//!
//! # Practice
//! Two renderers take turns: one draws what it was built for while the other builds. With one alone
//! the same threads work in turn, which is what the pipeline is compared with.

use std::fmt;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context;
use bench_scenes::{LoadError, Moving};
use metaball_core::gpu::{self, Gpu, Image, IsoRenderer, Shading, Targets};
use metaball_core::{Scene, View};
use particle_files::NumberedPath;
use serde::Serialize;

use crate::frame_png::encode_described;
use crate::light::Lighting;
use crate::measure::milliseconds;
use crate::numbers::decimal;
use crate::output::write_atomically;
use crate::render::{Drawing, on_cpu};

/// What all frames of a run have in common.
pub(super) struct Job<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) moving: &'a Moving,
    pub(super) view: &'a View,
    /// `None` where the CPU draws.
    pub(super) gpu: Option<&'a Gpu>,
    /// `None` for the shared shading.
    pub(super) lighting: Option<&'a Lighting>,
    pub(super) out: &'a NumberedPath,
}

/// A frame and what became of it.
#[derive(Debug, Serialize)]
pub(super) struct Frame {
    pub(super) number: u32,
    #[serde(flatten)]
    pub(super) outcome: Outcome,
}

#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Outcome {
    Drawn(Times),
    /// Its particles could not be used.
    Broken {
        error: String,
    },
}

/// Milliseconds of a frame's stages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Times {
    /// To make or read the balls.
    pub(super) load_ms: f64,
    /// To build for them: the structure, its upload, and in a renderer's first frame its pipelines.
    pub(super) build_ms: f64,
    /// The drawing thread stood still for want of the two above.
    pub(super) waited_ms: f64,
    /// From the start of encoding to the device's fence.
    pub(super) draw_ms: f64,
    /// To shade the picture, with all effects of light, and to read it back.
    pub(super) shade_ms: f64,
}

/// What draws a frame; none where the CPU does.
type Renderer = Option<Box<dyn IsoRenderer>>;

/// A frame that is ready to be drawn, unless its balls could not be had.
struct Ready {
    number: u32,
    scene: Result<Scene, LoadError>,
    renderer: Renderer,
    load: Duration,
    build: Duration,
}

impl Job<'_> {
    /// What a frame's file says that it shows: all that its pixels depend on but the user's files.
    pub(super) fn description(&self, number: u32) -> String {
        let Drawing { overrides, method, picture, light, .. } = self.drawing;
        format!(
            "metaball {}: frame {number} of {} with {overrides:?}, {} × {}, {picture:?} by {} on {}, \
             {:?}, {light:?}",
            env!("CARGO_PKG_VERSION"),
            self.moving.name,
            self.view.width(),
            self.view.height(),
            method.name,
            if self.gpu.is_some() { "an adapter" } else { "the CPU" },
            self.view.camera()
        )
    }

    /// Draws frames and writes their files, in order.
    pub(super) fn draw(
        &self,
        numbers: &[u32],
        in_turn: bool,
        mut after_frame: impl FnMut(&Frame),
    ) -> anyhow::Result<Vec<Frame>> {
        let (free_sender, free) = mpsc::channel::<Renderer>();
        let (ready_sender, ready) = mpsc::channel::<anyhow::Result<Ready>>();
        let (picture_sender, pictures) = mpsc::sync_channel::<(u32, Image)>(1);
        for _ in 0..if in_turn { 1 } else { 2 } {
            let renderer = self.gpu.map(|_| self.drawing.renderer());
            // The receiver is held above.
            let _ = free_sender.send(renderer);
        }
        thread::scope(move |scope| {
            // Either thread ends when the other side of a channel is gone: after the last frame, or
            // after an error.
            scope.spawn(move || {
                for (number, renderer) in numbers.iter().zip(free) {
                    if ready_sender.send(self.prepare(*number, renderer)).is_err() {
                        break;
                    }
                }
            });
            let writer = scope.spawn(move || {
                pictures.into_iter().try_for_each(|(number, image)| self.write(number, &image))
            });

            let mut targets = None;
            let mut frames = Vec::new();
            for _ in numbers {
                let start = Instant::now();
                let Ready { number, scene, mut renderer, load, build } =
                    ready.recv().context("the thread that builds is gone")??;
                let waited = start.elapsed();
                let outcome = match scene {
                    Err(error) => Outcome::Broken { error: chain(&error) },
                    Ok(scene) => {
                        let (image, times) = self
                            .picture(&scene, &mut renderer, &mut targets)
                            .with_context(|| format!("frame {number}"))?;
                        if picture_sender.send((number, image)).is_err() {
                            break;
                        }
                        Outcome::Drawn(Times {
                            load_ms: milliseconds(load),
                            build_ms: milliseconds(build) + times.build_ms,
                            waited_ms: milliseconds(waited),
                            ..times
                        })
                    }
                };
                // After the last frame nobody waits for it.
                let _ = free_sender.send(renderer);
                let frame = Frame { number, outcome };
                after_frame(&frame);
                frames.push(frame);
            }
            drop(picture_sender);
            match writer.join() {
                Ok(written) => written.map(|()| frames),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        })
    }

    /// Makes the scene of a frame, and builds for it.
    fn prepare(&self, number: u32, mut renderer: Renderer) -> anyhow::Result<Ready> {
        let start = Instant::now();
        let scene = self.moving.frame(number);
        let load = start.elapsed();
        if let (Ok(scene), Some(gpu), Some(renderer)) = (&scene, self.gpu, &mut renderer) {
            renderer.build(gpu, scene).with_context(|| format!("frame {number}"))?;
        }
        Ok(Ready { number, scene, renderer, load, build: start.elapsed() - load })
    }

    /// Draws what the renderer was built for. The targets are those of the frame before, if any.
    fn picture(
        &self,
        scene: &Scene,
        renderer: &mut Renderer,
        targets: &mut Option<Targets>,
    ) -> anyhow::Result<(Image, Times)> {
        let none =
            Times { load_ms: 0.0, build_ms: 0.0, waited_ms: 0.0, draw_ms: 0.0, shade_ms: 0.0 };
        let (Some(gpu), Some(renderer)) = (self.gpu, renderer) else {
            let start = Instant::now();
            let drawn = on_cpu(self.drawing, scene, self.view)?;
            let (build_ms, draw_ms) = (drawn.build_ms, drawn.frame_ms);
            let shade_ms = milliseconds(start.elapsed()) - build_ms - draw_ms;
            return Ok((drawn.shaded.image, Times { build_ms, draw_ms, shade_ms, ..none }));
        };
        // Frames of a sequence need not agree on whether they have colours.
        let colors = scene.colors().is_some();
        let targets = match targets.take().filter(|old: &Targets| old.colors().is_some() == colors)
        {
            Some(same) => targets.insert(same),
            None => targets.insert(self.drawing.targets(gpu, scene)?),
        };
        let frame = gpu::render(gpu, renderer.as_mut(), targets, self.view)?;
        let start = Instant::now();
        let image = match self.lighting {
            Some(lighting) => {
                let hits = targets.read_hits(gpu)?;
                lighting.expose(gpu, renderer.as_mut(), scene, self.view, &hits, || ())?.image
            }
            None => Shading::new(gpu).draw(targets, self.view, scene, self.drawing.picture)?.image,
        };
        let (draw_ms, shade_ms) = (milliseconds(frame.wall), milliseconds(start.elapsed()));
        Ok((image, Times { draw_ms, shade_ms, ..none }))
    }

    fn write(&self, number: u32, image: &Image) -> anyhow::Result<()> {
        let png = encode_described(image, &self.description(number))?;
        write_atomically(&self.out.path(number), &png)
    }
}

impl Outcome {
    pub(super) fn is_broken(&self) -> bool {
        matches!(self, Self::Broken { .. })
    }

    pub(super) fn times(&self) -> Option<&Times> {
        match self {
            Self::Drawn(times) => Some(times),
            Self::Broken { .. } => None,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawn(times) => {
                let [build, draw] = [times.build_ms, times.draw_ms].map(decimal);
                write!(formatter, "built in {build} ms, drawn in {draw} ms")
            }
            Self::Broken { .. } => write!(formatter, "not drawn"),
        }
    }
}

/// An error with its causes, in one line.
fn chain(error: &dyn std::error::Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", chain(source)),
        None => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use bench_scenes::Overrides;
    use metaball_core::gpu::Picture;

    use super::*;
    use crate::camera::CameraOptions;
    use crate::light::LightOptions;
    use crate::light::tests::options;
    use crate::methods::find;
    use crate::render::Device;

    /// A frame is kept only if none of these was another when it was drawn.
    #[test]
    fn a_description_tells_pictures_apart() {
        let plain = Drawing {
            scene: "tornado:100".to_owned(),
            overrides: Overrides::default(),
            method: find("fbvh").expect("listed"),
            size: (32, 24),
            camera: CameraOptions::default(),
            picture: Picture::Phong,
            light: LightOptions::default(),
            device: Device::Cpu,
        };
        let threshold = Overrides { threshold: Some(0.3), ..Overrides::default() };
        let drawings = [
            plain.clone(),
            Drawing { scene: "tornado:101".to_owned(), ..plain.clone() },
            Drawing { overrides: threshold, ..plain.clone() },
            Drawing { method: find("bvh").expect("listed"), ..plain.clone() },
            Drawing { size: (33, 24), ..plain.clone() },
            Drawing { picture: Picture::Depth, ..plain.clone() },
            Drawing { light: options("--shadows"), ..plain.clone() },
            Drawing { light: options("--samples 4"), ..plain.clone() },
            Drawing { light: options("--samples 4 --seed 1"), ..plain.clone() },
            Drawing { light: options("--exposure 1"), ..plain },
        ];
        let out = "f-%d.png".parse().expect("numbered");
        let described = |drawing: &Drawing, number| {
            let moving = Moving::load(&drawing.scene, &drawing.overrides).expect("moves");
            let (width, height) = drawing.size;
            let view = View::new(moving.camera, width, height).expect("a size");
            let job =
                Job { drawing, moving: &moving, view: &view, gpu: None, lighting: None, out: &out };
            job.description(number)
        };
        let mut found: BTreeSet<String> =
            drawings.iter().map(|drawing| described(drawing, 0)).collect();
        assert_eq!(found.len(), drawings.len(), "{found:#?}");
        assert!(
            !found.insert(described(&drawings[0], 0)) && found.insert(described(&drawings[0], 1))
        );
    }
}
