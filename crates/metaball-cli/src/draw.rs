//! The commands that draw: `render` and `animate`.

use std::ops::{ControlFlow, Range};
use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context, ensure};
use bench_scenes::{Moving, inputs, load_as};
use clap::Args;
use experiments::console::{self, ProgressBar};
use harness::auto::MAX_ERROR;
use harness::auto::cache::Cache;
use harness::methods::find;
use harness::numbers::{decimal, grouped};
use metaball::{
    AnimateOptions, AnimatedScene, AnimationEvent, AnimationReport, Backend, Choosing, DrawOptions,
    Emptiness, Error, FrameOutcome, FrameReport, Keep, Method, NumberedPath, Outputs, Overrides,
    Progress, ReadOptions, Stage, Summary, Tally, animate, draw_to_files,
};
use metaball_core::{Color, Picture, Scene};

use crate::camera::{self, CameraArgs};
use crate::clip::ClipArgs;
use crate::ending::Trouble;
use crate::light::LightArgs;
use crate::names::{AUTO, DEFAULT_METHOD, drawer_parser};
use crate::picture::{color_of, picture_named};
use crate::reading::ReadingArgs;
use crate::says::{Says, line, say_notes, speaker};
use crate::shared::PictureArgs;
use crate::values;

/// What to draw, and how.
#[derive(Debug, Args)]
pub(crate) struct DrawingArgs {
    /// A known name, a generator such as scattered:50000, or a file; for animate one that moves, such
    /// as tornado:4000 or particles-%04d.xyz.
    scene: String,
    /// The method; fbvh-certified when left out. For render, auto chooses: see --max-error.
    #[arg(long, value_name = "NAME", value_parser = drawer_parser())]
    method: Option<String>,
    /// What the picture shows: phong, normal, depth, color, spheres, or work:COUNTER.
    #[arg(long, value_name = "WHAT", default_value = "phong", value_parser = picture_named)]
    picture: Picture,
    /// Trace on the CPU: what happens anyway where there is no graphics processor.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// One colour for all balls, sRGB, 0 to 1; the scene's own, or white, when left out.
    #[arg(long, value_name = "R,G,B", value_parser = color_of, conflicts_with = "color_by")]
    color: Option<Color>,
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    light: LightArgs,
    #[command(flatten)]
    shared: PictureArgs,
}

/// A scene by its words, and how to draw it.
struct Request {
    scene: String,
    reading: ReadOptions,
    overrides: Overrides,
    options: DrawOptions,
}

impl DrawingArgs {
    /// With `auto` where it chooses; else with the method named, or the default.
    fn request(self, auto: Option<Choosing>) -> anyhow::Result<Request> {
        let Self { scene, method, picture, cpu, color, reading, camera, clip, light, shared } =
            self;
        let method = match auto {
            Some(choosing) => Method::Auto(choosing),
            None => {
                let name = method.as_deref().unwrap_or(DEFAULT_METHOD);
                let listed = find(name).with_context(|| format!("no method is called {name}"))?;
                Method::Listed(listed.into())
            }
        };
        let backend = match shared.adapter.asked() {
            _ if cpu => Backend::Cpu,
            Some(choice) => Backend::Adapter(choice),
            None => Backend::Fastest,
        };
        let options = DrawOptions {
            method,
            size: shared.size,
            viewpoint: camera.viewpoint(),
            picture,
            clip: clip.clip()?,
            light: light.options(),
            backend,
        };
        let (reading, overrides) = (reading.options(), Overrides { color, ..shared.overrides() });
        Ok(Request { scene, reading, overrides, options })
    }
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// Draw with the quickest method and options whose error on this scene is at most so many mean
    /// support radii for 99 of 100 hits, with no wrong verdict [default of auto: 1e-3].
    #[arg(long, value_name = "E", value_parser = values::max_error)]
    max_error: Option<f64>,
    /// With auto, neither look for a choice made earlier nor keep the one made now.
    #[arg(long)]
    ignore_cache: bool,
    /// Where the picture goes: .png, or .jpg or .jpeg of quality 95 and at most 65,535 pixels a side.
    #[arg(long, value_name = "FILE", default_value = "out/image.png")]
    out: PathBuf,
    /// Write distances and normals too: as f32 channels (Z, N.X, N.Y, N.Z) of an OpenEXR file (.exr), or as
    /// a NumPy array (.npy).
    #[arg(long, value_name = "FILE")]
    hits: Option<PathBuf>,
    /// Write the picture's linear light as an OpenEXR file (.exr) too.
    #[arg(long, value_name = "FILE", requires = "LightArgs")]
    light_out: Option<PathBuf>,
    /// Go on with a picture that the CPU began and that was interrupted. What is finished is in a file
    /// beside the picture, named like it with .spool behind; without this it is in the way of drawing the
    /// same picture anew.
    #[arg(long)]
    resume: bool,
}

