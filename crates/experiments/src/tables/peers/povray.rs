//! POV-Ray as a process: a scene for its `blob`, its own clocks, and depths out of its colours.

use std::fmt::Write;
use std::fs;
use std::io::ErrorKind;
use std::process::Command;

use anyhow::Context;
use glam::DVec3;
use image::Rgb;
use metaball_core::{Hit, Scene, Verdict, View};
use picture_files::HitImage;
use tempfile::TempDir;

/// How a reader comes by the peer.
pub const INSTALL: &str = "To install it: `apt-get install povray` (Debian, Ubuntu), `brew install \
                           povray` (macOS), or its sources; `povray` has to be on the PATH.";

const PROGRAM: &str = "povray";
const SCENE_FILE: &str = "scene.pov";
const PICTURE_FILE: &str = "picture.png";

/// Periods of the fine channel over the range of the coarse one. A step of 16 bits in the coarse one
/// is a sixteenth of a period, so the period is never uncertain.
const PERIODS: f64 = 4096.0;

/// The installed program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Povray {
    version: String,
}

/// Its own clocks, milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    /// Parsing the scene and making the blob's hierarchy, by the wall's clock.
    pub parse: f64,
    /// Tracing, by the wall's clock.
    pub trace: f64,
    /// Tracing, summed over its threads.
    pub trace_cpu: f64,
}

impl Povray {
    /// The program on the PATH, with its version; `None` where there is none.
    ///
    /// # Errors
    /// When there is one that cannot be run, or that does not say a version.
    pub fn find() -> anyhow::Result<Option<Self>> {
        let output = match Command::new(PROGRAM).arg("--version").output() {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            output => output.with_context(|| format!("cannot run {PROGRAM} --version"))?,
        };
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        let version = text.lines().find(|line| line.starts_with("POV-Ray "));
        let version = version.with_context(|| {
            format!("{PROGRAM} --version: needed a line \"POV-Ray …\", found \"{}\"", text.trim())
        })?;
        Ok(Some(Self { version: version.trim().to_owned() }))
    }

    /// What it calls itself.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Draws the scene in white, and reads its clocks.
    ///
    /// # Errors
    /// When it fails, with its own words, or does not say how long it took.
    pub fn time(&self, job: &Job<'_>) -> anyhow::Result<Times> {
        let log = job.draw(false)?;
        let (parse, _) = clocks(&log, "Parse Time:")?;
        let (trace, trace_cpu) = clocks(&log, "Trace Time:")?;
        Ok(Times { parse, trace, trace_cpu })
    }

    /// Draws the scene with its depth for a colour, and reads the hits off the picture, row by row
    /// from the top left; without normals. Distances are along POV-Ray's own rays, which are f64.
    ///
    /// # Errors
    /// When it fails, with its own words, or leaves no picture of the size.
    pub fn hits(&self, job: &Job<'_>) -> anyhow::Result<HitImage> {
        job.draw(true)?;
        let picture = image::open(job.folder.path().join(PICTURE_FILE))
            .with_context(|| format!("{PROGRAM}: no picture to read"))?
            .into_rgb16();
        let (width, height) = (job.view.width(), job.view.height());
        anyhow::ensure!(
            picture.dimensions() == (width, height),
            "{PROGRAM}: needed a picture of {width} × {height}, found {:?}",
            picture.dimensions()
        );
        let camera = job.view.camera();
        let forward = camera.forward().as_dvec3().normalize();
        let hit = |(column, row, color): (u32, u32, &Rgb<u16>)| {
            depth_of(*color, job.range).map_or(Hit::MISS, |depth| {
                let direction = camera.exact_direction(column, row, width, height);
                let t = (depth / direction.dot(forward)) as f32;
                Hit { verdict: Verdict::Hit, t, ..Hit::MISS }
            })
        };
        let hits = picture.enumerate_pixels().map(hit).collect();
        Ok(HitImage { width, height, hits, has_normals: false })
    }
}

