//! `chart.html`: the charts for a person to read. One file that needs no other, and no network.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::frontier::frontier;
use super::plan::Purpose;
use super::record::{Chart, Group};
use super::settings;
use super::shortlist;
use crate::conclusions::conclusions;
use crate::html::escape;
use crate::page::{self, adapter_facts, conclusion_paragraphs, fact, remark_paragraphs, run_facts};
use crate::plot::{Axis, Kind, Mark, Plot, Scale, Series, Style};
use harness::configuration::label;
use harness::machine::has_little_raster;
use harness::methods::{find, methods};
use harness::numbers::{decimal, grouped, small};
use harness::record::{Measured, Record};
use harness::stats::exponent;

/// The page.
pub(super) fn page(chart: &Chart) -> String {
    let records = chart.groups.iter().flat_map(|group| &group.records);
    let facts = run_facts(&chart.provenance)
        + &adapter_facts(records)
        + &fact("Picture", &format!("{} × {} pixels", chart.width, chart.height));
    let mut remarks = chart.remarks.clone();
    if has_little_raster(&chart.adapter.name) {
        remarks.push(LITTLE_RASTER.to_owned());
    }
    if let Some(moved) = &chart.moved {
        remarks.push(moved.to_string());
    }
    let sentences = conclusion_paragraphs(&conclusions(&chart.error_records()));
    let errors = of(chart, &Purpose::Error).map(error_section).collect();
    let parts = [
        ("conclusions", sentences),
        ("facts", facts),
        ("remarks", remark_paragraphs(&remarks)),
        ("errors", errors),
        ("growth", growth_sections(chart)),
        ("density", density_section(chart)),
        ("depth", depth_section(chart)),
        ("claim", claim_section(chart)),
        ("settings", settings_section(chart)),
        ("shortlist", shortlist_section(chart)),
    ];
    page::page("Error against time", include_str!("page.html"), &parts)
}

const LITTLE_RASTER: &str = "This chip computes and hardly rasterises: the times of depth peeling and \
    of rasterised fragment lists (kanamori, kanamori-robust, illes and its variants but \
    illes-compute) measure the chip more than the method.";

fn of<'a>(chart: &'a Chart, purpose: &Purpose) -> impl Iterator<Item = &'a Group> {
    chart.groups.iter().filter(move |group| group.purpose == *purpose)
}

/// A quantity of a result.
type Quantity = fn(&Measured) -> f64;

/// The distance that one hit in a hundred is further off; no hits have no error.
fn distance_error(measured: &Measured) -> f64 {
    measured.accuracy.t_error_over_radius.map_or(0.0, |error| error.p99)
}

/// Wrong verdicts in a million rays.
fn wrong_per_million(measured: &Measured) -> f64 {
    let accuracy = &measured.accuracy;
    1e6 * accuracy.wrong_verdicts() as f64 / accuracy.rays.max(1) as f64
}

fn error_section(group: &Group) -> String {
    let about = format!(
        "{} balls; {} other supports hold a ball's centre, {} meet a ray.",
        grouped(group.balls),
        decimal(group.density),
        decimal(group.supports_per_ray)
    );
    let plots = error_plot(group, "|Δt|/R, 99 %", distance_error)
        + &error_plot(group, "wrong rays in a million", wrong_per_million);
    section(
        &group.spec,
        &format!(
            "<p>{about}</p>\n{}{plots}{}",
            remark_paragraphs(&group.remarks),
            missing(&[group])
        ),
    )
}

