//! The command line.

use std::ops::Range;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::{Context, bail, ensure};
use bench_scenes::{Case, LoadError, NumberedPath, Overrides, kernel_named};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use harness::animate::{self, animate};
use harness::auto::MAX_ERROR;
use harness::auto::cache::Cache;
use harness::camera::CameraOptions;
use harness::certify::{self, certify};
use harness::compare::{Comparison, DEFAULT_SCENES, compare};
use harness::contest::Rules;
use harness::light::LightOptions;
use harness::measure::Sampling;
use harness::methods::{HEADLINERS, METHODS, Method, find};
use harness::picture::picture_named;
use harness::render::{Choosing, Device, Drawing, Order, render};
use harness::settings::Setting;
use harness::settings::variants::entrants;
use harness::stability::{self, stability};
use harness::tables::{self, gourmel, gourmel_light, illes, kanamori, peers, specialisation};
use harness::{chart, console, list};
use metaball_core::Kernel;
use metaball_core::gpu::{AdapterChoice, Picture};

/// Ray casters of metaball isosurfaces on the GPU, compared with an exact reference.
#[derive(Debug, Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw scenes with methods, hold the pictures against the reference, and write a page about it.
    Compare {
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
        /// Timed frames of each method on each scene; when left out five, or what fits in four seconds.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        frames: Option<u16>,
        /// Time along the scene's camera path, where it has one.
        #[arg(long)]
        path: bool,
        /// Compare every pixel, of large scenes too.
        #[arg(long)]
        every_pixel: bool,
        /// Folder for index.html and records.json.
        #[arg(long, value_name = "DIR", default_value = "out/compare")]
        out: PathBuf,
        #[command(flatten)]
        common: Common,
    },
    /// Draw one picture.
    Render {
        #[command(flatten)]
        drawing: Box<DrawingArgs>,
        /// Draw with the quickest method and options whose error on this scene is at most so many mean
        /// support radii for 99 of 100 hits, with no wrong verdict [default of auto: 1e-3].
        #[arg(long, value_name = "E", value_parser = max_error)]
        max_error: Option<f64>,
        /// With auto, neither look for a choice made earlier nor keep the one made now.
        #[arg(long)]
        ignore_cache: bool,
        /// Where the PNG goes.
        #[arg(long, value_name = "FILE", default_value = "out/image.png")]
        out: PathBuf,
        /// Write distances (Z) and normals (N.X, N.Y, N.Z) as f32 channels of an OpenEXR file too.
        #[arg(long, value_name = "FILE")]
        hits: Option<PathBuf>,
        /// Write the picture's linear light as an OpenEXR file too.
        #[arg(long, value_name = "FILE", requires = "LightOptions")]
        light_out: Option<PathBuf>,
    },
    /// Draw the frames of a moving scene, and report how long building and drawing took.
    ///
    /// Frames that are there already, whole and drawn with these options, are not drawn again, so an
    /// interrupted run is taken up where it was, and the range can be split among machines.
    Animate {
        #[command(flatten)]
        drawing: Box<DrawingArgs>,
        /// Frames, the last one not included; all, or the first seconds of what goes on for ever.
        #[arg(long, value_name = "A..B")]
        frames: Option<FrameRange>,
        /// Draw every Nth of them.
        #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
        every: u32,
        /// Where the PNGs go: %d stands for the frame's number, %04d for four digits or more.
        #[arg(long, value_name = "FILE", default_value = "out/frame-%04d.png")]
        out: NumberedPath,
        /// Write a picture of all these frames side by side too.
        #[arg(long, value_name = "FILE")]
        sheet: Option<PathBuf>,
        /// Draw all frames, those that are there too.
        #[arg(long)]
        force: bool,
        /// Build for a frame only after the one before has been drawn, not meanwhile.
        #[arg(long)]
        in_turn: bool,
    },
    /// Measure a paper's tables anew, and set the printed numbers beside; or other programs; or what it
    /// saves that shaders are made for a scene.
    Tables {
        #[command(subcommand)]
        paper: Paper,
    },
    /// Turn the parameters of stability cases until methods break, and write a page about where.
    Stability {
        /// A few values of each case only: about a minute, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Cases, separated by commas; all when left out.
        #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = case_parser())]
        cases: Vec<&'static Case>,
        /// Methods and their options, separated by commas; all when left out.
        #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = entrant_parser())]
        methods: Vec<Setting>,
        /// Folder for index.html and records.json.
        #[arg(long, value_name = "DIR", default_value = "out/stability")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// Hold the certified tree against the reference over a hundred million rays, most of them hard.
    ///
    /// Every stability case within the stated limits, then random scenes; rays of pictures, along the
    /// surface, along the faces of the tree's boxes, out of the solid. The CPU's tracer answers all, the
    /// adapter a third. Fails where an answer is wrong, or too many are undecided or inexact. An
    /// interrupted run is taken up where it was.
    Certify {
        /// Different rays, at least [default: 100000000, or 100000 with --quick].
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
        rays: Option<u64>,
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
        device: AdapterArgs,
    },
    /// Chart error against time over every method's knobs, and growth with count and density.
    Chart {
        /// Scenes for error against time: known names, generators, or files.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        /// Small scenes, small pictures: about a minute, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Begin anew where an interrupted run left its results.
        #[arg(long)]
        fresh: bool,
        /// Pixels across and down; 640x480 when left out, 320x240 on a software adapter.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for chart.html and chart.json.
        #[arg(long, value_name = "DIR", default_value = "out/chart")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// List the known scenes and the generators.
    Scenes,
    /// List the methods.
    Methods,
}

/// Papers whose tables are measured.
#[derive(Debug, Subcommand)]
enum Paper {
    /// Gourmel et al. 2010: tables 1, 3, 4 and 5, both heuristics, and plots of frame time.
    Gourmel {
        /// Small scenes, small pictures: about a minute, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 640x480 when left out, 320x240 on a software adapter.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for gourmel.html and gourmel.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// Gourmel et al. 2010: table 2, what shadows and reflections cost, and table 1 under each scene's own
    /// effects.
    GourmelLight {
        /// Small scenes, small pictures: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 640x480 when left out, 160x120 on a software adapter.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for gourmel-light.html and gourmel-light.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// Kanamori et al. 2008: table 1 against the CPU, the optimisations of section 5, time against
    /// error, figure 8 and the scenes of section 6.
    Kanamori {
        /// Small scenes, small pictures: to see that everything works.
        #[arg(long, conflicts_with = "full")]
        quick: bool,
        /// Everything, however long it takes; else what fits into ten minutes, and the rest is named.
        #[arg(long)]
        full: bool,
        /// Folder for kanamori.html and kanamori.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// Illés and Szécsi: table 1, how its phases grow, lists, figure 7, errors by kernel, memory.
    Illes {
        /// Hundreds of particles, small pictures: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// All rows; without it those that fit into ten minutes.
        #[arg(long, conflicts_with = "quick")]
        full: bool,
        /// Pixels across and down of table 1; 1024x768 when left out.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for illes.html and illes.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// No paper: fbvh-certified on the CPU against POV-Ray's blob, time and error, power kernel α = 2.
    Peers {
        /// Known names, generators, or files; five scenes of 5,547 to 128,000 balls when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        /// Hundreds of balls, small pictures: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 640x480 when left out.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for peers.html and peers.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
    },
    /// No paper: what auto chooses for two errors, beside the quickest of all that it could have chosen.
    Auto {
        /// Known names, generators, or files; eight scenes when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        /// Hundreds of balls, small pictures, few candidates: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 320x240 when left out.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for auto.html and auto.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
    /// No paper: frame time, memory and code with shaders made for a scene, against shaders that read
    /// its kernel, exponent, radii, strengths or colours, or count their work.
    Specialisation {
        /// Known names, generators, or files; four scenes of 4,000 to 30,720 balls when left out.
        #[arg(value_name = "SCENE")]
        scenes: Vec<String>,
        /// Hundreds of balls, small pictures: seconds, to see that everything works.
        #[arg(long)]
        quick: bool,
        /// Pixels across and down; 160x120 when left out.
        #[arg(long, value_name = "WxH")]
        size: Option<Size>,
        /// Folder for specialisation.html and specialisation.json.
        #[arg(long, value_name = "DIR", default_value = "out/tables")]
        out: PathBuf,
        #[command(flatten)]
        device: AdapterArgs,
    },
}

/// What to draw, and how.
#[derive(Debug, Args)]
struct DrawingArgs {
    /// A known name, a generator such as scattered:50000, or a file; for animate one that moves, such
    /// as tornado:4000 or particles-%04d.xyz.
    scene: String,
    /// The method; fbvh-certified when left out. For render, auto chooses: see --max-error.
    #[arg(long, value_name = "NAME", value_parser = drawer_parser())]
    method: Option<String>,
    /// What the picture shows: phong, normal, depth, color, spheres, or work:COUNTER.
    #[arg(long, value_name = "WHAT", default_value = "phong", value_parser = picture_named)]
    picture: Picture,
    /// Trace on the CPU, without a graphics adapter: what happens anyway where there is none.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    #[command(flatten)]
    camera: CameraOptions,
    #[command(flatten)]
    light: LightOptions,
    #[command(flatten)]
    common: Common,
}

impl DrawingArgs {
    /// With the default method where another is chosen in its place.
    fn drawing(self) -> anyhow::Result<Drawing> {
        let Self { scene, method, picture, cpu, camera, light, common } = self;
        let name = method.as_deref().filter(|&name| name != AUTO).unwrap_or(DEFAULT_METHOD);
        let method = find(name).with_context(|| format!("no method is called {name}"))?;
        let (overrides, size) = (common.overrides(), common.size());
        let device = if cpu { Device::Cpu } else { Device::Adapter(common.adapter()) };
        Ok(Drawing { scene, overrides, method, size, camera, picture, light, device })
    }
}

/// What every drawing command takes.
#[derive(Debug, Args)]
struct Common {
    /// Pixels across and down.
    #[arg(long, value_name = "WxH", default_value = "640x480")]
    size: Size,
    #[command(flatten)]
    device: AdapterArgs,
    /// Kernel in place of the scene's own: power, wyvill or perlin.
    #[arg(long, value_name = "NAME", value_parser = kernel)]
    kernel: Option<Kernel>,
    /// Exponent of a power kernel, 1 to 8.
    #[arg(long, value_name = "N")]
    exponent: Option<i64>,
    /// Threshold in place of the scene's own.
    #[arg(long, value_name = "T")]
    threshold: Option<f32>,
}

/// Which adapter draws.
#[derive(Debug, Args)]
struct AdapterArgs {
    /// Draw with the adapter that has this in its name.
    #[arg(long, value_name = "NAME", conflicts_with = "software")]
    adapter: Option<String>,
    /// Draw with an adapter that computes on the CPU.
    #[arg(long)]
    software: bool,
}

impl AdapterArgs {
    fn choice(&self) -> AdapterChoice {
        match &self.adapter {
            Some(name) => AdapterChoice::Named(name.clone()),
            None if self.software => AdapterChoice::Software,
            None => AdapterChoice::Environment,
        }
    }
}

/// A picture's size in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Size(u32, u32);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once('x')
            .and_then(|(width, height)| Some(Self(width.parse().ok()?, height.parse().ok()?)))
            .filter(|size| size.0 > 0 && size.1 > 0)
            .ok_or_else(|| "needed WIDTHxHEIGHT in pixels, such as 640x480".to_owned())
    }
}

/// Numbers of frames, the last one not included.
#[derive(Debug, Clone, PartialEq, Eq)]
struct FrameRange(Range<u32>);

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once("..")
            .and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?))
            .filter(|range: &Range<u32>| !range.is_empty())
            .map(Self)
            .ok_or_else(|| "needed FIRST..END, such as 0..48 for the frames 0 to 47".to_owned())
    }
}

