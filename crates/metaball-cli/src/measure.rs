//! The commands that measure and judge: `compare`, `score`, `diff`, `chart`, `stability` and
//! `certify`.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::ensure;
use bench_scenes::{Case, load_as};
use clap::Args;
use experiments::certify::{self, certify};
use experiments::chart::plan::Purpose;
use experiments::chart::{self, chart};
use experiments::compare::{self, DEFAULT_SCENES, compare};
use experiments::console;
use experiments::diff::diff;
use experiments::score::score;
use experiments::stability::{self, stability};
use glam::{DVec3, Vec3};
use harness::comparison;
use harness::configuration::Configuration;
use harness::imported::ImportedHits;
use harness::measure::Sampling;
use harness::methods::{HEADLINERS, Method, methods};
use metaball_core::Camera;

use crate::camera::{CameraArgs, by_flag};
use crate::names::{case_parser, configuration_parser, method_parser};
use crate::reading::ReadingArgs;
use crate::says::say_notes;
use crate::shared::{AdapterArgs, FieldArgs, PictureArgs, extent};
use crate::values;

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Known names, generators such as scattered:50000, or scene and particle files.
    #[arg(value_name = "SCENE", default_values = DEFAULT_SCENES)]
    scenes: Vec<String>,
    /// Methods, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = method_parser())]
    #[arg(default_values = HEADLINERS)]
    methods: Vec<&'static Method>,
    /// All methods and their variants.
    #[arg(long)]
    every_method: bool,
    /// Only methods that need no graphics adapter: what happens anyway where there is none.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// Timed frames of each method on each scene; when left out five, or what fits in four seconds.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    frames: Option<u16>,
    /// Time along the scene's camera path, where it has one.
    #[arg(long)]
    path: bool,
    /// Compare every pixel, of large scenes too.
    #[arg(long)]
    every_pixel: bool,
    /// Hits of another program, .exr or .npy, to compare too; may be repeated, for one scene. The format
    /// is that of docs/hits-format.md.
    #[arg(long, value_name = "NAME=FILE", value_parser = values::named_file)]
    hits: Vec<(String, PathBuf)>,
    /// Folder for index.html, records.json and records.csv.
    #[arg(long, value_name = "DIR", default_value = "out/compare")]
    out: PathBuf,
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    shared: PictureArgs,
}

impl CompareArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        ensure!(
            self.hits.is_empty() || self.scenes.len() == 1,
            "--hits: needed one scene that they are of, found {}",
            self.scenes.join(", ")
        );
        let imported = self.hits.iter().map(|(name, file)| ImportedHits::read(name, file));
        let imported = imported.collect::<Result<_, _>>()?;
        let chosen = if self.every_method { methods().iter().collect() } else { self.methods };
        let comparison = comparison::Options {
            configurations: chosen.into_iter().map(Configuration::preset).collect(),
            size: self.shared.size,
            sampling: self.frames.map_or(Sampling::QUICK, |n| Sampling::exactly(n.into())),
            along_path: self.path,
            every_pixel: self.every_pixel,
            imported,
            counts_work: true,
        };
        let overrides = self.shared.overrides();
        let adapter = (!self.cpu).then(|| self.shared.adapter.choice());
        compare(&compare::Options {
            scenes: self.scenes,
            reading: self.reading.options(),
            overrides,
            comparison,
            adapter,
            out: self.out,
        })
    }
}

#[derive(Debug, Args)]
pub(crate) struct ScoreArgs {
    /// A known name, a generator such as scattered:50000, or a file.
    scene: String,
    /// The hits: .exr or .npy, one for each pixel, as docs/hits-format.md says.
    #[arg(required_unless_present = "camera")]
    hits: Option<PathBuf>,
    /// What the program that found them is called.
    #[arg(long, value_name = "NAME", default_value = "other")]
    name: String,
    /// Print the scene's camera, for another program to use, instead of a score.
    #[arg(long)]
    camera: bool,
    /// Compare every pixel, of large scenes too.
    #[arg(long)]
    every_pixel: bool,
    #[command(flatten)]
    viewpoint: CameraArgs,
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    field: FieldArgs,
}

