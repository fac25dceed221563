//! The command `certify`: the certified tree against the oracle, over as many rays as one has time for.
//!
//! Scenes are every stability case within the stated limits, then arbitrary ones by seed, every fourth with a
//! third of its balls negative. The rays of each are a picture's, others at its balls, along its surface, along
//! the faces of the tree's boxes, and out of the solid. The CPU's tracer answers all of them, the shaders a third
//! where no ball is negative; neither may be wrong on a ray that is clear to the oracle.

pub mod adapter;
pub mod ray_distribution;
pub mod record;
pub mod tally;
pub mod test_scene;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use metaball_core::gpu::{AdapterChoice, Gpu};

use self::adapter::AdapterTracer;
use self::record::{Certificate, DISTANCES, SCALES};
use self::tally::{Category, Count, ErrorClass, Tracer};
use self::test_scene::{TestScene, test_scenes};
use crate::console::{self, ProgressBar, open_adapter, table};
use crate::outputs::output_files;
use crate::shortfall::Shortfall;
use crate::unfinished;
use harness::numbers::{grouped, small};

/// What to hold against the oracle.
#[derive(Debug, Clone)]
pub struct Options {
    /// Different rays, at least.
    pub rays: u64,
    /// Where it ends with fewer, after the scene at hand, and only wrong answers are errors; `None`: nowhere.
    pub time: Option<Duration>,
    /// A few values of each stability case and few rays a scene.
    pub quick: bool,
    /// Where arbitrary scenes begin.
    pub seed: u64,
    /// What runs the shaders; `None` leaves them out.
    pub adapter: Option<AdapterChoice>,
    /// Folder for `certify.json`.
    pub out: PathBuf,
}

impl Options {
    /// Rays of an arbitrary scene.
    fn rays_of_scene(&self) -> usize {
        if self.quick { 1200 } else { 98_304 }
    }

    /// Whether the time is over after so many seconds.
    fn is_over(&self, seconds: f64) -> bool {
        self.time.is_some_and(|time| seconds >= time.as_secs_f64())
    }
}

/// How much work an interruption may lose.
const SECONDS_OF_GROUP: f64 = 10.0;

/// Holds the certified tree against the oracle, prints what was counted and writes it. What an interrupted
/// run of the same command has done is taken over.
///
/// # Errors
/// When there is a shortfall, of which the first wrong answers are printed in full; without the adapter;
/// when the device fails, or a file cannot be written.
pub fn certify(options: &Options) -> anyhow::Result<()> {
    let gpu = options.adapter.as_ref().map(open_adapter).transpose()?;
    let names = ["unfinished.json", "certify.json"];
    let [unfinished_path, path] = output_files(&options.out, names, &[], &[])?;
    let fresh = Certificate::fresh(gpu.as_ref());
    let left = fresh.unfinished(&unfinished_path);
    if left.is_some() {
        console::note("Continuing an interrupted run.");
    }
    let certificate =
        run(options, gpu.as_ref(), left.unwrap_or(fresh), |state| state.write(&unfinished_path))?;

    certificate.write(&path)?;
    unfinished::remove(&unfinished_path);
    console::line(&summary(&certificate));
    console::line(&format!("\n{}", path.display()));
    let shortfalls = match options.is_over(certificate.seconds) {
        true => certificate.wrong_answers(),
        false => certificate.shortfalls(options.rays),
    };
    if !shortfalls.is_empty() {
        return Err(Shortfall(format!("no certificate: {}", shortfalls.join("; "))).into());
    }
    Ok(())
}

/// Continues from a state until there are enough rays; calls `keep` after every group of scenes, and in
/// the end.
///
/// # Errors
/// When a tree cannot be built, the device fails, or the state cannot be kept.
pub fn run(
    options: &Options,
    gpu: Option<&Gpu>,
    mut certificate: Certificate,
    mut keep: impl FnMut(&Certificate) -> anyhow::Result<()>,
) -> anyhow::Result<Certificate> {
    let (mut start, mut tally) = (Instant::now(), certificate.tally());
    let mut adapter = gpu.map(AdapterTracer::new).transpose()?;
    let progress = ProgressBar::new(options.rays);
    progress.reach(certificate.rays);
    for scene in test_scenes(options.seed, options.quick).skip(certificate.test_scenes) {
        if certificate.rays >= options.rays && !matches!(scene, TestScene::Case(..)) {
            break;
        }
        tally.add(scene.check(options.rays_of_scene(), adapter.as_mut())?);
        certificate.take(&tally);
        certificate.test_scenes += 1;
        progress.reach(certificate.rays.min(options.rays));
        let seconds = start.elapsed().as_secs_f64();
        if options.is_over(certificate.seconds + seconds) {
            break;
        }
        if seconds > SECONDS_OF_GROUP {
            let wrong: u64 = certificate.counts.iter().map(|row| row.count.wrong).sum();
            let rays = grouped(certificate.rays as usize);
            progress.stage(format!("{rays} rays, {wrong} wrong"));
            certificate.seconds += seconds;
            start = Instant::now();
            keep(&certificate)?;
        }
    }
    certificate.seconds += start.elapsed().as_secs_f64();
    keep(&certificate)?;
    Ok(certificate)
}