impl RenderArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let auto = self.choosing()?;
        let Self { drawing, out, hits, light_out, resume, .. } = self;
        let Request { scene, reading, overrides, mut options } = drawing.request(auto)?;
        if matches!(options.method, Method::Auto(_)) {
            ensure!(
                options.backend != Backend::Cpu,
                "auto needs a graphics adapter to measure methods on; for the CPU name a method"
            );
            console::note("auto: drawing with every candidate, and asking the oracle");
        }
        let bench = console::while_working(&format!("reading {scene}"), || {
            load_as(&scene, &reading, &overrides)
        })?;
        let file = bench.file.as_ref();
        if let (Some(cell), true) = (file.and_then(|file| file.cell), reading.periodic) {
            options.clip = options.clip.and(&cell.region()?);
        }
        let inputs = inputs(&scene).into_iter().chain(reading.topology.clone()).collect();
        let mut outputs = Outputs { hits, light: light_out, resume, inputs, ..Outputs::image(out) };
        let legend = file.and_then(|file| file.legend.as_ref());
        if let Some(legend) = legend {
            outputs = outputs.with_legend(legend)?;
        }
        let mut bars = Bars::default();
        let summary = draw_to_files(&bench.scene, &bench.camera, &options, &outputs, |progress| {
            bars.show(progress);
            ControlFlow::Continue(())
        });
        drop(bars);
        let files = [("picture", Some(&outputs.image)), ("hits file", outputs.hits.as_ref())];
        let files = files.into_iter().chain([("light file", outputs.light.as_ref())]);
        let files: Vec<_> = files.filter_map(|(name, path)| Some((name, path?))).collect();
        let says = speaker(files.iter().map(|(_, path)| path.as_path()));
        let summary = summary.map_err(by_flag)?;
        line(says, "scene", &bench.name);
        file.into_iter().for_each(|file| say_notes(says, &file.notes));
        report(says, &bench.scene, &summary);
        for (name, path) in files {
            line(says, name, &path.display().to_string());
        }
        match (legend, &outputs.legend) {
            (_, Some((_, path))) => line(says, "legend", &path.display().to_string()),
            (Some(_), None) => {
                line(says, "legend", "none: the picture is no file to put it beside");
            }
            (None, None) => {}
        }
        Ok(())
    }

    #[cfg(test)]
    pub(crate) fn clip(&self) -> Result<metaball::Clip, metaball::ClipError> {
        self.drawing.clip.clip()
    }

    #[cfg(test)]
    pub(crate) fn light(self) -> metaball::LightOptions {
        self.drawing.light.options()
    }

    /// Whether `auto` chooses the method; only then may an error be given.
    fn choosing(&self) -> anyhow::Result<Option<Choosing>> {
        let (name, max_error) = (self.drawing.method.as_deref(), self.max_error);
        if name == Some(AUTO) || (name.is_none() && max_error.is_some()) {
            let cache = if self.ignore_cache { Cache::none() } else { Cache::of_user() };
            return Ok(Some(Choosing { max_error: max_error.unwrap_or(MAX_ERROR), cache }));
        }
        let name = name.unwrap_or(DEFAULT_METHOD);
        ensure!(max_error.is_none(), "--max-error: needed --method auto, found --method {name}");
        ensure!(!self.ignore_cache, "--ignore-cache: needed --method auto, found --method {name}");
        Ok(None)
    }
}

#[derive(Debug, Args)]
pub(crate) struct AnimateArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// Frames, the last one not included; all that there are, or the first seconds of what never ends.
    /// One that is not there is an error at the end, when the others are drawn.
    #[arg(long, value_name = "A..B", value_parser = values::frame_range)]
    frames: Option<Range<u32>>,
    /// Draw every Nth of them.
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Where the pictures go, .png, .jpg or .jpeg: %d stands for the frame's number, %04d for four digits
    /// or more.
    #[arg(long, value_name = "FILE", default_value = "out/frame-%04d.png")]
    out: NumberedPath,
    /// Write a picture of all these frames side by side too: .png, .jpg or .jpeg.
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
    /// Leave every frame that is there, a whole picture of this size, whatever it was drawn with. Without
    /// this, frames that were not drawn with these options, by this version, on the same kind of device are
    /// drawn anew.
    #[arg(long, conflicts_with = "force")]
    skip_existing: bool,
    /// Draw all frames, those that are there too.
    #[arg(long)]
    force: bool,
    /// Build for a frame only after the one before has been drawn, not meanwhile.
    #[arg(long)]
    in_turn: bool,
}