/// All configurations of a scene, joined along each option.
fn error_plot(group: &Group, quantity: &str, error: Quantity) -> String {
    let mut series = Vec::new();
    for (index, method) in methods().iter().enumerate() {
        let records: Vec<_> = group
            .records
            .iter()
            .filter(|record| record.method == method.name)
            .filter_map(|record| Some((record, record.measured.as_ref()?)))
            .collect();
        let plain =
            |name: String, joined, marks| Series { name, style: Style(index), joined, marks };
        let name = format!("{} ({})", method.title, method.name);
        let mut options: Vec<_> =
            records.iter().flat_map(|(record, _)| record.options.keys()).collect();
        options.sort_unstable();
        options.dedup();
        for option in options {
            // Of several options no curve tells.
            let on_curve = |record: &Record| match record.options.len() {
                0 => true,
                1 => record.options.contains_key(option),
                _ => false,
            };
            let mut marks: Vec<_> = records
                .iter()
                .filter(|(record, _)| on_curve(record))
                .map(|(record, measured)| mark(record, measured, error))
                .collect();
            marks.sort_by(|a, b| a.x.total_cmp(&b.x));
            series.push(plain(name.clone(), true, marks));
        }
        let joint = records.iter().filter(|(record, _)| record.options.len() > 1);
        let joint: Vec<_> = joint.map(|(record, measured)| mark(record, measured, error)).collect();
        if !joint.is_empty() {
            series.push(plain(name.clone(), false, joint));
        }
        for (record, measured) in records.iter().filter(|(record, _)| record.options.is_empty()) {
            let preset = mark(record, measured, error);
            let build = Mark {
                x: measured.build_ms,
                kind: Kind::Hollow,
                text: format!("{}: built in {} ms", record.method, decimal(measured.build_ms)),
                ..preset.clone()
            };
            // A renderer that builds nothing has no mark on a logarithmic axis.
            let marks = if measured.build_ms > 0.0 { vec![build, preset] } else { vec![preset] };
            series.push(plain(name.clone(), false, marks));
        }
    }
    let points: Vec<_> = group
        .records
        .iter()
        .filter_map(|record| record.measured.as_ref())
        .map(|measured| (measured.frame_ms.median, error(measured)))
        .collect();
    let plot = Plot {
        x: log_axis("frame time, ms (hollow: build time)"),
        y: log_axis(quantity),
        series,
        staircase: frontier(&points),
    };
    plot.svg()
}

fn mark(record: &Record, measured: &Measured, error: Quantity) -> Mark {
    let frame = &measured.frame_ms;
    let kind = if measured.fallback_pixels > 0 {
        Kind::Flagged
    } else if record.options.is_empty() {
        Kind::Preset
    } else {
        Kind::Plain
    };
    let fallback = match measured.fallback_pixels {
        0 => String::new(),
        pixels => format!(", {} fallback pixels", grouped(pixels as usize)),
    };
    let text = format!(
        "{}: {} ms ({} to {}), |Δt|/R {}, {} wrong in a million{fallback}",
        label(&record.method, &record.options),
        decimal(frame.median),
        decimal(frame.p25),
        decimal(frame.p75),
        small(distance_error(measured)),
        decimal(wrong_per_million(measured)),
    );
    Mark { x: frame.median, y: error(measured), kind, text }
}

/// What has no point in some of the groups, and why.
fn missing(groups: &[&Group]) -> String {
    let mut by_reason = BTreeMap::<String, BTreeSet<String>>::new();
    for record in groups.iter().flat_map(|group| &group.records) {
        if record.measured.is_none() {
            let reason = record.reason.as_deref().unwrap_or("no result");
            let reason = format!("{}: {reason}", record.status);
            by_reason.entry(reason).or_default().insert(label(&record.method, &record.options));
        }
    }
    let line = |(reason, configurations): (&String, &BTreeSet<String>)| {
        let configurations =
            configurations.iter().map(String::as_str).collect::<Vec<_>>().join("; ");
        format!("<li>✕ {} – {}</li>\n", escape(&configurations), escape(reason))
    };
    let lines: String = by_reason.iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("<ul>\n{lines}</ul>\n") }
}