/// Counts, errors and wrong answers as text.
fn summary(certificate: &Certificate) -> String {
    let mut text = counts(certificate);
    for tracer in tracers(certificate) {
        text += &format!("\n\n{}", errors(certificate, tracer));
    }
    let rays = grouped(certificate.rays as usize);
    let near = grouped(certificate.near() as usize);
    text += &format!(
        "\n\n{rays} rays on {} scenes, {near} of them within 1e-3 radii of tangency or a box's face, in \
         {:.0} s",
        certificate.test_scenes, certificate.seconds
    );
    for wrong in certificate.wrong.iter().take(10) {
        let Category { tracer, query, distribution } = wrong.category;
        text += &format!(
            "\n\n{}: {tracer}, {query}: {distribution}\nfrom {:?} towards {:?} up to {:?}\n{}",
            wrong.test_scene, wrong.origin, wrong.direction, wrong.t_max, wrong.account
        );
    }
    text
}

/// Who answered.
fn tracers(certificate: &Certificate) -> impl Iterator<Item = Tracer> {
    let answered = |tracer: &Tracer| certificate.sum(*tracer, |count| count.rays) > 0;
    [Tracer::Cpu, Tracer::Adapter].into_iter().filter(answered)
}

fn counts(certificate: &Certificate) -> String {
    let headings = [
        "queries: rays",
        "rays",
        "near",
        "hits",
        "misses",
        "ambiguous",
        "undecided",
        "clear",
        "wrong",
    ];
    let cells = |name: String, count: Count| {
        let numbers = [
            count.rays,
            count.near,
            count.hits,
            count.misses,
            count.ambiguous,
            count.undecided,
            count.undecided_clear,
            count.wrong,
        ];
        std::iter::once(name).chain(numbers.map(|n| grouped(n as usize))).collect::<Vec<_>>()
    };
    let row = |row: &record::CountRow| {
        let Category { tracer, query, distribution } = row.category;
        cells(format!("{tracer}, {query}: {distribution}"), row.count)
    };
    table(&headings, &certificate.counts.iter().map(row).collect::<Vec<_>>())
}

/// Relative RMS errors of t where they are held: a line for each scale, a column for each distance.
fn errors(certificate: &Certificate, tracer: Tracer) -> String {
    let first = format!("{tracer}: relative RMS error of t; R");
    let headings: Vec<_> = std::iter::once(first)
        .chain(DISTANCES.map(|distance| format!("from 1e{distance} R")))
        .collect();
    let headings: Vec<_> = headings.iter().map(String::as_str).collect();
    let row = |scale: i32| {
        let cell = |distance: i32| {
            let wanted = ErrorClass { tracer, scale, distance };
            let found = certificate.errors.iter().find(|row| row.class == wanted);
            found.map_or_else(String::new, |row| small(row.errors.rms()))
        };
        std::iter::once(format!("1e{scale}")).chain(DISTANCES.map(cell)).collect::<Vec<_>>()
    };
    let held = certificate.held_errors(tracer);
    format!(
        "{}\nall of these: {}, at most {}",
        table(&headings, &SCALES.map(row).collect::<Vec<_>>()),
        small(held.rms()),
        small(held.worst)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(rays: u64) -> Options {
        Options { rays, time: None, quick: true, seed: 1, adapter: None, out: "unused".into() }
    }

    #[test]
    fn a_run_ends_with_its_time_and_is_a_certificate_of_what_it_did() {
        let at_once = Options { time: Some(Duration::ZERO), ..options(12_000) };
        let short = run(&at_once, None, Certificate::fresh(None), |_| Ok(())).expect("run");
        assert_eq!(short.test_scenes, 1);
        assert!(at_once.is_over(short.seconds) && !options(1).is_over(1e9));
    }

    /// The run stops anywhere: here after the cases, before the first arbitrary scene.
    #[test]
    fn a_short_run_is_a_certificate_and_continues_where_it_stopped() {
        let go = |rays, from| run(&options(rays), None, from, |_| Ok(())).expect("run");
        let whole = go(12_000, Certificate::fresh(None));
        assert_eq!(whole.shortfalls(12_000), Vec::<String>::new(), "{}", summary(&whole));
        assert!(summary(&whole).contains("CPU, exit: from inside"));

        let cases = go(1, Certificate::fresh(None));
        assert!(cases.test_scenes < whole.test_scenes);
        let continued = go(12_000, cases);
        let without_time = |certificate| Certificate { seconds: 0.0, ..certificate };
        assert_eq!(without_time(continued), without_time(whole));
    }
}
