//! The command `chart`: error against time of every method and every knob, time and memory against
//! the number of balls, time against density and depth complexity.

mod coverage;
mod frontier;
mod moved;
mod page;
pub mod plan;
pub mod record;
mod settings;
mod shortlist;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::Camera;
use metaball_core::gpu::{AdapterChoice, Gpu};

use self::moved::moved;
use self::plan::{Planned, Purpose, plan};
use self::record::{Chart, Group, SCHEMA};
use crate::compare::results;
use crate::conclusions::conclusions;
use crate::console::{self, ProgressBar, note_reasons, open_adapter_if_any};
use crate::extent::Extent;
use crate::outputs::output_files;
use crate::page::cpu_remark;
use crate::shortfall::nothing_done;
use harness::comparison::{self, compare_scene, steps};
use harness::configuration::Configuration;
use harness::machine::Provenance;
use harness::measure::Sampling;
use harness::methods::Method;
use harness::numbers::decimal;
use harness::record::{Adapter, Record, Status};
use harness::record_csv::write_csv;
use picture_files::write_atomically;

/// What to measure.
#[derive(Debug, Clone)]
pub struct Options {
    /// How much.
    pub extent: Extent,
    /// Scenes for error against time, instead of the extent's own.
    pub scenes: Vec<String>,
    /// What is charted: purposes by [name](Purpose::name); all where there are none.
    pub only: Vec<String>,
    /// Timed frames of each method on each scene; `None`: five, or what fits into two seconds.
    pub frames: Option<usize>,
    /// The methods that take part; all where there are none.
    pub methods: Vec<&'static Method>,
    /// Pixels across and down; where it is left open 640 × 480, on an adapter that computes on the
    /// CPU and without an adapter 320 × 240, and 64 × 48 when quick.
    pub size: Option<(u32, u32)>,
    /// What to draw with; `None`: methods that need no adapter, and no others.
    pub adapter: Option<AdapterChoice>,
    /// Folder for `chart.json` and `chart.html`.
    pub out: PathBuf,
    /// Whether to begin anew where an interrupted run left its results.
    pub fresh: bool,
}

impl Options {
    fn takes(&self, purpose: &Purpose) -> bool {
        self.only.is_empty() || self.only.iter().any(|name| name == purpose.name())
    }
}

/// Five frames, or what fits into two seconds.
const FRAMES: Sampling = Sampling { most: 5, enough: Duration::from_secs(2) };

/// A method whose frame took longer than this is not tried on the next, harder scene of its row.
const TIME_LIMIT_MS: f64 = 4_000.0;

/// Measures and writes the file and the page. A run that was interrupted is continued. A method that needs
/// an adapter where there is none is reported and left out.
///
/// # Errors
/// When there is no such adapter, when a file cannot be written or is an input, or when nothing could be
/// measured.
pub fn chart(options: &Options) -> anyhow::Result<()> {
    let names = ["chart.json", "chart.csv", "chart.html"];
    let [path, csv, page] = output_files(&options.out, names, &options.scenes, &[])?;
    let mut plan = plan(options.extent, &options.scenes, &options.methods);
    plan.retain(|planned| options.takes(&planned.purpose));
    let configurations = plan.iter().flat_map(|planned| &planned.configurations);
    let gpu = open_adapter_if_any(options.adapter.as_ref(), configurations)?;
    let gpu = gpu.as_ref();
    let mut chart = Chart::begin(gpu, options);
    let previous = Chart::read(&path)?.filter(|previous| previous.is_like(&chart));
    let mut before = None;
    match previous {
        Some(previous) if previous.complete => before = Some(previous),
        Some(previous)
            if !options.fresh && previous.provenance.commit == chart.provenance.commit =>
        {
            console::note(&format!(
                "continuing {}: {} of {} scenes are done",
                path.display(),
                previous.groups.len(),
                plan.len()
            ));
            chart.groups = previous.groups;
            chart.remarks = previous.remarks;
        }
        _ => {}
    }
    let sampling = options.frames.map_or(FRAMES, Sampling::exactly);
    chart.measure(gpu, &plan, sampling, &path)?;
    chart.complete = true;
    chart.moved = before.map(|before| moved(&before, &chart));
    chart.write(&path)?;
    let records = chart.groups.iter().flat_map(|group| &group.records);
    write_csv(&csv, records)?;
    write_atomically(&page, page::page(&chart).as_bytes())?;

    if !options.only.is_empty() {
        let records = chart.groups.iter().flat_map(|group| group.records.clone());
        console::line(&results(&records.collect::<Vec<_>>()));
    }
    for sentence in conclusions(&chart.error_records()) {
        console::line(&sentence);
    }
    if let Some(moved) = &chart.moved {
        console::line(&moved.to_string());
    }
    note_reasons(chart.groups.iter().flat_map(|group| &group.records));
    console::line(&format!("\n{}", page.display()));
    let mut records = chart.groups.iter().flat_map(|group| &group.records);
    if !records.any(|record| record.status == Status::Ok) {
        let said = "nothing could be measured; the reasons are above";
        let configurations = plan.iter().flat_map(|planned| &planned.configurations);
        return Err(nothing_done(said, (options.adapter.as_ref(), gpu), configurations));
    }
    Ok(())
}