impl AnimateArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let keep = self.keep();
        let Self { drawing, frames, every, out, sheet, in_turn, .. } = self;
        ensure!(
            drawing.method.as_deref() != Some(AUTO),
            "auto chooses for one picture: for frames name a method"
        );
        let Request { scene, reading, overrides, options: mut draw } = drawing.request(None)?;
        let moving = console::while_working(&format!("reading {scene}"), || {
            Moving::load_as(&scene, &reading, &overrides)
        })?;
        if let (Some(cell), true) = (moving.cell(), reading.periodic) {
            draw.clip = draw.clip.and(&cell.region()?);
        }
        let inputs = inputs(&scene).into_iter().chain(reading.topology.clone()).collect();
        let options = AnimateOptions { draw, frames, every, out, sheet, keep, in_turn, inputs };
        let mut progress = None;
        let (report, path) = animate(&moving, &options, |event| match event {
            AnimationEvent::Begins { missing, kept, absent } => {
                if absent > 0 {
                    console::note(&format!("{scene} has no frame for {absent} numbers"));
                }
                if kept > 0 {
                    let all = kept + missing;
                    console::note(&format!("{kept} of {all} frames are there already"));
                }
                progress = Some(ProgressBar::new(missing as u64));
            }
            AnimationEvent::Done(frame) => {
                if let Some(progress) = &progress {
                    let (done, all) = progress.step();
                    let FrameReport { number, outcome } = frame;
                    let outcome = outcome_text(outcome);
                    progress.stage(format!("{done} of {all}: frame {number} {outcome}"));
                }
            }
            _ => {}
        })
        .map_err(by_flag)?;
        drop(progress);
        let says = speaker(options.sheet.iter().map(PathBuf::as_path));
        line(says, "scene", &report.scene);
        moving.notes().into_iter().for_each(|notes| say_notes(says, notes));
        report_animation(says, &report);
        line(says, "report", &path.display().to_string());
        let broken: Vec<_> = report.broken().collect();
        for (number, error) in &broken {
            console::note(&format!("frame {number}: {error}"));
        }
        let mut faults = Vec::new();
        if !broken.is_empty() {
            let all = report.frames.len() + report.kept.len();
            faults.push(format!("{} of {all} frames could not be drawn", broken.len()));
        }
        if let (Some(Range { start, end }), false) = (options.frames, report.absent.is_empty()) {
            let absent = rows_text(&report.absent);
            faults.push(format!(
                "--frames {start}..{end}: needed frames that are there, found none for {absent}"
            ));
        }
        let faults = faults.join("; ");
        if report.is_trouble() {
            return Err(Trouble(faults).into());
        }
        ensure!(faults.is_empty(), "{faults}");
        Ok(())
    }

    fn keep(&self) -> Keep {
        match (self.force, self.skip_existing) {
            (true, _) => Keep::Nothing,
            (false, true) => Keep::Complete,
            (false, false) => Keep::Same,
        }
    }
}

/// The error, with an option as it is written on the command line.
fn by_flag(error: Error) -> anyhow::Error {
    match error {
        Error::Option { option, needed, found } => {
            anyhow::anyhow!("--{}: needed {needed}, found {found}", option.replace('_', "-"))
        }
        Error::Camera(error) => camera::by_flag(error),
        error => error.into(),
    }
}

/// How far a picture is, on a terminal.
#[derive(Default)]
struct Bars(Option<(Stage, ProgressBar)>);

impl Bars {
    fn show(&mut self, progress: Progress) {
        let Progress { stage, done, of, resumed, .. } = progress;
        if self.0.as_ref().is_none_or(|(shown, _)| *shown != stage) {
            self.0 = Some((stage, ProgressBar::new(of.into())));
        }
        let Some((_, bar)) = &self.0 else { return };
        if done == resumed {
            bar.skip(done.into());
        } else {
            bar.reach(done.into());
        }
        bar.show_left(match stage {
            Stage::Drawing => "drawing",
            Stage::Writing => "writing",
        });
    }
}