fn growth_sections(chart: &Chart) -> String {
    let mut families: Vec<&str> = chart
        .groups
        .iter()
        .filter_map(|group| match &group.purpose {
            Purpose::Growth(family) => Some(family.as_str()),
            _ => None,
        })
        .collect();
    families.dedup();
    let section_of = |family: &&str| {
        let groups: Vec<_> = of(chart, &Purpose::Growth((*family).to_owned())).collect();
        let balls = |group: &Group| group.balls as f64;
        let quantities: [(&str, Quantity); 3] = [
            ("frame time, ms", |measured| measured.frame_ms.median),
            ("build time, ms", |measured| measured.build_ms),
            ("bytes held", |measured| measured.device_bytes as f64),
        ];
        let plots: String = quantities
            .iter()
            .map(|&(name, quantity)| row_plot(&groups, "balls", balls, name, quantity))
            .collect();
        let body = exponents(&groups, &quantities) + &plots + &missing(&groups);
        section(&format!("More balls: {family}"), &body)
    };
    families.iter().map(section_of).collect()
}

/// The exponents with which quantities grow with the number of balls.
fn exponents(groups: &[&Group], quantities: &[(&str, Quantity)]) -> String {
    let headings: String =
        quantities.iter().map(|(name, _)| format!("<th>{}</th>", escape(name))).collect();
    let row = |name: &str| {
        let cell = |&(_, quantity): &(&str, Quantity)| {
            let points: Vec<_> = measured_of(groups, name)
                .map(|(group, measured)| (group.balls as f64, quantity(measured)))
                .collect();
            let text = exponent(&points).map_or_else(|| "–".to_owned(), |p| format!("{p:.2}"));
            format!("<td>{text}</td>")
        };
        let cells: String = quantities.iter().map(cell).collect();
        format!("<tr><td class=\"text\">{}</td>{cells}</tr>\n", escape(name))
    };
    let rows: String = names(groups).into_iter().map(row).collect();
    format!(
        "<p>Exponents p of growth as Nᵖ, by least squares over all points.</p>\n<div \
         class=\"scroll\"><table><thead><tr><th class=\"text\">Method</th>{headings}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn density_section(chart: &Chart) -> String {
    let groups: Vec<_> = of(chart, &Purpose::Density).collect();
    if groups.is_empty() {
        return String::new();
    }
    let density = |group: &Group| group.density;
    let quantities: [(&str, Quantity); 2] = [
        ("frame time, ms", |measured| measured.frame_ms.median),
        ("bytes held", |measured| measured.device_bytes as f64),
    ];
    let plots: String = quantities
        .iter()
        .map(|&(name, quantity)| row_plot(&groups, "overlapping balls", density, name, quantity))
        .collect();
    let missing = missing(&groups);
    let about = "<p>One camera and count of balls; radii grow, and the threshold keeps the share of \
                 pixels that hit.</p>\n";
    section("Denser balls", &format!("{about}{}{plots}{missing}", spreads(&groups)))
}

/// How much a method's frame time varies over a row.
fn spreads(groups: &[&Group]) -> String {
    let row = |name: &str| {
        let times = || measured_of(groups, name).map(|(_, measured)| measured.frame_ms.median);
        let (least, most) =
            (times().fold(f64::INFINITY, f64::min), times().fold(0.0_f64, f64::max));
        let count = times().count();
        format!(
            "<tr><td class=\"text\">{}</td><td>{}</td><td>{}</td><td>{count} of {}</td></tr>\n",
            escape(name),
            decimal(least),
            decimal(most / least),
            groups.len()
        )
    };
    let rows: String = names(groups)
        .into_iter()
        .filter(|name| measured_of(groups, name).next().is_some())
        .map(row)
        .collect();
    format!(
        "<div class=\"scroll\"><table><thead><tr><th class=\"text\">Method</th><th>Fastest \
         frame<small>ms</small></th><th>Slowest<small>over fastest</small></th><th>Scenes\
         <small>measured</small></th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn depth_section(chart: &Chart) -> String {
    let mut groups: Vec<_> = chart.groups.iter().collect();
    groups.sort_by(|a, b| a.supports_per_ray.total_cmp(&b.supports_per_ray));
    let series = methods().iter().enumerate().map(|(index, method)| Series {
        name: format!("{} ({})", method.title, method.name),
        style: Style(index),
        joined: false,
        marks: measured_of(&groups, method.name)
            .map(|(group, measured)| Mark {
                x: group.supports_per_ray,
                y: measured.frame_ms.median,
                kind: Kind::Plain,
                text: format!(
                    "{}, {}: {} ms",
                    group.spec,
                    method.name,
                    decimal(measured.frame_ms.median)
                ),
            })
            .collect(),
    });
    let plot = Plot {
        x: log_axis("supports that meet a ray, mean"),
        y: log_axis("frame time, ms"),
        series: series.filter(|series| !series.marks.is_empty()).collect(),
        staircase: Vec::new(),
    };
    let about = "<p>All scenes above, each method's preset.</p>\n";
    section("Depth complexity", &format!("{about}{}", plot.svg()))
}

/// Gourmel et al. 2010, section 6: as a ray caster, the Fitted BVH takes some 30 % longer than
/// Kanamori's method.
fn claim_section(chart: &Chart) -> String {
    let row = |group: &&Group| {
        let ms = |name| {
            let groups = [*group];
            measured_of(&groups, name).next().map(|(_, measured)| measured.frame_ms.median)
        };
        let (fitted, peeled) = (ms("fbvh")?, ms("kanamori")?);
        Some(format!(
            "<tr><td class=\"text\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>1.3</td></tr>\n",
            escape(&group.spec),
            decimal(fitted),
            decimal(peeled),
            decimal(fitted / peeled)
        ))
    };
    let groups: Vec<_> = chart.groups.iter().collect();
    let rows: String = groups.iter().filter_map(row).collect();
    let caveat = if has_little_raster(&chart.adapter.name) { LITTLE_RASTER } else { "" };
    let body = format!(
        "<p>Gourmel et al. 2010 put the Fitted BVH at about 1.3 times the frame time of Kanamori's \
         method, for primary rays with equal kernel, radius and resolution. {caveat}</p>\n<div \
         class=\"scroll\"><table><thead><tr><th class=\"text\">Scene</th><th>fbvh<small>ms</small></th>\
         <th>kanamori<small>ms</small></th><th>Ratio</th><th>Claimed</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    );
    section("A claim put to the test", &body)
}

/// The quickest setting of each method, and the quickest that is no more wrong than the preset.
fn settings_section(chart: &Chart) -> String {
    let rows = settings::rows(&chart.groups);
    let cells = |setting: settings::Setting<'_>, flag: &str| {
        format!(
            "<td class=\"text\">{}</td><td>{}</td><td>{}{flag}</td>",
            escape(&label(&setting.record.method, &setting.record.options)),
            decimal(setting.ms),
            setting.wrong
        )
    };
    let line = |row: &settings::Row<'_>| {
        let flag = if row.buys_speed_with_verdicts() { " ✗" } else { "" };
        format!(
            "<tr><td class=\"text\">{}</td>{}{}{}</tr>\n",
            escape(row.scene),
            cells(row.preset, ""),
            cells(row.quickest_as_right, ""),
            cells(row.quickest, flag)
        )
    };
    let lines: String = rows.iter().map(line).collect();
    let heading = "<th class=\"text\">{}</th><th>ms</th><th>Wrong</th>";
    let headings = ["Preset", "Quickest that is as right", "Quickest of all"]
        .map(|name| heading.replace("{}", name))
        .concat();
    let body = format!(
        "<p>Each method with its knobs: its preset, the quickest setting that is wrong or open on no more \
         rays than the preset, and the quickest of all; ✗ marks speed that was bought with wrong \
         verdicts. Knobs of the published trees that interact (tolerance, leaf size, traversal cost, \
         halving without bins, boxes, discarding) were turned together, in every combination.</p>\n<div \
         class=\"scroll\"><table><thead><tr><th class=\"text\">Scene</th>{headings}</tr></thead>\n<tbody>\n\
         {lines}</tbody></table></div>\n"
    );
    if rows.is_empty() { String::new() } else { section("The quickest settings", &body) }
}

/// The quickest of `auto`'s candidates beside the quickest of all configurations.
fn shortlist_section(chart: &Chart) -> String {
    let rows = shortlist::rows(&chart.groups);
    let name = |record: &Record| escape(&label(&record.method, &record.options));
    let line = |row: &shortlist::Row<'_>| {
        let listed = row.listed.map_or_else(
            || "<td class=\"text\">none</td><td></td>".to_owned(),
            |(record, ms)| {
                format!("<td class=\"text\">{}</td><td>{}</td>", name(record), decimal(ms))
            },
        );
        let ratio = row.ratio().map_or_else(|| "–".to_owned(), decimal);
        format!(
            "<tr><td class=\"text\">{}</td><td>{}</td>{listed}<td class=\"text\">{}</td><td>{}</td>\
             <td>{ratio}</td></tr>\n",
            escape(row.scene),
            small(row.max_error),
            name(row.best.0),
            decimal(row.best.1)
        )
    };
    let lines: String = rows.iter().map(line).collect();
    let body = format!(
        "<p>The method <code>auto</code> chooses from a short list. Here is the quickest on that list \
         beside the quickest of all configurations above, both with 99 of 100 hits within the error and at \
         most one wrong or open verdict in 100,000 rays, by the records of this chart.</p>\n<div \
         class=\"scroll\"><table><thead><tr><th class=\"text\">Scene</th><th>Error<small>|Δt|/R</small>\
         </th><th class=\"text\">Listed</th><th>ms</th><th class=\"text\">Of all</th><th>ms</th>\
         <th>Ratio</th></tr></thead>\n<tbody>\n{lines}</tbody></table></div>\n"
    );
    if rows.is_empty() {
        String::new()
    } else {
        section("What the short list of auto costs", &body)
    }
}

