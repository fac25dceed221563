//! One scene, all methods: pictures, comparison with the reference, times, work.

use std::collections::BTreeMap;

use anyhow::ensure;
use bench_scenes::BenchScene;
use metaball_core::gpu::{Gpu, RenderError, Shading, Targets};
use metaball_core::shade::{self, CpuPicture};
use metaball_core::{Hit, Picture, Ray, Shaded, Verdict, View};

use crate::canvas::Canvas;
use crate::configuration::Configuration;
use crate::heat::heat_map;
use crate::imported::ImportedHits;
use crate::measure::{
    PreparedRenderer, Sampling, Timing, count_work, milliseconds, time_all, views,
};
use crate::progress::Progress;
use crate::record::{Adapter, Measured, Record, Status, WorkPerRay};
use crate::reference::Reference;
use crate::score::{Accuracy, many_are_ambiguous, score};
use picture_files::encode_png;

/// How to compare.
#[derive(Debug, Clone)]
pub struct Options {
    /// What is compared.
    pub configurations: Vec<Configuration>,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// How often each is timed.
    pub sampling: Sampling,
    /// Whether to time along the scene's camera path, where it has one, instead of near its camera.
    pub along_path: bool,
    /// Whether to compare every pixel of a large scene too.
    pub every_pixel: bool,
    /// Pictures by other programs, compared too.
    pub imported: Vec<ImportedHits>,
    /// Whether to count work too, with renderers of its own, whose shaders are compiled anew.
    pub counts_work: bool,
}

/// All methods on one scene.
#[derive(Debug, Clone)]
pub struct SceneComparison {
    /// Name of the scene.
    pub scene: String,
    /// One sentence about it.
    pub about: String,
    /// One for each method, in order.
    pub records: Vec<Record>,
    /// PNG of the reference's hits under the shading of all; `None` when no method drew anything.
    pub reference: Option<Vec<u8>>,
    /// Pictures of the methods that have a result, in order.
    pub pictures: Vec<Pictures>,
    /// What a reader should know of this scene's numbers.
    pub remarks: Vec<String>,
}

/// What a method drew.
#[derive(Debug, Clone)]
pub struct Pictures {
    /// Name of the method, or of another program.
    pub method: String,
    /// PNG of its picture.
    pub shaded: Vec<u8>,
    /// PNG of its difference to the reference.
    pub heat: Vec<u8>,
}

/// Steps of progress that [`compare_scene`] makes. A configuration's first frame, for which shaders are
/// compiled, counts as much as all that are timed, which take about as long.
pub fn steps(options: &Options) -> u64 {
    (options.configurations.len() * (2 * options.sampling.most + 1) + 1) as u64
}

/// Compares all configurations on a scene. One that cannot build or draw has a record that says why; the
/// others continue. Without an adapter that is true of all that need one.
///
/// # Errors
/// When the scene or the size is too much for what all methods share: the targets, or the shading.
pub fn compare_scene(
    gpu: Option<&Gpu>,
    bench: &BenchScene,
    options: &Options,
    progress: &dyn Progress,
) -> anyhow::Result<SceneComparison> {
    let comparer = Comparer::new(gpu, bench, options, progress)?;
    let mut results = Results::new();
    let frames = comparer.draw(&mut results)?;
    let mut comparison = SceneComparison {
        scene: bench.name.clone(),
        about: bench.about.clone(),
        records: Vec::new(),
        reference: None,
        pictures: Vec::new(),
        remarks: Vec::new(),
    };
    let mut scored = Vec::new();
    if !frames.is_empty() || !options.imported.is_empty() {
        scored = comparer.compare(frames, &mut results, &mut comparison)?;
    }
    let measured = results.into_iter().map(|(index, result)| comparer.record(index, result));
    comparison.records = measured.chain(scored).collect();
    Ok(comparison)
}

/// What was measured of each configuration, by its index in the options.
type Results = BTreeMap<usize, Result<Measured, RenderError>>;

/// A method's first frame.
struct FirstFrame<'a> {
    index: usize,
    renderer: PreparedRenderer<'a>,
    shaded: Vec<u8>,
}

/// What all configurations share on a scene.
struct Comparer<'a> {
    gpu: Option<&'a Gpu>,
    bench: &'a BenchScene,
    options: &'a Options,
    progress: &'a dyn Progress,
    view: View,
    /// Where the adapter draws, if there is one.
    targets: Option<Targets>,
    /// The view's rays.
    rays: Vec<Ray>,
}

