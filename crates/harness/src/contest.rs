//! One scene, all methods: pictures, comparison with the reference, times, work.

use std::collections::BTreeMap;

use bench_scenes::{BenchScene, mean_overlap};
use metaball_core::gpu::{Gpu, Picture, RenderError, Shading, Targets};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Verdict, View};

use crate::heat::heat_map;
use crate::measure::{Contender, Sampling, Timing, count_work, milliseconds, time_all, views};
use crate::progress::Progress;
use crate::record::{Adapter, Measured, Record, Status, WorkPerRay};
use crate::reference::Reference;
use crate::score::{Accuracy, is_murky, score};
use crate::settings::Setting;
use picture_files::encode_png;

/// How to hold a contest.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Who takes part.
    pub settings: Vec<Setting>,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// How often each is timed.
    pub sampling: Sampling,
    /// Whether to time along the scene's camera path, where it has one, in place of near its camera.
    pub along_path: bool,
    /// Whether to compare every pixel of a large scene too.
    pub every_pixel: bool,
    /// Whether to count work too, with renderers of its own, whose shaders are compiled anew.
    pub counts_work: bool,
}

/// What a contest yields.
#[derive(Debug, Clone)]
pub struct Contest {
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
    /// Name of the method.
    pub method: &'static str,
    /// PNG of its picture.
    pub shaded: Vec<u8>,
    /// PNG of its difference to the reference.
    pub heat: Vec<u8>,
}

/// Pictures with up to this many pixels are compared whole: on two cores the oracle takes some ten
/// seconds for the densest of the known scenes.
const COMPARED_WHOLE_PIXELS: usize = 640 * 480;

/// Scenes with up to this many balls are compared whole at any size.
const COMPARED_WHOLE_BALLS: usize = 10_000;

/// Scenes in which a ball's centre lies in more supports than this are not: the oracle's time grows with
/// the square of the balls that a ray meets, to minutes.
const COMPARED_WHOLE_OVERLAP: f64 = 100.0;

/// Steps of progress that [`hold`] makes. A setting's first frame, for which shaders are compiled, counts
/// as much as all that are timed, which take about as long.
pub fn steps(rules: &Rules) -> u64 {
    (rules.settings.len() * (2 * rules.sampling.most + 1) + 1) as u64
}

/// Holds the contest. A method that cannot build or draw has a record that says why, and the others
/// go on.
///
/// # Errors
/// When the scene or the size is too much for what all methods share: the targets, or the shading.
pub fn hold(
    gpu: &Gpu,
    bench: &BenchScene,
    rules: &Rules,
    progress: &dyn Progress,
) -> anyhow::Result<Contest> {
    let arena = Arena::new(gpu, bench, rules, progress)?;
    let mut outcomes = Outcomes::new();
    let drawings = arena.draw(&mut outcomes)?;
    let mut contest = Contest {
        scene: bench.name.clone(),
        about: bench.about.clone(),
        records: Vec::new(),
        reference: None,
        pictures: Vec::new(),
        remarks: Vec::new(),
    };
    if !drawings.is_empty() {
        arena.judge(drawings, &mut outcomes, &mut contest)?;
    }
    contest.records =
        outcomes.into_iter().map(|(place, outcome)| arena.record(place, outcome)).collect();
    Ok(contest)
}

/// What became of each setting, by its place in the rules.
type Outcomes = BTreeMap<usize, Result<Measured, RenderError>>;

/// A method's first frame.
struct Drawing {
    place: usize,
    contender: Contender,
    shaded: Vec<u8>,
}

/// What the whole of a contest shares.
struct Arena<'a> {
    gpu: &'a Gpu,
    bench: &'a BenchScene,
    rules: &'a Rules,
    progress: &'a dyn Progress,
    view: View,
    targets: Targets,
}