/// One line for each method's preset over a row of scenes.
fn row_plot(
    groups: &[&Group],
    x_name: &str,
    x: fn(&Group) -> f64,
    y_name: &str,
    y: Quantity,
) -> String {
    let line = |name: &str| {
        let index = methods().iter().position(|method| method.name == name).unwrap_or(0);
        let marks = measured_of(groups, name)
            .filter(|(_, measured)| y(measured) > 0.0)
            .map(|(group, measured)| Mark {
                x: x(group),
                y: y(measured),
                kind: if measured.fallback_pixels > 0 { Kind::Flagged } else { Kind::Plain },
                text: format!("{}, {name}: {}", group.spec, decimal(y(measured))),
            })
            .collect();
        let title = find(name).map_or(name, |method| method.title);
        Series { name: format!("{title} ({name})"), style: Style(index), joined: true, marks }
    };
    let series = names(groups).into_iter().map(line).collect();
    Plot { x: log_axis(x_name), y: log_axis(y_name), series, staircase: Vec::new() }.svg()
}

/// Methods whose preset is in any of the groups, in the order of tables.
fn names(groups: &[&Group]) -> Vec<&'static str> {
    let takes_part = |name: &str| {
        groups.iter().flat_map(|group| &group.records).any(|record| record.method == name)
    };
    methods().iter().map(|method| method.name).filter(|name| takes_part(name)).collect()
}

/// The results of a method's preset.
fn measured_of<'a>(
    groups: &'a [&'a Group],
    name: &'a str,
) -> impl Iterator<Item = (&'a Group, &'a Measured)> {
    groups.iter().flat_map(move |group| {
        let presets = group
            .records
            .iter()
            .filter(move |record| record.method == name && record.options.is_empty());
        presets.filter_map(move |record| Some((*group, record.measured.as_ref()?)))
    })
}

fn log_axis(name: &str) -> Axis {
    Axis { name: name.to_owned(), scale: Scale::Log }
}

fn section(title: &str, body: &str) -> String {
    let mut section = String::new();
    let _ = write!(section, "<section>\n<h2>{}</h2>\n{body}</section>\n", escape(title));
    section
}
