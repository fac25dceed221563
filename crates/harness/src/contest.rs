//! One scene, all methods: pictures, comparison with the reference, times, work.

use std::collections::BTreeMap;

use bench_scenes::BenchScene;
use metaball_core::gpu::{Gpu, Picture, RenderError, Shading, Targets};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Verdict, View};

use crate::console::Progress;
use crate::heat::heat_map;
use crate::measure::{Contender, Timing, count_work, milliseconds, time_all, views};
use crate::methods::Method;
use crate::picture::encode_png;
use crate::record::{Adapter, Measured, Record, Status, WorkPerRay};
use crate::reference::Reference;
use crate::score::{Accuracy, score};

/// How to hold a contest.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Who takes part.
    pub methods: Vec<&'static Method>,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Timed frames of each method.
    pub frames: usize,
    /// Whether to time along the scene's camera path, where it has one, in place of near its camera.
    pub along_path: bool,
    /// Whether to compare every pixel of a large scene too.
    pub every_pixel: bool,
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

/// Steps of progress that [`hold`] makes.
pub fn steps(rules: &Rules) -> u64 {
    (rules.methods.len() * (rules.frames + 2) + 1) as u64
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
    progress: &Progress,
) -> anyhow::Result<Contest> {
    let scene = &bench.scene;
    let (width, height) = rules.size;
    let view = View::new(bench.camera, width, height)?;
    let targets = Targets::new(gpu, width, height, scene.colors().is_some(), false)?;
    let shade = || -> anyhow::Result<Vec<u8>> {
        let shaded = Shading::new(gpu).draw(&targets, &view, scene, Picture::Phong)?;
        encode_png(&shaded.image)
    };
    let stage = |what: &str| progress.stage(format!("{}: {what}", bench.name));

    // Each method's first frame is the one to compare, and warms it up. In a scene with colours the
    // reference's picture takes them from the last method that drew.
    let mut contenders = Vec::new();
    let mut shaded = Vec::new();
    let mut failures = BTreeMap::new();
    for &method in &rules.methods {
        stage(method.name);
        match Contender::prepare(gpu, method, scene, &targets, &view) {
            Ok(contender) => {
                shaded.push(shade()?);
                contenders.push(contender);
            }
            Err(error) => {
                failures.insert(method.name, error);
            }
        }
        progress.advance(1);
    }

    stage("reference");
    let answers = ask_oracle(gpu, bench, rules, &targets, &view, &contenders)?;
    let reference = match &answers {
        Some(answers) => {
            targets.write_hits(gpu, &answers.hits())?;
            Some(shade()?)
        }
        None => None,
    };
    progress.advance(1);

    stage("timing");
    let path = if rules.along_path { &bench.path[..] } else { &[] };
    let views = views(&bench.camera, path, &scene.bounds(), rules.size, rules.frames)?;
    let timings = time_all(gpu, &mut contenders, &targets, &views, || progress.advance(1));

    stage("counting work");
    let mut results = BTreeMap::new();
    let mut pictures = Vec::new();
    if let Some(answers) = &answers {
        for ((contender, timing), shaded) in contenders.into_iter().zip(timings).zip(shaded) {
            let method = contender.method;
            let accuracy = score(answers, &contender.hits)?;
            let heat = encode_png(&heat_map(answers, &contender.hits))?;
            let measured = timing.and_then(|timing| {
                let work = count_work(gpu, method, scene, &view)?;
                Ok(measured(&contender, timing, accuracy, work))
            });
            match measured {
                Ok(measured) => {
                    pictures.push(Pictures { method: method.name, shaded, heat });
                    results.insert(method.name, measured);
                }
                Err(error) => {
                    failures.insert(method.name, error);
                }
            }
            progress.advance(1);
        }
    }

    let adapter = Adapter::from(gpu.report());
    let record = |method: &&'static Method| {
        let measured = results.remove(method.name);
        let failure = failures.remove(method.name);
        Record {
            scene: bench.name.clone(),
            balls: scene.len(),
            kernel: scene.kernel().to_string(),
            threshold: scene.threshold(),
            method: method.name.to_owned(),
            options: BTreeMap::new(),
            width,
            height,
            adapter: adapter.clone(),
            status: failure.as_ref().map_or(Status::Ok, status_of),
            reason: failure.map(|error| error.to_string()),
            measured,
        }
    };
    let records: Vec<_> = rules.methods.iter().map(record).collect();
    Ok(Contest {
        scene: bench.name.clone(),
        about: bench.about.clone(),
        remarks: remarks(&records, answers.as_ref()),
        records,
        reference,
        pictures,
    })
}

/// The truth along the rays that the shaders used, read back. `None` when nobody drew.
fn ask_oracle(
    gpu: &Gpu,
    bench: &BenchScene,
    rules: &Rules,
    targets: &Targets,
    view: &View,
    contenders: &[Contender],
) -> anyhow::Result<Option<Reference>> {
    if contenders.is_empty() {
        return Ok(None);
    }
    let scene = &bench.scene;
    let (width, height) = rules.size;
    let rays = targets.read_rays(gpu, view)?;
    let oracle = Oracle::new(scene);
    let whole = rules.every_pixel
        || scene.len() <= COMPARED_WHOLE_BALLS
        || rays.len() <= COMPARED_WHOLE_PIXELS;
    if whole {
        let truths = oracle.first_hits(&rays);
        return Ok(Some(Reference::of_every_pixel(width, height, truths)));
    }
    let images: Vec<&[Hit]> =
        contenders.iter().map(|contender| contender.hits.as_slice()).collect();
    let radius = scene.supports().iter().map(|ball| ball.radius).fold(f32::INFINITY, f32::min);
    Ok(Some(Reference::of_telling_pixels(&oracle, &rays, rules.size, &images, radius)))
}

fn measured(
    contender: &Contender,
    timing: Timing,
    accuracy: Accuracy,
    work: WorkPerRay,
) -> Measured {
    let count =
        |which: fn(&Hit) -> bool| contender.hits.iter().filter(|hit| which(hit)).count() as u64;
    Measured {
        build_ms: milliseconds(contender.build.structure + contender.build.pipelines),
        upload_bytes: contender.build.upload_bytes,
        device_bytes: contender.build.device_bytes,
        frame_ms: timing.frame_ms,
        passes: timing.passes,
        fallback_pixels: count(|hit| hit.fallback),
        undecided_pixels: count(|hit| hit.verdict == Verdict::Undecided),
        accuracy,
        work,
    }
}

/// Why a method has no result.
fn status_of(error: &RenderError) -> Status {
    match error {
        RenderError::Incomplete { .. } => Status::Incomplete,
        _ => Status::Unsupported,
    }
}

fn remarks(records: &[Record], answers: Option<&Reference>) -> Vec<String> {
    let mut remarks = Vec::new();
    let accuracy = records.iter().find_map(|record| Some(&record.measured.as_ref()?.accuracy));
    if let Some(accuracy) = accuracy.filter(|accuracy| accuracy.is_murky()) {
        remarks.push(format!(
            "{} of {} rays are too close to call: more than one in a thousand.",
            accuracy.ambiguous, accuracy.rays
        ));
    }
    if let Some(answers) = answers.filter(|answers| !answers.is_complete()) {
        remarks.push(format!(
            "Compared on {} of {} pixels: {}. Elsewhere the reference picture shows the nearest \
             compared pixel.",
            answers.truths().len(),
            answers.image_pixels(),
            answers.subset()
        ));
    }
    remarks
}