impl ScoreArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { scene, hits, name, camera, every_pixel, viewpoint, reading, field } = self;
        // What is wrong with the hits is said before a large scene is loaded.
        let imported = hits.map(|file| ImportedHits::read(&name, &file)).transpose()?;
        let mut bench = load_as(&scene, &reading.options(), &field.overrides())?;
        bench.file.iter().for_each(|file| say_notes(console::note, &file.notes));
        bench.camera =
            viewpoint.viewpoint().camera(&bench.camera, &bench.scene).map_err(by_flag)?;
        if camera {
            console::line(&camera_text(&bench.camera, bench.scene.origin()));
        }
        imported.map_or(Ok(()), |imported| score(&bench, &imported, every_pixel))
    }
}

/// As a scene file says it, in the coordinates of the scene's file, and the axes that rays are made of.
fn camera_text(camera: &Camera, origin: DVec3) -> String {
    let vector = |of: Vec3| format!("[{}, {}, {}]", of.x, of.y, of.z);
    let point = |of: Vec3| {
        let in_file = origin + of.as_dvec3();
        match origin == DVec3::ZERO {
            true => vector(of),
            false => format!("[{}, {}, {}]", in_file.x, in_file.y, in_file.z),
        }
    };
    let fov = 2.0 * f64::from(camera.half_height()).atan().to_degrees();
    format!(
        "[camera]\neye = {}\nlook_at = {}\nup = {}\nvertical_fov_degrees = {fov}\n# unit axes\n\
         # right = {}\n# up = {}\n# forward = {}",
        point(camera.eye()),
        point(camera.eye() + camera.forward()),
        vector(camera.up()),
        vector(camera.right()),
        vector(camera.up()),
        vector(camera.forward())
    )
}

#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// Records of compare or chart, the earlier ones.
    before: PathBuf,
    /// The later ones.
    after: PathBuf,
}

impl DiffArgs {
    pub(crate) fn run(&self) -> anyhow::Result<()> {
        diff(&self.before, &self.after)
    }
}

#[derive(Debug, Args)]
pub(crate) struct ChartArgs {
    /// Scenes for error against time: known names, generators, or files.
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
    /// Methods, separated by commas; all when left out.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = method_parser())]
    methods: Vec<&'static Method>,
    /// Small scenes, small pictures: about a minute, to see that everything works.
    #[arg(long)]
    quick: bool,
    /// Charts of this alone: error, growth or density; may be repeated.
    #[arg(long, value_name = "PURPOSE", value_parser = Purpose::NAMES)]
    only: Vec<String>,
    /// Timed frames of each method on each scene; when left out five, or what fits in two seconds.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    frames: Option<u16>,
    /// Begin anew where an interrupted run left its results.
    #[arg(long)]
    fresh: bool,
    /// Only methods that need no graphics adapter: what happens anyway where there is none.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// Pixels across and down; 640x480 when left out, 320x240 where the CPU draws.
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<(u32, u32)>,
    /// Folder for chart.html, chart.json and chart.csv.
    #[arg(long, value_name = "DIR", default_value = "out/chart")]
    out: PathBuf,
    #[command(flatten)]
    adapter: AdapterArgs,
}

impl ChartArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { scenes, methods, quick, only, frames, fresh, cpu, size, out, adapter } = self;
        let (extent, adapter) = (extent(quick), (!cpu).then(|| adapter.choice()));
        let frames = frames.map(usize::from);
        chart(&chart::Options { extent, scenes, only, frames, methods, size, adapter, out, fresh })
    }
}

#[derive(Debug, Args)]
pub(crate) struct StabilityArgs {
    /// A few values of each case only: about a minute, to see that everything works.
    #[arg(long)]
    quick: bool,
    /// Cases, separated by commas; all when left out.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = case_parser())]
    cases: Vec<&'static Case>,
    /// Methods and their options, separated by commas; all when left out.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = configuration_parser())]
    methods: Vec<Configuration>,
    /// Only methods that need no graphics adapter: what happens anyway where there is none.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// Folder for index.html and records.json.
    #[arg(long, value_name = "DIR", default_value = "out/stability")]
    out: PathBuf,
    #[command(flatten)]
    adapter: AdapterArgs,
}

