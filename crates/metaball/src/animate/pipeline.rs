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

use std::ops::ControlFlow;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use metaball_core::gpu::{self, Gpu, IsoRenderer, Shading, Targets};
use metaball_core::{Image, Scene, View};
use particle_files::{AnimatedScene, BoxError, NumberedPath};
use picture_files::write_described;

use super::report::{FrameOutcome, FrameReport, FrameTimes, milliseconds};
use crate::adapter::Certain;
use crate::draw::on_cpu;
use crate::light::Lighting;
use crate::summary::Summary;
use crate::{DrawOptions, Error, is_trouble};

/// What all frames of a run have in common.
pub(super) struct Job<'a> {
    pub(super) options: &'a DrawOptions,
    pub(super) scene: &'a dyn AnimatedScene,
    pub(super) view: &'a View,
    /// `None` where the CPU draws.
    pub(super) gpu: Option<&'a Gpu>,
    /// `None` for the shared shading.
    pub(super) lighting: Option<&'a Lighting>,
    pub(super) out: &'a NumberedPath,
}

/// What draws a frame; none where the CPU does.
type Renderer = Option<Box<dyn IsoRenderer>>;

/// A frame that is ready to be drawn, unless its balls could not be had.
struct Ready {
    number: u32,
    scene: Result<Scene, BoxError>,
    renderer: Renderer,
    load: Duration,
    build: Duration,
}

/// The picture of a frame.
struct Drawn {
    image: Image,
    /// But for what went before it was drawn.
    times: FrameTimes,
    /// Rays that the CPU was asked for the adapter.
    asked_again: u64,
}

