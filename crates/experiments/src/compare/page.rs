//! `index.html` of `compare`: tables and pictures.

use std::fmt::Write;

use crate::conclusions::conclusions;
use crate::html::{base64, escape};
use crate::page::{self, adapter_facts, conclusion_paragraphs, fact, remark_paragraphs, run_facts};
use harness::comparison::{Pictures, SceneComparison};
use harness::heat::{AMBIGUOUS, ERROR_RANGE, MISS, NOT_COMPARED, SCALE, UNDECIDED, WRONG};
use harness::methods;
use harness::numbers::{decimal, grouped, small};
use harness::record::{Measured, Record, Records};
use harness::score::Accuracy;

/// The page; needs no other file and no network. `remarks` are about the whole run.
pub(super) fn page(records: &Records, scenes: &[SceneComparison], remarks: &[String]) -> String {
    let rows: String = scenes.iter().map(table_rows).collect();
    let sections: String = scenes.iter().map(scene_section).collect();
    let parts = [
        ("conclusions", sentences(scenes)),
        ("facts", facts(records)),
        ("remarks", remark_paragraphs(remarks)),
        ("rows", rows),
        ("scenes", sections),
    ];
    page::page("Metaball ray casters compared", include_str!("page.html"), &parts)
}

/// Which method to use for what.
fn sentences(scenes: &[SceneComparison]) -> String {
    let records: Vec<_> = scenes.iter().map(|scene| scene.records.as_slice()).collect();
    conclusion_paragraphs(&conclusions(&records))
}

fn facts(records: &Records) -> String {
    let first = records.records.first();
    let size = first.map(|record| format!("{} × {} pixels", record.width, record.height));
    run_facts(&records.provenance)
        + &adapter_facts(&records.records)
        + &size.map_or_else(String::new, |size| fact("Picture", &size))
}

fn table_rows(scene: &SceneComparison) -> String {
    let mut rows = String::new();
    for (index, record) in scene.records.iter().enumerate() {
        let class = if index == 0 { " class=\"first\"" } else { "" };
        let _ = write!(
            rows,
            "<tr{class}><td class=\"text\">{}</td><td>{}</td><td class=\"text\">{}</td>\
             <td class=\"text\">{}</td>",
            escape(&record.scene),
            grouped(record.balls),
            escape(&record.method),
            record.measured.as_ref().map_or_else(dash, |_| escape(&record.adapter.short()))
        );
        match &record.measured {
            Some(measured) => rows.push_str(&measured_cells(measured)),
            None if record.scored.is_some() => rows.push_str(&scored_cells(record)),
            None => {
                let reason = record.reason.as_deref().unwrap_or("no result");
                let _ = write!(
                    rows,
                    "<td class=\"reason\" colspan=\"11\">{}: {}</td>",
                    record.status,
                    escape(reason)
                );
            }
        }
        rows.push_str("</tr>\n");
    }
    rows
}

fn measured_cells(measured: &Measured) -> String {
    let frame = &measured.frame_ms;
    let drawing = [
        format!("{} ({}–{})", decimal(frame.median), decimal(frame.p25), decimal(frame.p75)),
        frame.samples.len().to_string(),
        decimal(measured.build_ms),
        decimal(measured.device_bytes as f64 / f64::from(1 << 20)),
    ];
    let work = measured.work.map_or_else(dash, |work| {
        format!("{}, {}", decimal(work.nodes_per_ray), decimal(work.balls_per_ray))
    });
    cells(drawing, &measured.accuracy, work)
}

/// Another program's hits: nothing was drawn here.
fn scored_cells(record: &Record) -> String {
    let accuracy = record.accuracy();
    accuracy.map_or_else(String::new, |of| cells([(); 4].map(|()| dash()), of, dash()))
}

fn cells(drawing: [String; 4], accuracy: &Accuracy, work: String) -> String {
    let wrong = format!(
        "{} / {} / {}",
        accuracy.false_negative, accuracy.false_positive, accuracy.wrong_front
    );
    let compared = [
        grouped(accuracy.rays),
        wrong,
        grouped(accuracy.ambiguous),
        accuracy.rel_rms_t.map_or_else(dash, small),
        accuracy.t_error_over_radius.map_or_else(dash, |error| {
            format!("{}, {}, {}", small(error.p50), small(error.p99), small(error.max))
        }),
        accuracy
            .normal_degrees
            .map_or_else(dash, |error| format!("{}, {}", small(error.mean), small(error.p99))),
    ];
    let cell = |(index, text): (usize, String)| {
        let class =
            if index == 5 && accuracy.wrong_verdicts() > 0 { " class=\"wrong\"" } else { "" };
        format!("<td{class}>{text}</td>")
    };
    drawing.into_iter().chain(compared).chain([work]).enumerate().map(cell).collect()
}