impl Common {
    fn size(&self) -> (u32, u32) {
        (self.size.0, self.size.1)
    }

    fn adapter(&self) -> AdapterChoice {
        self.device.choice()
    }

    fn overrides(&self) -> Overrides {
        Overrides { kernel: self.kernel, exponent: self.exponent, threshold: self.threshold }
    }
}

fn kernel(name: &str) -> Result<Kernel, LoadError> {
    kernel_named(name, None)
}

/// A method by name; an unknown one is answered with the list.
fn method_parser() -> impl TypedValueParser<Value = &'static Method> {
    let names = METHODS.iter().map(|method| PossibleValue::new(method.name).help(method.title));
    PossibleValuesParser::new(names).map(|name| find(&name).expect("only names of methods pass"))
}

/// A method by name, or `auto`.
fn drawer_parser() -> impl TypedValueParser<Value = String> {
    let names = METHODS.iter().map(|method| PossibleValue::new(method.name).help(method.title));
    let auto = PossibleValue::new(AUTO).help("The quickest that is right enough");
    PossibleValuesParser::new(names.chain([auto]))
}

const AUTO: &str = "auto";

/// Who draws unless told.
const DEFAULT_METHOD: &str = "fbvh-certified";

/// Whether to choose who draws; an error is asked of `auto` alone.
fn choosing(
    name: Option<&str>,
    max_error: Option<f64>,
    ignore_cache: bool,
) -> anyhow::Result<Option<Choosing>> {
    if name == Some(AUTO) || (name.is_none() && max_error.is_some()) {
        let cache = if ignore_cache { Cache::none() } else { Cache::of_user() };
        return Ok(Some(Choosing { max_error: max_error.unwrap_or(MAX_ERROR), cache }));
    }
    let name = name.unwrap_or(DEFAULT_METHOD);
    ensure!(max_error.is_none(), "--max-error: needed --method auto, found --method {name}");
    ensure!(!ignore_cache, "--ignore-cache: needed --method auto, found --method {name}");
    Ok(None)
}