/// A view of a scene, written down for POV-Ray in a temporary folder that goes with it.
#[derive(Debug)]
pub struct Job<'a> {
    view: &'a View,
    threads: usize,
    /// No surface is deeper than this.
    range: f64,
    folder: TempDir,
}

impl<'a> Job<'a> {
    /// Writes the scene's file. The field is that of α = 2 whatever the scene's kernel is.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn new(scene: &Scene, view: &'a View, threads: usize) -> anyhow::Result<Self> {
        let folder = TempDir::new().context("cannot make a temporary folder")?;
        let range = range(scene, view);
        fs::write(folder.path().join(SCENE_FILE), scene_text(scene, view, range))
            .context("cannot write POV-Ray's scene to the temporary folder")?;
        Ok(Self { view, threads, range, folder })
    }

    /// Runs the program in the folder, where it may write whatever its configuration forbids, and
    /// returns its output.
    fn draw(&self, depth: bool) -> anyhow::Result<String> {
        let mut command = Command::new(PROGRAM);
        command.current_dir(self.folder.path());
        command.args([format!("+I{SCENE_FILE}"), format!("+O{PICTURE_FILE}")]);
        command.args([format!("+W{}", self.view.width()), format!("+H{}", self.view.height())]);
        command.arg(format!("+WT{}", self.threads));
        // 16 bits a channel and linear; no antialiasing, window, progress or pause.
        command.args(["+FN16", "File_Gamma=1.0", "Dither=off", "-A", "-D", "-V", "-P"]);
        if depth {
            command.arg("Declare=Depth=1");
        }
        let output = command.output().with_context(|| format!("cannot run {PROGRAM}"))?;
        let log = String::from_utf8_lossy(&output.stderr).into_owned();
        anyhow::ensure!(
            output.status.success(),
            "{PROGRAM} ended with {}: {}",
            output.status,
            complaint(&log)
        );
        Ok(log)
    }
}

/// The depth beyond which there is no ball, with a margin for the coarse channel's last step.
fn range(scene: &Scene, view: &View) -> f64 {
    let eye = view.camera().eye().as_dvec3();
    let reach = scene
        .supports()
        .iter()
        .map(|support| support.center.as_dvec3().distance(eye) + f64::from(support.radius));
    1.01 * reach.fold(0.0, f64::max).max(f64::from(f32::MIN_POSITIVE))
}

/// The scene in POV-Ray's language: white, or with `Depth` declared blue where there is a surface,
/// red the depth over the range, and green its fraction at [`PERIODS`] periods.
///
/// POV-Ray's axes are left-handed by convention only: its camera takes any three vectors.
fn scene_text(scene: &Scene, view: &View, range: f64) -> String {
    let camera = view.camera();
    let height = 2.0 * f64::from(camera.half_height());
    let width = height * f64::from(view.width()) / f64::from(view.height());
    let eye = vector(camera.eye().as_dvec3());
    let forward = camera.forward().as_dvec3();
    let gradient = vector(forward.normalize());
    let mut text = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\n\
         camera {{ perspective location {eye} direction {} right {} up {} }}\n\
         blob {{ threshold {:e}\n",
        vector(forward),
        vector(width * camera.right().as_dvec3()),
        vector(height * camera.up().as_dvec3()),
        scene.threshold()
    );
    for ball in scene.balls() {
        let center = vector(ball.center.as_dvec3());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "sphere {{ {center}, {:e}, {:e} }}", ball.radius, ball.strength);
    }
    let channel = |from: &str, to: &str, period: f64| {
        format!(
            "[1 gradient {gradient} color_map {{ [0 rgb {from}] [1 rgb {to}] }} scale {period:e}]"
        )
    };
    // The average of two pigments is half of either.
    let coarse = channel("<0,0,2>", "<2,0,2>", range);
    let fine = channel("<0,0,0>", "<0,2,0>", range / PERIODS);
    text + &format!(
        "#ifdef (Depth)\n\
         pigment {{ average pigment_map {{\n{coarse}\n{fine}\n}} translate {eye} }}\n\
         #else\npigment {{ rgb 1 }}\n#end\n\
         finish {{ emission 1 ambient 0 diffuse 0 }} }}\n"
    )
}