impl Job<'_> {
    /// What a frame's file describes: all that its pixels depend on but the user's files.
    pub(super) fn description(&self, number: u32) -> String {
        let DrawOptions { method, picture, clip, light, .. } = self.options;
        format!(
            "metaball {}: frame {number} of {}, {} × {}, {picture:?} by {} on {}, {:?}, {clip:?}, \
             {light:?}",
            env!("CARGO_PKG_VERSION"),
            self.scene.description(),
            self.view.width(),
            self.view.height(),
            method.name(),
            if self.gpu.is_some() { "an adapter" } else { "the CPU" },
            self.view.camera()
        )
    }

    /// Draws frames and writes their files, in order.
    pub(super) fn draw(
        &self,
        numbers: &[u32],
        in_turn: bool,
        mut after_frame: impl FnMut(&FrameReport),
    ) -> Result<Vec<FrameReport>, Error> {
        let (free_sender, free) = mpsc::channel::<Renderer>();
        let (ready_sender, ready) = mpsc::channel::<Result<Ready, Error>>();
        let (picture_sender, pictures) = mpsc::sync_channel::<(u32, Image)>(1);
        for _ in 0..if in_turn { 1 } else { 2 } {
            let renderer = self.gpu.map(|_| self.options.renderer()).transpose()?;
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
                // Without an answer the thread that builds has panicked: the scope resumes that panic.
                let Ok(prepared) = ready.recv() else { break };
                let Ready { number, scene, mut renderer, load, build } = prepared?;
                let waited = start.elapsed();
                let outcome = match scene {
                    Err(error) => FrameOutcome::Broken {
                        error: chain(error.as_ref()),
                        trouble: is_trouble(error.as_ref()),
                    },
                    Ok(scene) => {
                        let Drawn { image, times, asked_again } = self
                            .picture(&scene, &mut renderer, &mut targets)
                            .map_err(self.stopped(number))?;
                        if picture_sender.send((number, image)).is_err() {
                            break;
                        }
                        let times = FrameTimes {
                            load_ms: milliseconds(load),
                            build_ms: milliseconds(build) + times.build_ms,
                            waited_ms: milliseconds(waited),
                            ..times
                        };
                        FrameOutcome::Drawn { times, asked_again }
                    }
                };
                // After the last frame none waits for it.
                let _ = free_sender.send(renderer);
                let frame = FrameReport { number, outcome };
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
    fn prepare(&self, number: u32, mut renderer: Renderer) -> Result<Ready, Error> {
        let start = Instant::now();
        let scene = self.scene.frame(number);
        let load = start.elapsed();
        if let (Ok(scene), Some(gpu), Some(renderer)) = (&scene, self.gpu, &mut renderer) {
            renderer.build(gpu, scene).map_err(Error::from).map_err(self.stopped(number))?;
        }
        Ok(Ready { number, scene, renderer, load, build: start.elapsed() - load })
    }

    /// Draws what the renderer was built for. The targets are those of the frame before, if any.
    fn picture(
        &self,
        scene: &Scene,
        renderer: &mut Renderer,
        targets: &mut Option<Targets>,
    ) -> Result<Drawn, Error> {
        let none = FrameTimes::default();
        let (Some(gpu), Some(renderer)) = (self.gpu, renderer) else {
            let start = Instant::now();
            let computed_by = "the CPU".to_owned();
            let drawn = on_cpu(self.options, self.lighting, scene, self.view, computed_by)?;
            let Summary { build, tally, .. } = drawn.summary;
            let (build_ms, draw_ms) = (milliseconds(build), milliseconds(tally.frame));
            let shade_ms = milliseconds(start.elapsed()) - build_ms - draw_ms;
            let times = FrameTimes { build_ms, draw_ms, shade_ms, ..none };
            return Ok(Drawn { image: drawn.image, times, asked_again: tally.asked_again });
        };
        // Frames of a sequence need not agree on whether they have colours.
        let colors = scene.colors().is_some();
        let targets = match targets.take().filter(|old: &Targets| old.colors().is_some() == colors)
        {
            Some(same) => targets.insert(same),
            None => targets.insert(self.options.targets(gpu, scene)?),
        };
        let frame = gpu::render(gpu, renderer.as_mut(), targets, self.view)?;
        let start = Instant::now();
        let certain = Certain::new(scene);
        let mut hits = targets.read_hits(gpu)?;
        let mut asked_again = certain.decide(gpu, targets, self.view, &mut hits)?;
        let image = match self.lighting {
            Some(lighting) => {
                let all = |_| ControlFlow::Continue(());
                let lit = lighting.draw(gpu, renderer.as_mut(), &certain, self.view, &hits, all)?;
                asked_again += lit.asked_again;
                lit.image
            }
            None => Shading::new(gpu).draw(targets, self.view, scene, self.options.picture)?.image,
        };
        let (draw_ms, shade_ms) = (milliseconds(frame.wall), milliseconds(start.elapsed()));
        Ok(Drawn { image, times: FrameTimes { draw_ms, shade_ms, ..none }, asked_again })
    }

    /// To be given what stopped a frame.
    fn stopped(&self, number: u32) -> impl FnOnce(Error) -> Error {
        move |source| {
            let source = match source {
                Error::Render(refusal) => self.options.refused(refusal),
                source => source,
            };
            Error::Frame { number, source: Box::new(source) }
        }
    }

    fn write(&self, number: u32, image: &Image) -> Result<(), Error> {
        Ok(write_described(&self.out.path(number), image, &self.description(number))?)
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

    use bench_scenes::{Moving, Overrides};
    use fbvh::Options;
    use glam::Vec3;
    use metaball_core::{Clip, Picture};

    use super::*;
    use crate::{LightOptions, Method};

    /// A frame is kept only if none of these was another when it was drawn.
    #[test]
    fn a_description_tells_pictures_apart() {
        let plain = DrawOptions { size: (32, 24), ..DrawOptions::default() };
        let none = LightOptions::default;
        let lit = |light| DrawOptions { light, ..plain.clone() };
        let same = Overrides::default();
        let threshold = Overrides { threshold: Some(0.3), ..same };
        let modified = Method::Tree(Options::modified_bvh());
        let clip = Clip::default().and_plane(Vec3::X, 0.5).expect("a plane");
        let drawings = [
            ("tornado:100", same, plain.clone()),
            ("tornado:101", same, plain.clone()),
            ("tornado:100", threshold, plain.clone()),
            ("tornado:100", same, DrawOptions { method: modified, ..plain.clone() }),
            ("tornado:100", same, DrawOptions { size: (33, 24), ..plain.clone() }),
            ("tornado:100", same, DrawOptions { picture: Picture::Depth, ..plain.clone() }),
            ("tornado:100", same, DrawOptions { clip, ..plain.clone() }),
            ("tornado:100", same, lit(LightOptions { shadows: true, ..none() })),
            ("tornado:100", same, lit(LightOptions { samples: Some(4), ..none() })),
            ("tornado:100", same, lit(LightOptions { samples: Some(4), seed: Some(1), ..none() })),
            ("tornado:100", same, lit(LightOptions { exposure: Some(1.0), ..none() })),
        ];
        let out = "f-%d.png".parse().expect("numbered");
        let described = |(spec, overrides, options): &(&str, Overrides, DrawOptions), number| {
            let scene = Moving::load(spec, overrides).expect("a scene that moves");
            let (width, height) = options.size;
            let view = View::new(scene.camera, width, height).expect("a size");
            let job =
                Job { options, scene: &scene, view: &view, gpu: None, lighting: None, out: &out };
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