impl<'a> Arena<'a> {
    fn new(
        gpu: &'a Gpu,
        bench: &'a BenchScene,
        rules: &'a Rules,
        progress: &'a dyn Progress,
    ) -> anyhow::Result<Self> {
        let (width, height) = rules.size;
        let view = View::new(bench.camera, width, height)?;
        let colors = bench.scene.colors().is_some();
        let targets = Targets::new(gpu, width, height, colors, false)?;
        Ok(Self { gpu, bench, rules, progress, view, targets })
    }

    /// Each method's first frame: the one to compare. It also warms the method up.
    fn draw(&self, outcomes: &mut Outcomes) -> anyhow::Result<Vec<Drawing>> {
        let mut drawings = Vec::new();
        for (place, setting) in self.rules.settings.iter().enumerate() {
            self.stage(&setting.to_string());
            let scene = &self.bench.scene;
            match Contender::prepare(
                self.gpu,
                setting.renderer(false),
                scene,
                &self.targets,
                &self.view,
            ) {
                Ok(contender) => {
                    drawings.push(Drawing { place, contender, shaded: self.shade()? });
                }
                Err(error) => {
                    outcomes.insert(place, Err(error));
                }
            }
            self.progress.advance(self.rules.sampling.most as u64);
        }
        Ok(drawings)
    }

    /// Compares, times and counts all that drew.
    fn judge(
        &self,
        drawings: Vec<Drawing>,
        outcomes: &mut Outcomes,
        contest: &mut Contest,
    ) -> anyhow::Result<()> {
        self.stage("reference");
        let images: Vec<_> = drawings.iter().map(|d| d.contender.hits.as_slice()).collect();
        let reference = self.ask_oracle(&images)?;
        // Colours, where there are any, are those of the method that drew last.
        self.targets.write_hits(self.gpu, &reference.hits())?;
        contest.reference = Some(self.shade()?);
        self.progress.advance(1);

        self.stage("timing");
        let (places, shaded, mut contenders) = unzip(drawings);
        let timings = self.time(&mut contenders)?;

        self.stage(if self.rules.counts_work { "counting work" } else { "scoring" });
        for (((place, shaded), contender), timing) in
            places.into_iter().zip(shaded).zip(contenders).zip(timings)
        {
            let setting = &self.rules.settings[place];
            let accuracy = score(&reference, &contender.hits)?;
            let heat = encode_png(&heat_map(&reference, &contender.hits))?;
            let outcome = timing.and_then(|timing| {
                let count =
                    || count_work(self.gpu, setting.renderer(true), &self.bench.scene, &self.view);
                let work = self.rules.counts_work.then(count).transpose()?;
                Ok(measured(&contender, timing, accuracy, work))
            });
            if outcome.is_ok() {
                contest.pictures.push(Pictures { method: setting.method.name, shaded, heat });
            }
            outcomes.insert(place, outcome);
            self.progress.advance(1);
        }
        contest.remarks = remarks(&reference);
        Ok(())
    }

    /// The truth along the rays that the shaders used, read back.
    fn ask_oracle(&self, images: &[&[Hit]]) -> anyhow::Result<Reference> {
        let scene = &self.bench.scene;
        let size = self.rules.size;
        let rays = self.targets.read_rays(self.gpu, &self.view)?;
        let oracle = Oracle::new(scene);
        let is_small =
            || rays.len() <= COMPARED_WHOLE_PIXELS || scene.len() <= COMPARED_WHOLE_BALLS;
        let is_sparse = || mean_overlap(scene) <= COMPARED_WHOLE_OVERLAP;
        if self.rules.every_pixel || (is_small() && is_sparse()) {
            return Ok(Reference::of_every_pixel(size, oracle.first_hits(&rays)));
        }
        let radius = scene.supports().iter().map(|ball| ball.radius).fold(f32::INFINITY, f32::min);
        Ok(Reference::of_telling_pixels(&oracle, &rays, size, images, radius))
    }