/// An error in mean support radii.
fn max_error(text: &str) -> Result<f64, String> {
    let error = text.parse().ok().filter(|error: &f64| error.is_finite() && *error > 0.0);
    error.ok_or_else(|| "needed a number above 0, in mean support radii, such as 1e-3".to_owned())
}

/// A stability case by name.
fn case_parser() -> impl TypedValueParser<Value = &'static Case> {
    let named = |name: &str| bench_scenes::cases().iter().find(|case| case.name == name);
    let names = bench_scenes::cases().iter().map(|case| PossibleValue::new(case.name));
    PossibleValuesParser::new(names)
        .map(move |name| named(&name).expect("only names of cases pass"))
}

/// A method, or one with an option turned, by name.
fn entrant_parser() -> impl TypedValueParser<Value = Setting> {
    // Names on the command line live as long as the program.
    let leak = |entrant: Setting| PossibleValue::new(&*entrant.name.leak());
    let names = entrants().into_iter().map(leak);
    PossibleValuesParser::new(names).map(|name| {
        let mut all = entrants().into_iter();
        all.find(|entrant| entrant.name == name).expect("only names of entrants pass")
    })
}

fn main() -> ExitCode {
    match run(Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::note(&format!("metaball: {error:#}"));
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> anyhow::Result<()> {
    match command {
        Command::Compare {
            scenes,
            methods,
            every_method,
            frames,
            path,
            every_pixel,
            out,
            common,
        } => {
            let methods = if every_method { METHODS.iter().collect() } else { methods };
            let rules = Rules {
                settings: methods.into_iter().map(Setting::preset).collect(),
                size: common.size(),
                sampling: frames.map_or(Sampling::QUICK, |n| Sampling::exactly(n.into())),
                along_path: path,
                every_pixel,
                counts_work: true,
            };
            let (overrides, adapter) = (common.overrides(), common.adapter());
            compare(&Comparison { scenes, overrides, rules, adapter, out })
        }
        Command::Render { drawing, max_error, ignore_cache, out, hits, light_out } => {
            let auto = choosing(drawing.method.as_deref(), max_error, ignore_cache)?;
            render(&Order { drawing: drawing.drawing()?, auto, out, hits, light_out })
        }
        Command::Animate { drawing, frames, every, out, sheet, force, in_turn } => {
            if drawing.method.as_deref() == Some(AUTO) {
                bail!("auto chooses for one picture: for frames name a method");
            }
            let (drawing, frames) = (drawing.drawing()?, frames.map(|FrameRange(range)| range));
            animate(&animate::Order { drawing, frames, every, out, sheet, force, in_turn })
        }
        Command::Tables { paper: Paper::Gourmel { quick, size, out, device } } => {
            let extent =
                if quick { gourmel::plan::Extent::Quick } else { gourmel::plan::Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            gourmel::tables(&gourmel::Order { extent, size, adapter: device.choice(), out })
        }
        Command::Tables { paper: Paper::GourmelLight { quick, size, out, device } } => {
            let extent =
                if quick { gourmel::plan::Extent::Quick } else { gourmel::plan::Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            let adapter = device.choice();
            gourmel_light::tables(&gourmel_light::Order { extent, size, adapter, out })
        }
        Command::Tables { paper: Paper::Kanamori { quick, full, out, device } } => {
            let extent = match (quick, full) {
                (true, _) => kanamori::plan::Extent::Quick,
                (false, false) => kanamori::plan::Extent::Usual,
                (false, true) => kanamori::plan::Extent::Full,
            };
            kanamori::tables(&kanamori::Order { extent, adapter: device.choice(), out })
        }
        Command::Tables { paper: Paper::Illes { quick, full, size, out, device } } => {
            let extent = match (quick, full) {
                (true, _) => illes::Extent::Quick,
                (_, true) => illes::Extent::Full,
                _ => illes::Extent::Default,
            };
            let size = size.map(|Size(width, height)| (width, height));
            illes::tables(&illes::Order { extent, size, adapter: device.choice(), out })
        }
        Command::Tables { paper: Paper::Peers { scenes, quick, size, out } } => {
            let extent = if quick { peers::Extent::Quick } else { peers::Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            peers::tables(&peers::Order { scenes, extent, size, out })
        }
        Command::Tables { paper: Paper::Auto { scenes, quick, size, out, device } } => {
            use tables::auto::{Extent, Order};
            let extent = if quick { Extent::Quick } else { Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            tables::auto::tables(&Order { scenes, extent, size, adapter: device.choice(), out })
        }
        Command::Tables { paper: Paper::Specialisation { scenes, quick, size, out, device } } => {
            let extent =
                if quick { specialisation::Extent::Quick } else { specialisation::Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            let adapter = device.choice();
            specialisation::tables(&specialisation::Order { scenes, extent, size, adapter, out })
        }
        Command::Stability { quick, cases, methods, out, device } => {
            stability(&stability::Order { quick, cases, methods, adapter: device.choice(), out })
        }
        Command::Certify { rays, quick, seed, cpu, out, device } => {
            let rays = rays.unwrap_or(if quick { 100_000 } else { 100_000_000 });
            let adapter = (!cpu).then(|| device.choice());
            certify(&certify::Order { rays, quick, seed: seed.into(), adapter, out })
        }
        Command::Chart { scenes, quick, fresh, size, out, device } => {
            let extent =
                if quick { chart::plan::Extent::Quick } else { chart::plan::Extent::Whole };
            let size = size.map(|Size(width, height)| (width, height));
            let adapter = device.choice();
            chart::chart(&chart::Order { extent, scenes, size, adapter, out, fresh })
        }
        Command::Scenes => {
            list::scenes();
            Ok(())
        }
        Command::Methods => {
            list::methods();
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn parse(line: &str) -> Result<Command, clap::Error> {
        Cli::try_parse_from(line.split_whitespace()).map(|cli| cli.command)
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn compare_has_the_documented_defaults() {
        let Ok(Command::Compare { scenes, methods, every_method, frames, out, common, .. }) =
            parse("metaball compare")
        else {
            panic!("compare needs no arguments");
        };
        assert_eq!(scenes, DEFAULT_SCENES);
        assert_eq!(scenes[0], "molecule");
        let names: Vec<_> = methods.iter().map(|method| method.name).collect();
        assert_eq!(names, HEADLINERS);
        assert!(!every_method && frames.is_none());
        assert_eq!((common.size(), out), ((640, 480), PathBuf::from("out/compare")));
        assert_eq!(common.adapter(), AdapterChoice::Environment);
        assert_eq!(common.overrides(), Overrides::default());
    }

    #[test]
    fn arguments_are_taken() {
        let line = "metaball compare a.pdb scattered:500 --methods bvh,fbvh --size 32x24 --frames 2 \
                    --kernel wyvill --exponent 3 --threshold 0.5 --adapter llvm";
        let Ok(Command::Compare { scenes, methods, frames, common, .. }) = parse(line) else {
            panic!("a legal command line");
        };
        assert_eq!(scenes, ["a.pdb", "scattered:500"]);
        let names: Vec<_> = methods.iter().map(|method| method.name).collect();
        assert_eq!((names.as_slice(), frames), (&["bvh", "fbvh"][..], Some(2)));
        assert_eq!(common.size(), (32, 24));
        assert_eq!(common.adapter(), AdapterChoice::Named("llvm".to_owned()));
        let wanted =
            Overrides { kernel: Some(Kernel::Wyvill), exponent: Some(3), threshold: Some(0.5) };
        assert_eq!(common.overrides(), wanted);
    }

    #[test]
    fn stability_tries_everything_unless_told() {
        let Ok(Command::Stability { quick, cases, methods, out, .. }) = parse("metaball stability")
        else {
            panic!("stability needs no arguments");
        };
        assert!(!quick && cases.is_empty() && methods.is_empty());
        assert_eq!(out, PathBuf::from("out/stability"));
        let line = "metaball stability --quick --cases crowd,neck --methods kanamori+fine";
        let Ok(Command::Stability { quick, cases, methods, .. }) = parse(line) else {
            panic!("a legal command line");
        };
        assert!(quick && cases.len() == 2 && methods[0].name == "kanamori+fine");
    }

    #[test]
    fn an_error_asks_for_auto() {
        let chosen = |line: &str| {
            let Ok(Command::Render { drawing, max_error, ignore_cache, .. }) = parse(line) else {
                panic!("a legal command line");
            };
            choosing(drawing.method.as_deref(), max_error, ignore_cache)
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

    #[test]
    fn mistakes_are_named() {
        let message = |line| parse(line).expect_err("a mistake").to_string();
        assert!(message("metaball compare --methods nosuch").contains("bvh"));
        assert!(message("metaball compare --size 640").contains("WIDTHxHEIGHT"));
        assert!(message("metaball compare --size 0x480").contains("WIDTHxHEIGHT"));
        assert!(message("metaball compare --frames 0").contains("--frames"));
        assert!(message("metaball render molecule --picture nosuch").contains("work:"));
        assert!(message("metaball compare --kernel gauss").contains("wyvill or perlin"));
        assert!(message("metaball stability --cases nosuch").contains("grazing"));
        assert!(message("metaball animate splash --frames 5..5").contains("FIRST..END"));
        assert!(message("metaball animate splash --out frame.png").contains("frame-%04d.png"));
        assert!(parse("metaball render").is_err());
        assert!(parse("metaball render molecule --cpu --software").is_err());
        assert!(parse("metaball tables").is_err());
    }
}