impl Chart {
    fn begin(gpu: Option<&Gpu>, options: &Options) -> Self {
        let size = match options.extent {
            Extent::Quick => (64, 48),
            Extent::Whole if gpu.is_none_or(|gpu| gpu.report().is_software()) => (320, 240),
            Extent::Whole => (640, 480),
        };
        let (width, height) = options.size.unwrap_or(size);
        let mut remarks = Vec::new();
        if options.extent == Extent::Quick {
            remarks.push("Quick: scenes of a few hundred balls.".to_owned());
        }
        remarks.extend(cpu_remark(gpu));
        Self {
            provenance: Provenance::here(SCHEMA),
            adapter: Adapter::of(gpu),
            width,
            height,
            complete: false,
            remarks,
            groups: Vec::new(),
            moved: None,
        }
    }

    /// Measures what is planned and not yet there, and writes the file after each scene.
    fn measure(
        &mut self,
        gpu: Option<&Gpu>,
        plan: &[Planned],
        sampling: Sampling,
        path: &Path,
    ) -> anyhow::Result<()> {
        let options = |planned: &Planned| comparison::Options {
            configurations: planned.configurations.clone(),
            size: (self.width, self.height),
            sampling,
            along_path: false,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: false,
        };
        let options: Vec<_> = plan.iter().map(options).collect();
        let progress = ProgressBar::new(options.iter().map(steps).sum());
        let mut done = 0;
        for (planned, mut options) in plan.iter().zip(options) {
            done += steps(&options);
            if self.groups.iter().any(|group| group.is_of(planned)) {
                progress.skip(done);
            } else {
                progress.stage(format!("{}: loading", planned.spec));
                let too_slow = self.too_slow(planned);
                options
                    .configurations
                    .retain(|configuration| !too_slow.contains_key(configuration.method.name));
                match group(gpu, planned, &options, &progress, &too_slow) {
                    Ok(group) => self.groups.push(group),
                    Err(error) => {
                        let remark = format!("{}: {error:#}", planned.spec);
                        progress.note(&remark);
                        self.remarks.push(remark);
                    }
                }
                self.write(path)?;
                progress.reach(done);
            }
        }
        Ok(())
    }

    /// Methods that were too slow, or gave up, on an easier scene of the same row; with the reason.
    fn too_slow(&self, planned: &Planned) -> BTreeMap<&'static str, String> {
        let mut too_slow = BTreeMap::new();
        if planned.purpose == Purpose::Error {
            return too_slow;
        }
        let row = self.groups.iter().filter(|group| group.purpose == planned.purpose);
        for record in row.flat_map(|group| &group.records) {
            let Some(method) = harness::methods::find(&record.method) else { continue };
            let frame = record.measured.as_ref().map(|measured| measured.frame_ms.median);
            if let Some(frame) = frame.filter(|&frame| frame > TIME_LIMIT_MS) {
                let reason = format!("not run: {} took {} ms", record.scene, decimal(frame));
                too_slow.insert(method.name, reason);
            } else if record.status == Status::Skipped {
                too_slow.insert(method.name, record.reason.clone().unwrap_or_default());
            }
        }
        too_slow
    }
}