impl<'a> Comparer<'a> {
    fn new(
        gpu: Option<&'a Gpu>,
        bench: &'a BenchScene,
        options: &'a Options,
        progress: &'a dyn Progress,
    ) -> anyhow::Result<Self> {
        let (width, height) = options.size;
        for imported in &options.imported {
            let (found_width, found_height) = (imported.image.width, imported.image.height);
            ensure!(
                (found_width, found_height) == options.size,
                "hits {}: needed a picture of {width} × {height}, found {found_width} × \
                 {found_height} (compare with --size {found_width}x{found_height})",
                imported.file.display()
            );
        }
        let view = View::new(bench.camera, width, height)?;
        let colors = bench.scene.colors().is_some();
        let targets = gpu.map(|gpu| Targets::new(gpu, width, height, colors, false)).transpose()?;
        let rays = Canvas::new(gpu, targets.as_ref()).rays(&view)?;
        Ok(Self { gpu, bench, options, progress, view, targets, rays })
    }

    fn canvas(&self) -> Canvas<'_> {
        Canvas::new(self.gpu, self.targets.as_ref())
    }

    /// Each method's first frame: the one to compare. It also warms the method up.
    fn draw(&self, results: &mut Results) -> anyhow::Result<Vec<FirstFrame<'a>>> {
        let mut frames = Vec::new();
        for (index, configuration) in self.options.configurations.iter().enumerate() {
            self.stage(&configuration.to_string());
            let (renderer, scene) = (configuration.renderer(false), &self.bench.scene);
            match PreparedRenderer::prepare(self.canvas(), renderer, scene, &self.view) {
                Ok(renderer) => {
                    let shaded = if configuration.needs_adapter() {
                        self.shade_targets()?
                    } else {
                        self.shade(&renderer.hits)?
                    };
                    frames.push(FirstFrame { index, renderer, shaded });
                }
                Err(error) => {
                    results.insert(index, Err(error));
                }
            }
            self.progress.advance(self.options.sampling.most as u64);
        }
        Ok(frames)
    }

    /// Compares, times and counts all that drew; returns the records of what other programs drew.
    fn compare(
        &self,
        frames: Vec<FirstFrame<'a>>,
        results: &mut Results,
        comparison: &mut SceneComparison,
    ) -> anyhow::Result<Vec<Record>> {
        self.stage("reference");
        let imported = self.options.imported.iter().map(|imported| &imported.image.hits[..]);
        let drawn = frames.iter().map(|frame| &frame.renderer.hits[..]);
        let reference = self.reference(&drawn.chain(imported).collect::<Vec<_>>());
        comparison.reference = Some(self.shade(&reference.hits())?);
        self.progress.advance(1);

        self.stage("timing");
        let (indices, shaded, mut renderers) = unzip(frames);
        let timings = self.time(&mut renderers)?;

        self.stage(if self.options.counts_work { "counting work" } else { "scoring" });
        for (((index, shaded), renderer), timing) in
            indices.into_iter().zip(shaded).zip(renderers).zip(timings)
        {
            let configuration = &self.options.configurations[index];
            let accuracy = score(&reference, &renderer.hits)?;
            let heat = encode_png(&heat_map(&reference, &renderer.hits))?;
            let result = timing.and_then(|timing| {
                let work = if self.options.counts_work { self.count(configuration)? } else { None };
                Ok(measured(&renderer, timing, accuracy, work))
            });
            if result.is_ok() {
                comparison.pictures.push(Pictures {
                    method: configuration.method.name.to_owned(),
                    shaded,
                    heat,
                });
            }
            results.insert(index, result);
            self.progress.advance(1);
        }
        comparison.remarks = remarks(&reference);
        self.score_imported(&reference, comparison)
    }

    /// Scores what other programs drew; their pictures follow those of the methods.
    fn score_imported(
        &self,
        reference: &Reference,
        comparison: &mut SceneComparison,
    ) -> anyhow::Result<Vec<Record>> {
        let mut records = Vec::new();
        for imported in &self.options.imported {
            comparison.pictures.push(Pictures {
                method: imported.name.clone(),
                shaded: self.shade(&imported.image.hits)?,
                heat: encode_png(&heat_map(reference, &imported.image.hits))?,
            });
            let adapter = Adapter::of(self.gpu);
            let view = (&self.bench.name[..], &self.bench.scene);
            records.push(imported.record(view, reference, adapter)?);
        }
        Ok(records)
    }

    /// The truth along the rays that all methods have.
    fn reference(&self, images: &[&[Hit]]) -> Reference {
        let (scene, size) = (&self.bench.scene, self.options.size);
        Reference::of_pictures(scene, &self.rays, size, images, self.options.every_pixel)
    }

    /// The work of a method on the adapter; on the CPU nothing is counted.
    fn count(&self, configuration: &Configuration) -> Result<Option<WorkPerRay>, RenderError> {
        let renderer = configuration.renderer(true).on_adapter();
        let count = |(gpu, renderer)| count_work(gpu, renderer, &self.bench.scene, &self.view);
        self.gpu.zip(renderer).map(count).transpose()
    }

    fn time(
        &self,
        renderers: &mut [PreparedRenderer<'_>],
    ) -> anyhow::Result<Vec<Result<Timing, RenderError>>> {
        let Options { sampling, size, along_path, .. } = *self.options;
        let path = if along_path { &self.bench.path[..] } else { &[] };
        let bounds = self.bench.scene.bounds();
        let views = views(&self.bench.camera, path, &bounds, size, sampling.most)?;
        let advance = || self.progress.advance(1);
        Ok(time_all(self.canvas(), renderers, &views, sampling.enough, advance))
    }

    /// What the adapter has drawn, in the colours that it has blended, as a PNG.
    fn shade_targets(&self) -> anyhow::Result<Vec<u8>> {
        let (gpu, targets) = self.gpu.zip(self.targets.as_ref()).ok_or(RenderError::NoAdapter)?;
        let scene = &self.bench.scene;
        let shaded = Shading::new(gpu).draw(targets, &self.view, scene, Picture::Phong)?;
        Ok(encode_png(&shaded.image)?)
    }

    /// Hits of the view's rays as a PNG.
    fn shade(&self, hits: &[Hit]) -> anyhow::Result<Vec<u8>> {
        let scene = &self.bench.scene;
        let Shaded { image, .. } =
            shade::draw(scene, &self.view, &self.rays, hits, CpuPicture::Phong);
        Ok(encode_png(&image)?)
    }

    fn record(&self, index: usize, result: Result<Measured, RenderError>) -> Record {
        let configuration = &self.options.configurations[index];
        let scene = &self.bench.scene;
        let (width, height) = self.options.size;
        let (status, reason, measured) = match result {
            Ok(measured) => (Status::Ok, None, Some(measured)),
            Err(error @ RenderError::Incomplete { .. }) => {
                (Status::Incomplete, Some(error.to_string()), None)
            }
            Err(error) => (Status::Unsupported, Some(error.to_string()), None),
        };
        Record {
            scene: self.bench.name.clone(),
            balls: scene.len(),
            kernel: scene.kernel().to_string(),
            threshold: scene.threshold(),
            method: configuration.method.name.to_owned(),
            options: configuration.options.clone(),
            width,
            height,
            adapter: configuration.drawn_by(self.gpu),
            status,
            reason,
            measured,
            scored: None,
        }
    }

    fn stage(&self, what: &str) {
        self.progress.stage(format!("{}: {what}", self.bench.name));
    }
}