    fn time(
        &self,
        contenders: &mut [Contender],
    ) -> anyhow::Result<Vec<Result<Timing, RenderError>>> {
        let Rules { sampling, size, along_path, .. } = *self.rules;
        let path = if along_path { &self.bench.path[..] } else { &[] };
        let bounds = self.bench.scene.bounds();
        let views = views(&self.bench.camera, path, &bounds, size, sampling.most)?;
        let advance = || self.progress.advance(1);
        Ok(time_all(self.gpu, contenders, &self.targets, &views, sampling.enough, advance))
    }

    /// What the targets hold, as a PNG.
    fn shade(&self) -> anyhow::Result<Vec<u8>> {
        let shading = Shading::new(self.gpu);
        let scene = &self.bench.scene;
        let shaded = shading.draw(&self.targets, &self.view, scene, Picture::Phong)?;
        Ok(encode_png(&shaded.image)?)
    }

    fn record(&self, place: usize, outcome: Result<Measured, RenderError>) -> Record {
        let setting = &self.rules.settings[place];
        let scene = &self.bench.scene;
        let (width, height) = self.rules.size;
        let (status, reason, measured) = match outcome {
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
            method: setting.method.name.to_owned(),
            options: setting.options.clone(),
            width,
            height,
            adapter: Adapter::from(self.gpu.report()),
            status,
            reason,
            measured,
        }
    }

    fn stage(&self, what: &str) {
        self.progress.stage(format!("{}: {what}", self.bench.name));
    }
}

fn unzip(drawings: Vec<Drawing>) -> (Vec<usize>, Vec<Vec<u8>>, Vec<Contender>) {
    drawings
        .into_iter()
        .map(|Drawing { place, contender, shaded }| (place, shaded, contender))
        .collect()
}

fn measured(
    contender: &Contender,
    timing: Timing,
    accuracy: Accuracy,
    work: Option<WorkPerRay>,
) -> Measured {
    let count =
        |which: fn(&Hit) -> bool| contender.hits.iter().filter(|hit| which(hit)).count() as u64;
    Measured {
        build_ms: milliseconds(contender.build.structure),
        upload_bytes: contender.build.upload_bytes,
        device_bytes: contender.device_bytes(),
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
    if is_murky(ambiguous, rays) {
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
    use crate::judge::Stop;
    use crate::judge::promise::Promise;
    use crate::methods::{Method, methods};
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
            make: |_| Box::new(Unable),
            promise: Promise::Always,
            stop: Stop::ROUNDING,
            refuses: |_| None,
        }),
    };

    #[test]
    fn one_that_fails_leaves_the_others_alone() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let rules = Rules {
            settings: vec![(&UNABLE).into(), (&methods()[0]).into()],
            size: (48, 36),
            sampling: Sampling::exactly(2),
            along_path: true,
            every_pixel: false,
            counts_work: true,
        };
        let contest = hold(&gpu, &bench, &rules, &()).expect("held");
        let [unable, able] = &contest.records[..] else { panic!("two records") };
        assert_eq!((unable.method.as_str(), unable.status), ("unable", Status::Unsupported));
        assert_eq!(unable.reason.as_deref(), Some("method unable: needs more"));
        assert_eq!((able.method.as_str(), able.status), (methods()[0].name, Status::Ok));
        let measured = able.measured.as_ref().expect("drawn");
        assert_eq!(measured.frame_ms.samples.len(), 2);
        assert_eq!(measured.accuracy.rays, 48 * 36);
        assert!(measured.accuracy.oracle_hits > 0);
        assert!(measured.work.is_some_and(|work| work.balls_per_ray > 0.0));
        assert!(contest.reference.is_some() && contest.pictures.len() == 1);
    }

    #[test]
    fn without_any_drawing_there_are_only_reasons() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("empty", &Overrides::default()).expect("known");
        let rules = Rules {
            settings: vec![(&UNABLE).into()],
            size: (4, 3),
            sampling: Sampling::exactly(1),
            along_path: false,
            every_pixel: false,
            counts_work: true,
        };
        let contest = hold(&gpu, &bench, &rules, &()).expect("held");
        assert_eq!(contest.records.len(), 1);
        assert!(contest.reference.is_none() && contest.pictures.is_empty());
    }
}