fn group(
    gpu: Option<&Gpu>,
    planned: &Planned,
    options: &comparison::Options,
    progress: &ProgressBar,
    too_slow: &BTreeMap<&'static str, String>,
) -> anyhow::Result<Group> {
    let bench = scene(planned)?;
    let compared = compare_scene(gpu, &bench, options, progress)?;
    let mut records = compared.records;
    for configuration in &planned.configurations {
        if let Some(reason) = too_slow.get(configuration.method.name) {
            records.push(skipped(gpu, &bench, options, configuration, reason));
        }
    }
    Ok(Group {
        purpose: planned.purpose.clone(),
        spec: planned.spec.clone(),
        balls: bench.scene.len(),
        density: bench_scenes::mean_overlap(&bench.scene),
        supports_per_ray: coverage::supports_per_ray(&bench.scene, &bench.camera),
        remarks: compared.remarks,
        records,
    })
}

/// The share of pixels that hit at all densities.
const DENSITY_HITS: f64 = 0.3;

/// The scene, with what its purpose changes about it.
fn scene(planned: &Planned) -> anyhow::Result<BenchScene> {
    let bench = load(&planned.spec, &Overrides::default())?;
    if planned.purpose != Purpose::Density {
        return Ok(bench);
    }
    // The centres' cube from where all supports grow out of it and are still seen.
    let centers = bench.scene.supports().iter().map(|support| support.center);
    let cube = centers.fold(metaball_core::Aabb::EMPTY, |cube, center| {
        cube.union(&metaball_core::Aabb { min: center, max: center })
    });
    let camera = Camera::framing(&cube, glam::Vec3::new(0.5, 0.35, 1.0));
    coverage::with_hit_share(bench, camera, DENSITY_HITS)
}

