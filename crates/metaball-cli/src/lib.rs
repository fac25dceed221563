//! The command line `metaball`: arguments and words. A file for each kind of command; what they do is
//! in the crates `metaball`, which draws, and `experiments`, which measures.
//!
//! [`run`] is the binary. [`run_with`] is a binary of your own in which your [`Method`] takes part.

mod camera;
mod clip;
mod convert;
mod device;
mod display;
mod draw;
mod ending;
mod formula;
mod light;
mod list;
mod measure;
mod names;
mod picture;
mod reading;
mod says;
mod shared;
mod tables;
mod values;
#[cfg(feature = "viewer")]
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use experiments::console;
pub use harness::judge::Stop;
pub use harness::judge::promise::Promise;
pub use harness::methods::Method;
use harness::methods::add_methods;
pub use harness::renderer::Renderer;
pub use harness::technique::{Own, Technique};

use self::convert::ConvertArgs;
use self::device::DeviceArgs;
use self::draw::{AnimateArgs, RenderArgs};
use self::ending::{CODES, Ending};
use self::measure::{CertifyArgs, ChartArgs, CompareArgs, DiffArgs, ScoreArgs, StabilityArgs};
use self::tables::TablesCommand;
#[cfg(feature = "viewer")]
use self::view::ViewArgs;

/// Ray casters of metaball isosurfaces on the GPU, compared with an exact reference.
#[derive(Debug, Parser)]
#[command(version, after_help = CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw scenes with methods, hold the pictures against the reference, and write a page about it.
    Compare(Box<CompareArgs>),
    /// Hold hits of any program against the reference, and print the row that compare would.
    ///
    /// One hit for each pixel of the scene's camera, as OpenEXR or NumPy: docs/hits-format.md. Needs no
    /// graphics adapter.
    Score(Box<ScoreArgs>),
    /// Say what changed between two files of records, of compare or chart: faster, slower, more or fewer
    /// wrong rays, by more than the spread.
    Diff(DiffArgs),
    /// Draw one picture.
    Render(Box<RenderArgs>),
    /// Draw the frames of a moving scene, and report how long building and drawing took.
    ///
    /// Frames that are there already, whole and drawn with these options, are not drawn again, so an
    /// interrupted run is continued, and the range can be split among machines: docs/many-frames.md.
    #[command(after_help = CODES)]
    Animate(Box<AnimateArgs>),
    /// Open a window: turn the surface, light it, cut it, and ask what a point of it is made of.
    #[cfg(feature = "viewer")]
    View(Box<ViewArgs>),
    /// Measure a paper's tables anew, and set the printed numbers beside; or other programs; or what it
    /// saves that shaders are made for a scene.
    Tables {
        #[command(subcommand)]
        of: TablesCommand,
    },
    /// Turn the parameters of stability cases until methods break, and write a page about where.
    Stability(StabilityArgs),
    /// Hold the certified tree against the reference over a hundred million rays, most of them hard.
    ///
    /// Every stability case within the stated limits, then random scenes; rays of pictures, along the
    /// surface, along the faces of the tree's boxes, out of the solid. The CPU's tracer answers all, the
    /// adapter a third. Fails where an answer is wrong, or too many are undecided or inexact. An
    /// interrupted run is continued.
    Certify(CertifyArgs),
    /// Chart error against time over every method's knobs, and growth with count and density.
    Chart(ChartArgs),
    /// Measure a graphics processor by all of these, in eight minutes: correctness first, then frame times by
    /// scene, size, density and effect.
    ///
    /// Each part is a process of its own with a share of the time, so none ends another. After each, all that
    /// is known so far is in device.json and summary.txt. Without an adapter they say what is missing, and the
    /// CPU measures what it can.
    Device(DeviceArgs),
    /// Write the particles of a file in another format: extended XYZ, CSV, NPY, PLY or VTP.
    Convert(ConvertArgs),
    /// List the known scenes and the generators.
    Scenes,
    /// List the methods.
    Methods,
}