fn vector(vector: DVec3) -> String {
    format!("<{:e},{:e},{:e}>", vector.x, vector.y, vector.z)
}

/// The depth that a colour encodes; `None` where nothing was hit.
fn depth_of(Rgb([coarse, fine, blue]): Rgb<u16>, range: f64) -> Option<f64> {
    let share = |channel: u16| f64::from(channel) / f64::from(u16::MAX);
    let (coarse, fine) = (share(coarse), share(fine));
    let period = (coarse * PERIODS - fine).round();
    (share(blue) > 0.5).then(|| range * (period + fine) / PERIODS)
}

/// Wall and CPU milliseconds under a heading of the log.
fn clocks(log: &str, heading: &str) -> anyhow::Result<(f64, f64)> {
    let mut lines = log.lines().skip_while(|line| !line.trim_start().starts_with(heading));
    let wall = lines.next().and_then(|line| between(line, "(", " seconds)"));
    let cpu = lines.next().and_then(|line| between(line, "with ", " CPU-seconds"));
    let (wall, cpu) = wall.zip(cpu).with_context(|| {
        format!("{PROGRAM}: needed \"{heading} … (… seconds)\" in its output, found none")
    })?;
    Ok((1e3 * wall, 1e3 * cpu))
}

fn between(line: &str, before: &str, after: &str) -> Option<f64> {
    line.split_once(before)?.1.split_once(after)?.0.trim().parse().ok()
}

/// The last line of its output, from its error on where it names one.
fn complaint(log: &str) -> &str {
    let log = log.trim();
    let start = log.rfind("Error").or_else(|| log.rfind('\n')).unwrap_or(0);
    log[start..].trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_survive_two_channels() {
        let range = 7.5;
        for step in 0..100_000 {
            let depth = range * (f64::from(step) + 0.37) / 100_000.0;
            let channel = |share: f64| (share * 65_535.0).round() as u16;
            let (coarse, fine) = (depth / range, (depth / range * PERIODS).fract());
            let color = Rgb([channel(coarse), channel(fine), u16::MAX]);
            let found = depth_of(color, range).expect("blue");
            // Half a step of the fine channel.
            assert!((found - depth).abs() <= range / PERIODS / 65_535.0, "{depth} {found}");
        }
        assert_eq!(depth_of(Rgb([9, 9, 0]), range), None);
    }

    #[test]
    fn its_clocks_are_read() {
        let log = "  Parse Time:       0 hours  0 minutes  0 seconds (0.028 seconds)\n\
                   \x20             using 1 thread(s) with 0.025 CPU-seconds total\n\
                   Render Time:\n\
                   \x20 Trace Time:       0 hours  1 minutes  5 seconds (65.714 seconds)\n\
                   \x20             using 2 thread(s) with 125.500 CPU-seconds total\n";
        assert_eq!(clocks(log, "Parse Time:").expect("there"), (28.0, 25.0));
        assert_eq!(clocks(log, "Trace Time:").expect("there"), (65_714.0, 125_500.0));
        assert!(clocks("Trace Time: none", "Trace Time:").is_err());
    }

    #[test]
    fn its_complaints_are_passed_on() {
        let log = "Parsing\nFile 'scene.pov' line 2: Parse Error: Expected 'x'.\nRender failed\n";
        assert_eq!(complaint(log), "Error: Expected 'x'.\nRender failed");
        assert_eq!((complaint("one\nlast\n"), complaint("")), ("last", ""));
    }
}