/// The record of a configuration that was not run.
fn skipped(
    gpu: Option<&Gpu>,
    bench: &BenchScene,
    options: &comparison::Options,
    configuration: &Configuration,
    reason: &str,
) -> Record {
    Record {
        scene: bench.name.clone(),
        balls: bench.scene.len(),
        kernel: bench.scene.kernel().to_string(),
        threshold: bench.scene.threshold(),
        method: configuration.method.name.to_owned(),
        options: configuration.options.clone(),
        width: options.size.0,
        height: options.size.1,
        adapter: configuration.drawn_by(gpu),
        status: Status::Skipped,
        reason: Some(reason.to_owned()),
        measured: None,
        scored: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_stands_alone;

    #[test]
    fn a_quick_chart_is_whole_and_resumes() {
        let Some(gpu) = Gpu::for_test() else { return };
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("chart.json");
        let options = Options {
            extent: Extent::Quick,
            scenes: vec!["two-merging".to_owned()],
            only: Vec::new(),
            frames: None,
            methods: Vec::new(),
            size: Some((32, 24)),
            adapter: Some(AdapterChoice::Environment),
            out: folder.path().to_owned(),
            fresh: false,
        };
        let mut plan = plan(Extent::Quick, &options.scenes, &[]);
        plan.truncate(2);
        for planned in &mut plan {
            let kept = ["fbvh", "fbvh, tolerance 1e-2", "illes"];
            planned
                .configurations
                .retain(|configuration| kept.contains(&configuration.to_string().as_str()));
        }
        let mut chart = Chart::begin(Some(&gpu), &options);
        chart.measure(Some(&gpu), &plan[..1], FRAMES, &path).expect("measured");

        // What is there is not measured again, and what is missing is.
        let mut resumed = Chart::read(&path).expect("readable").expect("written");
        assert!(resumed.is_like(&chart) && !resumed.complete);
        let done = resumed.groups.clone();
        resumed.measure(Some(&gpu), &plan, FRAMES, &path).expect("measured");
        assert_eq!((done.len(), resumed.groups.len()), (1, 2));
        assert_eq!(resumed.groups[0], done[0]);
        for group in &resumed.groups {
            assert!(group.supports_per_ray > 0.0, "{}", group.spec);
            assert!(group.records.iter().all(|record| record.measured.is_some()));
        }

        let moved = moved(&resumed, &resumed);
        assert_eq!(
            (moved.points, moved.moved.len()),
            (resumed.groups.iter().map(|group| group.records.len()).sum(), 0)
        );
        resumed.moved = Some(moved);
        let page = page::page(&resumed);
        assert_stands_alone(&page, &["NaN"]);
        assert!(page.matches("<svg").count() >= 4);
    }

    #[test]
    fn without_an_adapter_methods_on_the_cpu_are_charted_and_the_others_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let options = Options {
            extent: Extent::Quick,
            scenes: vec!["two-merging".to_owned()],
            only: vec!["error".to_owned(), "density".to_owned()],
            frames: Some(2),
            methods: ["fbvh", "fbvh-certified-cpu", "kanamori-cpu"].map(known).into(),
            size: Some((32, 24)),
            adapter: None,
            out: folder.path().to_owned(),
            fresh: true,
        };
        chart(&options).expect("charted");
        let chart = Chart::read(&folder.path().join("chart.json")).expect("readable");
        let chart = chart.expect("written");
        assert!(chart.complete && chart.groups.len() > 1);
        assert!(chart.groups.iter().all(|group| group.purpose.name() != "growth"));
        assert_eq!(chart.adapter, Adapter::cpu());
        for record in chart.groups.iter().flat_map(|group| &group.records) {
            assert_eq!(record.measured.is_some(), record.method.ends_with("-cpu"), "{record:?}");
        }
        let page = std::fs::read_to_string(folder.path().join("chart.html")).expect("written");
        assert_stands_alone(&page, &["NaN"]);
        assert!(page.contains("needed a graphics adapter, found none"));
        assert!(page.contains("Bézier clipping on the CPU (kanamori-cpu)"));
    }

    fn known(name: &str) -> &'static Method {
        harness::methods::find(name).expect("listed")
    }

    #[test]
    fn a_method_that_was_too_slow_is_left_out_of_harder_scenes() {
        let Some(gpu) = Gpu::for_test() else { return };
        let options = Options {
            extent: Extent::Quick,
            scenes: Vec::new(),
            only: Vec::new(),
            frames: None,
            methods: Vec::new(),
            size: Some((8, 6)),
            adapter: Some(AdapterChoice::Environment),
            out: PathBuf::new(),
            fresh: true,
        };
        let plan = plan(Extent::Quick, &[], &[]);
        let mut row = plan.iter().filter(|planned| planned.purpose == Purpose::Density);
        let (easy, hard) = (row.next().expect("a row"), row.next().expect("of two"));
        let bench = scene(easy).expect("loads");
        let comparison = comparison::Options {
            configurations: Vec::new(),
            size: (8, 6),
            sampling: FRAMES,
            along_path: false,
            every_pixel: false,
            imported: Vec::new(),
            counts_work: false,
        };
        let record =
            skipped(Some(&gpu), &bench, &comparison, &easy.configurations[0], "not run: too slow");
        let mut chart = Chart::begin(Some(&gpu), &options);
        chart.groups.push(Group {
            purpose: Purpose::Density,
            spec: easy.spec.clone(),
            balls: 1,
            density: 1.0,
            supports_per_ray: 1.0,
            remarks: Vec::new(),
            records: vec![record],
        });
        let too_slow = chart.too_slow(hard);
        assert_eq!(
            too_slow.get(easy.configurations[0].method.name).map(String::as_str),
            Some("not run: too slow")
        );
        assert_eq!(too_slow.len(), 1);
        assert!(chart.too_slow(&plan[0]).is_empty(), "charts of error leave no method out");
    }
}