impl Command {
    /// Whether it shows something on a display.
    fn shows(&self) -> bool {
        #[cfg(feature = "viewer")]
        return matches!(self, Self::View(_));
        #[cfg(not(feature = "viewer"))]
        return false;
    }
}

/// Runs the command that the process's arguments name, and prints what went wrong.
pub fn run() -> ExitCode {
    run_with([])
}

/// The same with methods of another crate, which join every command as those of this workspace do. On
/// Linux the process may be started anew, in its own place, so this is what it does first.
///
/// ```no_run
/// # fn renderer(counting: bool) -> Renderer {
/// #     harness::methods::methods()[0].renderer(counting)
/// # }
/// use std::process::ExitCode;
///
/// use metaball_cli::{Method, Own, Promise, Renderer, Stop, Technique};
///
/// const MARCH: Method = Method {
///     name: "march",
///     title: "Ray march",
///     paper: "not published",
///     about: "Goes along the ray in short steps.",
///     technique: Technique::Own(Own {
///         make: |counting| renderer(counting),
///         promise: Promise::Always,
///         stop: Stop::Residual(1e-5),
///         refuses: |_| None,
///     }),
/// };
///
/// fn main() -> ExitCode {
///     metaball_cli::run_with([MARCH])
/// }
/// ```
pub fn run_with(own: impl IntoIterator<Item = Method>) -> ExitCode {
    let outcome = add_methods(own).map_err(anyhow::Error::from);
    let obeyed = outcome.and_then(|()| {
        let command = Cli::parse().command;
        if !command.shows() {
            display::leave_out();
        }
        obey(command)
    });
    if let Err(error) = &obeyed {
        console::note(&format!("metaball: {error:#}"));
    }
    Ending::of(&obeyed).into()
}

fn obey(command: Command) -> anyhow::Result<()> {
    match command {
        Command::Compare(compare) => compare.run(),
        Command::Score(score) => score.run(),
        Command::Diff(diff) => diff.run(),
        Command::Render(render) => render.run(),
        Command::Animate(animate) => animate.run(),
        #[cfg(feature = "viewer")]
        Command::View(view) => view.run(),
        Command::Device(device) => device.run(),
        Command::Convert(convert) => convert.run(),
        Command::Tables { of } => of.run(),
        Command::Stability(stability) => stability.run(),
        Command::Certify(certify) => certify.run(),
        Command::Chart(chart) => chart.run(),
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
fn parse(line: &str) -> Result<Command, clap::Error> {
    Cli::try_parse_from(line.split_whitespace()).map(|cli| cli.command)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn mistakes_are_named() {
        let message = |line| parse(line).expect_err("a mistake").to_string();
        assert!(message("metaball compare --methods nosuch").contains("bvh"));
        assert!(message("metaball compare --size 640").contains("WIDTHxHEIGHT"));
        assert!(message("metaball compare --size 0x480").contains("WIDTHxHEIGHT"));
        assert!(message("metaball compare --frames 0").contains("--frames"));
        assert!(message("metaball render molecule --picture nosuch").contains("work:"));
        assert!(
            message("metaball compare --kernel gauss").contains("wyvill, perlin, cubic-spline")
        );
        assert!(message("metaball render a.pdb --preset vmd").contains("quicksurf, molmap"));
        assert!(message("metaball render a.vtu --sph --preset splashsurf").contains("--preset"));
        assert!(
            parse("metaball render a.pdb --preset gaussian-surface --radius-offset -0.2").is_ok()
        );
        assert!(
            parse("metaball animate f%d.vtu --sph --support-per-h 1 --kernel wendland-c2").is_ok()
        );
        assert!(message("metaball stability --cases nosuch").contains("grazing"));
        assert!(message("metaball animate splash --frames 5..5").contains("FIRST..END"));
        assert!(message("metaball animate splash --out frame.png").contains("frame-%04d.png"));
        assert!(parse("metaball render").is_err());
        assert!(parse("metaball render molecule --cpu --software").is_err());
    }
}