impl StabilityArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { quick, cases, methods, cpu, out, adapter } = self;
        let adapter = (!cpu).then(|| adapter.choice());
        stability(&stability::Options { quick, cases, methods, adapter, out })
    }
}

#[derive(Debug, Args)]
pub(crate) struct CertifyArgs {
    /// Different rays, at least [default: 100000000, or 100000 with --quick]. A hundred million take two
    /// cores ten minutes with --cpu, and longer with an adapter.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    rays: Option<u64>,
    /// End after so many seconds with fewer rays; then nothing but a wrong answer is an error.
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u32))]
    seconds: Option<u32>,
    /// A few values of each case, few rays a scene: seconds, to see that everything works.
    #[arg(long)]
    quick: bool,
    /// Other random scenes for another seed.
    #[arg(long, value_name = "S", default_value = "1", value_parser = clap::value_parser!(u32))]
    seed: u32,
    /// Only the CPU's tracer.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// Folder for certify.json.
    #[arg(long, value_name = "DIR", default_value = "out/certify")]
    out: PathBuf,
    #[command(flatten)]
    adapter: AdapterArgs,
}

impl CertifyArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { rays, seconds, quick, seed, cpu, out, adapter } = self;
        let rays = rays.unwrap_or(if quick { 100_000 } else { 100_000_000 });
        let adapter = (!cpu).then(|| adapter.choice());
        let time = seconds.map(|seconds| Duration::from_secs(seconds.into()));
        certify(&certify::Options { rays, time, quick, seed: seed.into(), adapter, out })
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::Overrides;
    use metaball_core::Kernel;
    use metaball_core::gpu::AdapterChoice;

    use super::*;
    use crate::{Command, parse};

    #[test]
    fn compare_has_the_documented_defaults() {
        let Ok(Command::Compare(compare)) = parse("metaball compare") else {
            panic!("compare needs no arguments");
        };
        assert_eq!(compare.scenes, DEFAULT_SCENES);
        assert_eq!(compare.scenes[0], "molecule");
        let names: Vec<_> = compare.methods.iter().map(|method| method.name).collect();
        assert_eq!(names, HEADLINERS);
        assert!(!compare.every_method && compare.frames.is_none());
        assert_eq!((compare.shared.size, compare.out), ((640, 480), PathBuf::from("out/compare")));
        assert_eq!(compare.shared.adapter.choice(), AdapterChoice::Environment);
        assert_eq!(compare.shared.overrides(), Overrides::default());
    }

    #[test]
    fn arguments_are_taken() {
        let line = "metaball compare a.pdb scattered:500 --methods bvh,fbvh --size 32x24 --frames 2 \
                    --kernel wyvill --exponent 3 --threshold 0.5 --adapter llvm";
        let Ok(Command::Compare(compare)) = parse(line) else { panic!("a legal command line") };
        assert_eq!(compare.scenes, ["a.pdb", "scattered:500"]);
        let names: Vec<_> = compare.methods.iter().map(|method| method.name).collect();
        assert_eq!((names.as_slice(), compare.frames), (&["bvh", "fbvh"][..], Some(2)));
        assert_eq!(compare.shared.size, (32, 24));
        assert_eq!(compare.shared.adapter.choice(), AdapterChoice::Named("llvm".to_owned()));
        let wanted = Overrides {
            kernel: Some(Kernel::Wyvill),
            exponent: Some(3),
            threshold: Some(0.5),
            color: None,
        };
        assert_eq!(compare.shared.overrides(), wanted);
    }

    #[test]
    fn stability_tries_everything_unless_told() {
        let Ok(Command::Stability(all)) = parse("metaball stability") else {
            panic!("stability needs no arguments");
        };
        assert!(!all.quick && all.cases.is_empty() && all.methods.is_empty());
        assert_eq!(all.out, PathBuf::from("out/stability"));
        let line = "metaball stability --quick --cases overlapping,neck --methods kanamori+fine";
        let Ok(Command::Stability(few)) = parse(line) else { panic!("a legal command line") };
        assert!(few.quick && few.cases.len() == 2 && few.methods[0].name == "kanamori+fine");
    }
}