fn scene_section(scene: &SceneComparison) -> String {
    let mut section = format!(
        "<section>\n<h2>{}</h2>\n<p>{}{}</p>\n{}",
        escape(&scene.scene),
        escape(&scene.about),
        scene.records.first().map_or_else(String::new, field_sentence),
        remark_paragraphs(&scene.remarks)
    );
    if let Some(reference) = &scene.reference {
        let shaded = |pictures: &Pictures| {
            figure(&pictures.shaded, title(pictures), &passes(scene, pictures))
        };
        let heat = |pictures: &Pictures| {
            figure(&pictures.heat, title(pictures), "difference to the reference")
        };
        let _ = write!(
            section,
            "<div class=\"scroll\"><div class=\"grid\" style=\"--columns:{}\">\n{}{}{}{}</div></div>\n",
            scene.pictures.len() + 1,
            figure(reference, "Reference", "exact, computed in f64"),
            scene.pictures.iter().map(shaded).collect::<String>(),
            legend(),
            scene.pictures.iter().map(heat).collect::<String>(),
        );
    }
    section + "</section>\n"
}

fn field_sentence(record: &Record) -> String {
    format!(" Kernel {}, T = {}.", escape(&record.kernel), record.threshold)
}

/// What the method's frame spends its time on, longest first.
fn passes(scene: &SceneComparison, pictures: &Pictures) -> String {
    let record = scene.records.iter().find(|record| record.method == pictures.method);
    let Some(measured) = record.and_then(|record| record.measured.as_ref()) else {
        return String::new();
    };
    let mut passes: Vec<_> = measured.passes.iter().collect();
    passes.sort_by(|one, other| other.1.total_cmp(one.1));
    let texts = passes.iter().map(|(label, ms)| format!("{label} {} ms", decimal(**ms)));
    texts.collect::<Vec<_>>().join(", ")
}

fn title(pictures: &Pictures) -> &str {
    methods::find(&pictures.method).map_or(&pictures.method, |method| method.title)
}

fn figure(png: &[u8], title: &str, what: &str) -> String {
    let (title, what) = (escape(title), escape(what));
    format!(
        "<figure><img alt=\"{title}: {what}\" src=\"data:image/png;base64,{}\">\
         <figcaption>{title} <small>{what}</small></figcaption></figure>\n",
        base64(png)
    )
}

fn legend() -> String {
    let stops: Vec<_> = SCALE.iter().map(|&color| css(color)).collect();
    let decades = ERROR_RANGE.0.log10().round() as i32..=ERROR_RANGE.1.log10().round() as i32;
    let ticks: String =
        decades.map(|decade| format!("<span>10<sup>{decade}</sup></span>")).collect();
    let key = |color, text: &str| {
        format!("<li><span class=\"key\" style=\"background:{}\"></span>{text}</li>", css(color))
    };
    format!(
        "<div class=\"legend\">Distance error |Δt|/R\
         <div class=\"bar\" style=\"background:linear-gradient(to right,{})\"></div>\
         <div class=\"ticks\">{ticks}</div><ul>{}{}{}{}{}</ul></div>\n",
        stops.join(","),
        key(WRONG, "wrong verdict, enlarged"),
        key(UNDECIDED, "undecided"),
        key(AMBIGUOUS, "too close to call for the reference"),
        key(MISS, "both miss"),
        key(NOT_COMPARED, "not compared"),
    )
}

fn css([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::machine::Provenance;

    #[test]
    fn a_page_needs_nothing_else_and_trusts_no_name() {
        let records = Records {
            provenance: Provenance {
                command: "metaball compare '<script>'".to_owned(),
                ..Provenance::here(harness::record::SCHEMA)
            },
            records: Vec::new(),
        };
        let scene = SceneComparison {
            scene: "{{facts}}<b>".to_owned(),
            about: "<i>".to_owned(),
            records: Vec::new(),
            reference: Some(vec![1, 2, 3]),
            pictures: vec![Pictures { method: "bvh".to_owned(), shaded: vec![4], heat: vec![5] }],
            remarks: vec!["<u>".to_owned()],
        };
        let page = page(&records, &[scene], &["R < 1".to_owned()]);
        for forbidden in ["<script", "<b>", "<i>", "<u>", "http", "src=\"/", "url("] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        for needed in ["{{facts}}&lt;b&gt;", "data:image/png;base64,AQID", "R &lt; 1", "</html>"] {
            assert!(page.contains(needed), "{needed}");
        }
        assert_eq!(page.matches("<figure>").count(), 3);
    }
}