fn unzip(frames: Vec<FirstFrame<'_>>) -> (Vec<usize>, Vec<Vec<u8>>, Vec<PreparedRenderer<'_>>) {
    frames
        .into_iter()
        .map(|FirstFrame { index, renderer, shaded }| (index, shaded, renderer))
        .collect()
}

fn measured(
    renderer: &PreparedRenderer<'_>,
    timing: Timing,
    accuracy: Accuracy,
    work: Option<WorkPerRay>,
) -> Measured {
    let count =
        |which: fn(&Hit) -> bool| renderer.hits.iter().filter(|hit| which(hit)).count() as u64;
    Measured {
        build_ms: milliseconds(renderer.build.structure),
        upload_bytes: renderer.build.upload_bytes,
        device_bytes: renderer.device_bytes(),
        frame_ms: timing.frame_ms,
        passes: timing.passes,
        fallback_pixels: count(|hit| hit.fallback),
        undecided_pixels: count(|hit| hit.verdict == Verdict::Undecided),
        accuracy,
        work,
    }
}

fn remarks(reference: &Reference) -> Vec<String> {
    let mut remarks = Vec::new();
    let rays = reference.truths().len();
    let ambiguous = reference.truths().iter().filter(|truth| truth.is_ambiguous()).count();
    if many_are_ambiguous(ambiguous, rays) {
        remarks.push(format!(
            "{ambiguous} of {rays} rays are too close to call: more than one in a thousand."
        ));
    }
    if !reference.is_complete() {
        remarks.push(format!(
            "Compared on {rays} of {} pixels: {}. Elsewhere the reference's picture shows the \
             nearest pixel of that lattice.",
            reference.image_pixels(),
            reference.subset()
        ));
    }
    remarks
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use metaball_core::Scene;
    use metaball_core::gpu::{BuildReport, Frame, IsoRenderer};

    use super::*;
    use crate::configuration::sweeps::presets;
    use crate::judge::Stop;
    use crate::judge::promise::Promise;
    use crate::methods::{Method, methods};
    use crate::renderer::Renderer;
    use crate::technique::{Own, Technique};

    /// A method that can do nothing.
    struct Unable;

    impl IsoRenderer for Unable {
        fn name(&self) -> &'static str {
            "unable"
        }

        fn build(&mut self, _: &Gpu, _: &Scene) -> Result<BuildReport, RenderError> {
            Err(RenderError::Unsupported { method: "unable", reason: "needs more".to_owned() })
        }

        fn encode(&mut self, _: &mut Frame<'_>) -> Result<(), RenderError> {
            Err(RenderError::NotBuilt { method: "unable" })
        }
    }

    static UNABLE: Method = Method {
        name: "unable",
        title: "Unable",
        paper: "none",
        about: "Fails.",
        technique: Technique::Own(Own {
            make: |_| Renderer::Adapter(Box::new(Unable)),
            promise: Promise::Always,
            stop: Stop::Rounding,
            refuses: |_| None,
        }),
    };

    #[test]
    fn one_that_fails_leaves_the_others_alone() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let options = Options {
            configurations: vec![(&UNABLE).into(), (&methods()[0]).into()],
            size: (48, 36),
            sampling: Sampling::exactly(2),
            along_path: true,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: true,
        };
        let comparison = compare_scene(Some(&gpu), &bench, &options, &()).expect("compared");
        let [unable, able] = &comparison.records[..] else { panic!("two records") };
        assert_eq!((unable.method.as_str(), unable.status), ("unable", Status::Unsupported));
        assert_eq!(unable.reason.as_deref(), Some("method unable: needs more"));
        assert_eq!((able.method.as_str(), able.status), (methods()[0].name, Status::Ok));
        let measured = able.measured.as_ref().expect("drawn");
        assert_eq!(measured.frame_ms.samples.len(), 2);
        assert_eq!(measured.accuracy.rays, 48 * 36);
        assert!(measured.accuracy.oracle_hits > 0);
        assert!(measured.work.is_some_and(|work| work.balls_per_ray > 0.0));
        assert!(comparison.reference.is_some() && comparison.pictures.len() == 1);
    }

    /// The rays of those on the CPU are the adapter's where there is one, and the view's own where there is
    /// none; what they find is right along either.
    #[test]
    fn those_on_the_cpu_take_part_with_an_adapter_and_without() {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let names = ["fbvh", "fbvh-certified-cpu", "kanamori-cpu"];
        let options = Options {
            configurations: presets(&names),
            size: (48, 36),
            sampling: Sampling::exactly(2),
            along_path: false,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: true,
        };
        let without = compare_scene(None, &bench, &options, &()).expect("compared");
        let refused = &without.records[0];
        assert_eq!((refused.status, refused.adapter.processor), (Status::Unsupported, None));
        assert_eq!(refused.reason.as_deref(), Some("needed a graphics adapter, found none"));
        let with = Gpu::for_test().map(|gpu| {
            let compared = compare_scene(Some(&gpu), &bench, &options, &()).expect("compared");
            assert!(compared.records.iter().all(|record| record.status == Status::Ok));
            assert_eq!(compared.pictures.len(), 3);
            compared
        });
        for compared in [Some(without), with].iter().flatten() {
            assert!(compared.reference.is_some());
            for (record, name) in compared.records[1..].iter().zip(&names[1..]) {
                assert_eq!((record.method.as_str(), record.status), (*name, Status::Ok));
                assert_eq!(record.adapter, Adapter::cpu());
                let measured = record.measured.as_ref().expect("traced");
                assert!(measured.accuracy.oracle_hits > 0 && measured.device_bytes > 0);
                assert_eq!(measured.accuracy.wrong_verdicts(), 0, "{name}");
                assert_eq!(measured.work, None, "nothing is counted on the CPU");
                assert_eq!(measured.passes.keys().collect::<Vec<_>>(), ["cpu:trace"]);
            }
        }
    }

    #[test]
    fn without_any_drawing_there_are_only_reasons() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("empty", &Overrides::default()).expect("known");
        let options = Options {
            configurations: vec![(&UNABLE).into()],
            size: (4, 3),
            sampling: Sampling::exactly(1),
            along_path: false,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: true,
        };
        let comparison = compare_scene(Some(&gpu), &bench, &options, &()).expect("compared");
        assert_eq!(comparison.records.len(), 1);
        assert!(comparison.reference.is_none() && comparison.pictures.is_empty());
    }
}