fn report(says: Says, scene: &Scene, summary: &Summary) {
    let Summary { tally, range, samples, account, computed_by, build, .. } = summary;
    let time = |time: &Duration| ms(1e3 * time.as_secs_f64());
    line(says, "balls", &format!("{} of kernel {}", grouped(scene.len()), scene.kernel()));
    line(says, "threshold", &scene.threshold().to_string());
    for (name, value) in account {
        line(says, name, value);
    }
    line(says, "drawn by", computed_by);
    line(says, "build", &time(build));
    line(says, "frame", &time(&tally.frame));
    line(says, "rays", &ray_facts(tally));
    if tally.hits + tally.inside + tally.undecided == 0 {
        line(says, "empty", &Emptiness::of(scene).to_string());
    }
    if let Some(samples) = samples {
        line(says, "light", &light_facts(tally, *samples));
    }
    if let Some(range) = range {
        line(says, "scale", &format!("{} to {}", range.low, range.high));
    }
}

fn ray_facts(tally: &Tally) -> String {
    let counts = [tally.pixels(), tally.hits, tally.misses, tally.inside, tally.undecided];
    let [all, hits, misses, inside, undecided] = counts.map(|rays| grouped(rays as usize));
    let again = match tally.asked_again {
        0 => String::new(),
        rays => format!("; {} asked again in f64", grouped(rays as usize)),
    };
    format!("{all}: {hits} hits, {misses} misses, {inside} inside, {undecided} undecided{again}")
}

fn light_facts(tally: &Tally, samples: u32) -> String {
    let each = decimal(1e3 * tally.light.as_secs_f64() / f64::from(samples));
    format!(
        "{samples} samples of {each} ms, {} rays undecided",
        grouped(tally.undecided_light as usize)
    )
}

fn outcome_text(outcome: &FrameOutcome) -> String {
    match outcome {
        FrameOutcome::Drawn { times, .. } => {
            let [build, draw] = [times.build_ms, times.draw_ms].map(decimal);
            format!("built in {build} ms, drawn in {draw} ms")
        }
        FrameOutcome::Broken { .. } => "not drawn".to_owned(),
    }
}

/// How many frames were drawn, and what became of the others.
fn frames_text(report: &AnimationReport) -> String {
    let mut text = format!("{} frames in {}", report.drawn, ms(report.wall_ms));
    let others = [
        (report.kept.len(), "were there already"),
        (report.broken().count(), "could not be drawn"),
    ];
    for (count, what) in others.into_iter().filter(|(count, _)| *count > 0) {
        text += &format!("; {count} {what}");
    }
    if !report.absent.is_empty() {
        text += &format!("; none for {}", rows_text(&report.absent));
    }
    text
}

/// Rows of numbers, by the first and the last of each.
fn rows_text(rows: &[[u32; 2]]) -> String {
    let text = |[first, last]: &[u32; 2]| match first == last {
        true => first.to_string(),
        false => format!("{first} to {last}"),
    };
    rows.iter().map(text).collect::<Vec<_>>().join(", ")
}

fn report_animation(says: Says, report: &AnimationReport) {
    line(says, "method", &report.method);
    line(says, "drawn by", &report.computed_by);
    line(says, "drawn", &frames_text(report));
    if report.asked_again > 0 {
        line(says, "rays", &format!("{} asked again in f64", grouped(report.asked_again as usize)));
    }
    if let Some(median) = &report.median {
        line(says, "load", &ms(median.load_ms));
        line(says, "build", &ms(median.build_ms));
        line(says, "draw", &ms(median.draw_ms));
        line(says, "shade", &ms(median.shade_ms));
    }
    if let Some(hidden) = report.hidden {
        line(
            says,
            "hidden",
            &format!("{:.0} % of loading and building, behind drawing", 100.0 * hidden),
        );
    }
    if let Some(caveat) = &report.caveat {
        line(says, "but", caveat);
    }
}

fn ms(milliseconds: f64) -> String {
    format!("{} ms", decimal(milliseconds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, parse};

    #[test]
    fn an_error_asks_for_auto() {
        let chosen = |line: &str| {
            let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
            render.choosing()
        };
        let error = |line| chosen(line).expect("consistent").map(|choosing| choosing.max_error);
        assert_eq!(error("metaball render molecule"), None);
        assert_eq!(error("metaball render molecule --method illes"), None);
        assert_eq!(error("metaball render molecule --method auto"), Some(MAX_ERROR));
        assert_eq!(error("metaball render molecule --max-error 0.05"), Some(0.05));
        let line = "metaball render molecule --method illes --max-error 0.05";
        assert!(chosen(line).expect_err("a contradiction").to_string().contains("auto"));
        assert!(parse("metaball render molecule --max-error 0").is_err());
        assert!(parse("metaball render molecule --max-error NaN").is_err());
    }
}
