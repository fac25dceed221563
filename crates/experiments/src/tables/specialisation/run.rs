//! One method on one scene, specialised and as if the scene needed more, in alternate frames.

use std::iter::zip;

use anyhow::Context;
use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::gpu::{Gpu, Targets};
use metaball_core::{Generality, Hit, Scene, View};
use serde::{Deserialize, Serialize};

use crate::console::ProgressBar;
use harness::canvas::Canvas;
use harness::measure::{PreparedRenderer, milliseconds, views};
use harness::methods::Method;
use harness::record::Samples;

/// How shaders are made: what they read, although they could have been made for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    /// In tables.
    pub name: &'static str,
    /// What the scene is generalized to.
    pub reads: &'static [Generality],
    /// Whether work is counted.
    pub counting: bool,
    /// Why a scene may not have this form: what it is about, it needs or has not got.
    moot: &'static str,
}

const fn reading(name: &'static str, reads: &'static [Generality], moot: &'static str) -> Form {
    Form { name, reads, counting: false, moot }
}

/// What is measured side by side; the first is what every scene gets.
pub const FORMS: [Form; 8] = [
    reading("specialised", &[], ""),
    reading("any kernel", &[Generality::Kernel], ""),
    reading("any exponent", &[Generality::Exponent], "the kernel has no exponent"),
    reading("a radius each", &[Generality::Radii], "radii vary"),
    reading("a strength each", &[Generality::Strengths], "strengths vary"),
    reading("a colour each", &[Generality::Colors], "balls have colours"),
    Form { name: "work counted", reads: &[], counting: true, moot: "" },
    Form { name: "all of these", reads: &Generality::ALL, counting: true, moot: "" },
];

impl Form {
    /// The scene as if it needed what this form reads; an error where that changes nothing.
    pub(super) fn scene(&self, scene: &Scene) -> Result<Scene, String> {
        let general = self.reads.iter().fold(scene.clone(), |scene, &part| scene.generalized(part));
        if !self.moot.is_empty() && general == *scene {
            Err(self.moot.to_owned())
        } else {
            Ok(general)
        }
    }
}

/// A scene to be drawn by a method in all forms.
#[derive(Debug, Clone)]
pub struct PlannedScene {
    /// What to load.
    pub spec: String,
    /// Who draws.
    pub method: &'static Method,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Frames of each form.
    pub rounds: usize,
}

/// A scene and a method with its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneForms {
    /// What was loaded.
    pub scene: String,
    /// Number of balls.
    pub balls: usize,
    /// Name of the method.
    pub method: String,
    /// One row for each of [`FORMS`].
    pub rows: Vec<Row>,
}

/// A form with its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the form.
    pub form: String,
    /// What was measured, or why nothing was.
    pub result: Result<Measured, String>,
}

/// What was measured of a form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Milliseconds of each frame, by the wall's clock.
    pub frame_ms: Samples,
    /// Each frame's time over that of the specialised frame of the same round and camera.
    pub times: Samples,
    /// Bytes on the adapter: the scene, the method's own, and what a frame is drawn to.
    pub device_bytes: u64,
    /// Expressions and statements of all the method's shaders, before the driver sees them.
    pub code: u64,
    /// Pixels of the first frame that are not those of the specialised form, bit for bit.
    pub differing_pixels: usize,
}

/// A form ready to draw.
struct Drawer<'s> {
    renderer: PreparedRenderer<'s>,
    targets: Targets,
    code: u64,
    frame_ms: Vec<f64>,
}

impl<'s> Drawer<'s> {
    fn new(
        gpu: &Gpu,
        method: &Method,
        form: &Form,
        scene: &'s Scene,
        view: &View,
    ) -> anyhow::Result<Self> {
        let has_colors = scene.colors().is_some();
        let targets = Targets::new(gpu, view.width(), view.height(), has_colors, form.counting)?;
        let before = gpu.code();
        let renderer = method.renderer(form.counting);
        let canvas = Canvas::on_adapter(gpu, &targets);
        let renderer = PreparedRenderer::prepare(canvas, renderer, scene, view)?;
        Ok(Self { renderer, targets, code: gpu.code() - before, frame_ms: Vec::new() })
    }

    fn measured(self, specialised: &Specialised) -> Measured {
        let times = zip(&self.frame_ms, &specialised.frame_ms).map(|(own, least)| own / least);
        let hits = zip(&self.renderer.hits, &specialised.hits);
        Measured {
            times: Samples::new(times.collect()),
            device_bytes: self.renderer.device_bytes() + self.targets.bytes(),
            code: self.code,
            differing_pixels: hits.filter(|(own, other)| own != other).count(),
            frame_ms: Samples::new(self.frame_ms),
        }
    }
}

/// What the other forms are held against.
struct Specialised {
    frame_ms: Vec<f64>,
    hits: Vec<Hit>,
}

impl PlannedScene {
    /// Steps of progress: preparing each form, and the rounds.
    pub(super) fn steps(&self) -> u64 {
        FORMS.len() as u64 + self.rounds as u64
    }

    /// Measures all forms; one that cannot be drawn has its reason instead.
    ///
    /// # Errors
    /// When the scene does not load or the specialised form cannot be drawn.
    pub(super) fn measure(&self, gpu: &Gpu, progress: &ProgressBar) -> anyhow::Result<SceneForms> {
        let BenchScene { scene, camera, .. } = load(&self.spec, &Overrides::default())?;
        let views = views(&camera, &[], &scene.bounds(), self.size, self.rounds)?;
        let first = views.first().context("needed a round to measure, found none")?;
        let scenes: Vec<_> = FORMS.iter().map(|form| form.scene(&scene)).collect();
        let mut drawers = Vec::new();
        for (form, general) in zip(&FORMS, &scenes) {
            progress.stage(format!("{}, {}: {}", self.spec, self.method.name, form.name));
            drawers.push(general.as_ref().map_err(String::clone).and_then(|general| {
                Drawer::new(gpu, self.method, form, general, first)
                    .map_err(|error| format!("{error:#}"))
            }));
            progress.advance(1);
        }
        for view in &views {
            for Drawer { renderer, targets, frame_ms, .. } in drawers.iter_mut().flatten() {
                let report = renderer.draw(Canvas::on_adapter(gpu, targets), view)?;
                frame_ms.push(milliseconds(report.wall));
            }
            progress.advance(1);
        }
        let specialised = match &drawers[0] {
            Ok(Drawer { renderer, frame_ms, .. }) => {
                Specialised { frame_ms: frame_ms.clone(), hits: renderer.hits.clone() }
            }
            Err(reason) => anyhow::bail!("{reason}"),
        };
        let row = |(form, drawer): (&Form, Result<Drawer<'_>, String>)| Row {
            form: form.name.to_owned(),
            result: drawer.map(|drawer| drawer.measured(&specialised)),
        };
        Ok(SceneForms {
            scene: self.spec.clone(),
            balls: scene.len(),
            method: self.method.name.to_owned(),
            rows: zip(&FORMS, drawers).map(row).collect(),
        })
    }
}
