//! `kanamori.html`: the tables for a person to read.

use super::paper::{ERROR_OF_T, ITERATIVE_ITERATIONS, SHORT_STACK_ITERATIONS};
use super::plan::Part;
use super::run::{GpuRun, Measured, PartResult};
use super::variant::Variant;
use super::{Measurements, table};
use crate::html::{escape, section};
use crate::page::{self, fact, remark_paragraphs};
use crate::plot::line_plot;
use harness::numbers::{decimal, small};

/// The page; needs no other file and no network.
pub(super) fn page(measurements: &Measurements) -> String {
    let (average, most) = SHORT_STACK_ITERATIONS;
    let (before, most_before) = ITERATIVE_ITERATIONS;
    let printed = format!(
        "error of t {ERROR_OF_T}; iterations of a search {average} ({most}), before {before} \
         ({most_before})"
    );
    let facts = measurements.heading.facts() + &fact("The paper's", &printed);
    let scenes = &measurements.scenes;
    let mut remarks = measurements.heading.remarks.clone();
    remarks.extend(replaced_clipping(scenes));
    let tables: String = Part::ALL.iter().map(|&part| table(part, scenes).html()).collect();
    let plots: String = scenes.iter().filter_map(plot).collect();
    let parts = [
        ("facts", facts),
        ("remarks", remark_paragraphs(&remarks)),
        ("tables", tables + &plots + &figure_8(scenes)),
    ];
    page::page(
        "The measurements of Kanamori et al. 2008, repeated",
        include_str!("page.html"),
        &parts,
    )
}

/// Why what section 5.4 replaces takes other iterations than the paper's; `None` where it was not
/// measured.
fn replaced_clipping(scenes: &[PartResult]) -> Option<String> {
    let (average, most) = ITERATIVE_ITERATIONS;
    let taken = |variant: Variant| {
        let runs = scenes.iter().filter_map(|scene| scene.measured.result.as_ref().ok());
        let mut runs = runs.flat_map(|measured| &measured.runs);
        let run = runs.find(|run| run.variant == variant.name())?.result.as_ref().ok()?;
        let (mean, most) = run.iterations;
        Some(format!("{} ({most})", decimal(mean)))
    };
    let iterative = taken(Variant::Iterative)?;
    let original = taken(Variant::Original).map_or_else(String::new, |original| {
        format!(" The original recursion takes {original}; the paper has no number for it.")
    });
    Some(format!(
        "The iterative form takes {iterative} iterations here and {average} ({most}) in the paper, \
         which refers to a program for trimmed NURBS surfaces and says neither on which curves nor \
         what counts as an iteration; ours clips by the hull, keeps one range, and makes what lies \
         behind it again from the whole curve.{original}"
    ))
}

/// Time over error, for a scene of thresholds.
fn plot(scene: &PartResult) -> Option<String> {
    let measured =
        scene.measured.result.as_ref().ok().filter(|_| scene.part == Part::Thresholds)?;
    let runs = measured.runs.iter().filter_map(|run| run.result.as_ref().ok());
    let mut points: Vec<_> = runs
        .filter_map(|run| Some((-run.rel_rms_t?.max(1e-12).log10(), run.frame_ms.median)))
        .collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    let drawn = line_plot(&points, "digits of t: −log₁₀ of its error", "ms a frame");
    Some(format!("<h2>Time against error: {}</h2>\n{drawn}", escape(&scene.measured.scene)))
}

/// Where the time goes: on the CPU between its two phases, on the adapter between the passes.
fn figure_8(scenes: &[PartResult]) -> String {
    let row = |(scene, measured): (&PartResult, &Measured)| {
        let gpu = measured.runs.first()?.result.as_ref().ok()?;
        let cpu = &measured.cpu;
        let (width, height) = scene.measured.size;
        let cells = [
            decimal(cpu.frame_ms.median),
            decimal(100.0 * cpu.traversal_share),
            decimal(100.0 * (1.0 - cpu.traversal_share)),
            format!("{} ({})", decimal(cpu.iterations.0), cpu.iterations.1),
            decimal(gpu.frame_ms.median),
        ];
        let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
        Some(format!(
            "<tr><td class=\"text\">{}</td><td>{width}×{height}</td>{cells}\
             <td class=\"text\">{}</td></tr>\n",
            escape(&scene.measured.scene),
            escape(&passes(gpu))
        ))
    };
    let measured =
        scenes.iter().filter_map(|scene| Some((scene, scene.measured.result.as_ref().ok()?)));
    let body: String = measured.filter_map(row).collect();
    let headings = "<th class=\"text\">Scene</th><th>Picture</th><th>CPU<small>ms</small></th>\
         <th>Traversal<small>%</small></th><th>Isosurface test<small>%</small></th>\
         <th>Iterations<small>mean (most)</small></th><th>GPU<small>ms</small></th>\
         <th class=\"text\">Passes<small>% of their time</small></th>";
    section("Figure 8: where the time goes", headings, &body)
}

/// The passes' shares of their time, the longest first.
fn passes(run: &GpuRun) -> String {
    let total: f64 = run.passes.values().sum();
    let mut passes: Vec<_> = run.passes.iter().collect();
    passes.sort_by(|one, other| other.1.total_cmp(one.1));
    let share = |time: f64| 100.0 * time / total.max(f64::MIN_POSITIVE);
    let shown = passes.iter().filter(|(_, time)| share(**time) >= 1.0);
    let shown: Vec<_> =
        shown.map(|(name, time)| format!("{name} {}", decimal(share(**time)))).collect();
    if shown.is_empty() { small(total) } else { shown.join(", ") }
}
