//! `index.html` of stability: the matrix, and every number behind it.

use std::fmt::Write;

use bench_scenes::Case;

use super::case_result::CaseResult;
use super::outcome::Outcome;
use super::record::{Limit, Stability};
use super::skipping::TIME_LIMIT_S;
use crate::html::escape;
use crate::page::{self, adapter_fact, fact, remark_paragraphs, run_facts};
use harness::configuration::Configuration;
use harness::numbers::{small, tick};
use harness::record::Processor;

/// The page; needs no other file and no network.
pub(super) fn page(
    stability: &Stability,
    cases: &[&Case],
    configurations: &[Configuration],
) -> String {
    let sections: String =
        cases.iter().map(|case| section(stability, case, configurations)).collect();
    let parts = [
        ("facts", facts(stability, configurations)),
        ("remarks", remark_paragraphs(&remarks(stability))),
        ("legend", legend()),
        ("matrix", matrix(stability, cases, configurations)),
        ("cases", sections),
        ("notes", notes(stability)),
    ];
    page::page("Where metaball ray casters fail", include_str!("page.html"), &parts)
}

/// Where it comes from, and what drew.
fn facts(stability: &Stability, configurations: &[Configuration]) -> String {
    let on_cpu: Vec<_> = configurations
        .iter()
        .filter(|configuration| !configuration.needs_adapter())
        .map(|configuration| configuration.name.as_str())
        .collect();
    let on_cpu = if on_cpu.is_empty() || stability.adapter.processor == Some(Processor::Cpu) {
        String::new()
    } else {
        fact("CPU", &escape(&format!("draws for {}", on_cpu.join(", "))))
    };
    run_facts(&stability.provenance) + &adapter_fact(&stability.adapter) + &on_cpu
}

/// How the outcomes compare with the table of stated limits.
fn remarks(stability: &Stability) -> Vec<String> {
    let unexpected: usize = stability.limits.iter().map(|limit| limit.unexpected.len()).sum();
    let mut remarks = Vec::new();
    if unexpected > 0 {
        remarks.push(format!(
            "{unexpected} of {} outcomes are not what the table of stated limits says; they are \
             underlined in the matrix.",
            stability.tried()
        ));
    }
    if !stability.left_out.is_empty() {
        remarks.push(format!(
            "Left out, since they need a graphics adapter and there was none: {}.",
            stability.left_out.join(", ")
        ));
    }
    if stability.of_outcome(Outcome::Untried).next().is_some() {
        remarks.push(format!(
            "A published method that took more than {TIME_LIMIT_S} s at one value of a case is not run \
             at the harder ones: nothing is known there. Methods that promise to be right everywhere \
             always are."
        ));
    }
    remarks
}

/// What each outcome means.
fn meaning(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Right => "every clear ray right, 99 of 100 hits within the method's tolerance",
        Outcome::Coarse => "every clear ray on the right front, but hits beyond the tolerance",
        Outcome::Untried => {
            "not run, since the method took too long at an easier value: nothing is known"
        }
        Outcome::Reported => {
            "not every ray has its own answer, and the method reports it: marked pixels, \
                          or a refusal with its reason"
        }
        Outcome::SilentlyWrong => {
            "rays wrong and not marked, where the method's paper promises nothing"
        }
        Outcome::Broken => "rays wrong and not marked, where the method promises to be right",
    }
}

fn legend() -> String {
    let item = |outcome: Outcome| {
        format!(
            "<li>{}<b>{}</b>: {}</li>\n",
            strip([(outcome, String::new(), false)]),
            outcome.name(),
            meaning(outcome)
        )
    };
    let items: String = Outcome::ALL.into_iter().map(item).collect();
    format!("<ul class=\"key-list\">\n{items}</ul>\n")
}

fn matrix(stability: &Stability, cases: &[&Case], configurations: &[Configuration]) -> String {
    let mut rows = String::new();
    let mut category = None;
    for case in cases {
        if category != Some(case.category) {
            category = Some(case.category);
            let columns = configurations.len() + 1;
            let title = case.category.title();
            let _ =
                writeln!(rows, "<tr><th class=\"subject\" colspan=\"{columns}\">{title}</th></tr>");
        }
        let cells: String = configurations
            .iter()
            .map(|configuration| limit_cell(stability, case, configuration))
            .collect();
        let (name, parameter) = (case.name, escape(case.parameter));
        let _ = writeln!(
            rows,
            "<tr><th><a href=\"#{name}\">{name}</a><small>{parameter}</small></th>{cells}</tr>"
        );
    }
    let counts: String =
        configurations.iter().map(|configuration| held(stability, configuration)).collect();
    format!(
        "<div class=\"scroll\"><table class=\"matrix\">\n<thead><tr><th>Case</th>{}</tr></thead>\n\
         <tbody>\n{rows}</tbody>\n<tfoot><tr><th>right at all values</th>{counts}</tr></tfoot>\n\
         </table></div>\n",
        headings(configurations)
    )
}

fn headings(configurations: &[Configuration]) -> String {
    let heading = |configuration: &Configuration| {
        let class = if configuration.name.contains('+') { " class=\"option\"" } else { "" };
        format!("<th{class} title=\"{}\">{}</th>", configuration.name, escape(&configuration.title))
    };
    configurations.iter().map(heading).collect()
}

/// In how many cases a method is right throughout.
fn held(stability: &Stability, configuration: &Configuration) -> String {
    let of = stability.limits.iter().filter(|limit| limit.method == configuration.name);
    let held = of.clone().filter(|limit| limit.fails_at.is_none()).count();
    format!("<td>{held} of {}</td>", of.count())
}

fn limit_cell(stability: &Stability, case: &Case, configuration: &Configuration) -> String {
    let Some(limit) = stability.limit(case.name, &configuration.name) else {
        return "<td></td>".to_owned();
    };
    let squares = stability.of(case.name, &configuration.name).map(|result| {
        let is_unexpected = limit.unexpected.contains(&result.value);
        (result.outcome, title(result), is_unexpected)
    });
    let (class, text) = from(limit);
    format!("<td class=\"{class}\">{text}{}</td>", strip(squares))
}

/// The first value that is not right.
fn from(limit: &Limit) -> (&'static str, String) {
    limit.fails_at.map_or_else(|| ("all", "all".to_owned()), |value| ("from", tick(value)))
}

/// Width and height of a square, and its distance from the next.
const SQUARE: (f64, f64, f64) = (7.0, 11.0, 8.5);

/// Squares from left to right, distinguished by lightness and by sign. Where one is underlined it is not
/// what was stated.
fn strip(squares: impl IntoIterator<Item = (Outcome, String, bool)>) -> String {
    let (width, height, step) = SQUARE;
    let (mut shapes, mut x) = (String::new(), 0.5);
    for (outcome, title, is_unexpected) in squares {
        let _ = write!(
            shapes,
            "<g><title>{}</title><rect x=\"{x}\" y=\".5\" width=\"{width}\" height=\"{height}\" \
             fill=\"{}\" stroke=\"#57606a\" stroke-width=\".5\"/>{}",
            escape(&title),
            fill_of(outcome),
            sign(outcome, x)
        );
        if is_unexpected {
            let _ = write!(
                shapes,
                "<path d=\"M{x} 14h{width}\" stroke=\"#1b1f24\" stroke-width=\"2\"/>"
            );
        }
        shapes += "</g>";
        x += step;
    }
    format!(
        "<svg class=\"strip\" width=\"{x}\" height=\"15\" viewBox=\"0 0 {x} 15\" role=\"img\" \
         fill=\"none\">{shapes}</svg>"
    )
}

/// Light to dark as outcomes go from good to bad, so that grey prints keep the order; blue, yellow
/// and vermilion are those of Okabe and Ito's palette for all kinds of colour vision.
fn fill_of(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Right => "#e3eff8",
        Outcome::Coarse => "#9cc4e4",
        Outcome::Untried => "#ffffff",
        Outcome::Reported => "#f5d76e",
        Outcome::SilentlyWrong => "#d55e00",
        Outcome::Broken => "#33102f",
    }
}

/// What shows an outcome where there is no colour at all.
fn sign(outcome: Outcome, x: f64) -> String {
    let (path, stroke) = match outcome {
        Outcome::Right => return String::new(),
        Outcome::Coarse => (format!("M{} 6h4", x + 1.5), "#08306b"),
        Outcome::Untried => {
            (format!("M{} 4h1M{} 6h1M{} 8h1", x + 3.0, x + 3.0, x + 3.0), "#57606a")
        }
        Outcome::Reported => (format!("M{} 9.5L{} 2.5", x + 1.0, x + 6.0), "#6b5500"),
        Outcome::SilentlyWrong => (format!("M{} 6h3", x + 2.0), "#fff"),
        Outcome::Broken => (format!("M{x} 3l5 6M{x} 9l5 -6", x = x + 1.0), "#fff"),
    };
    let width = if outcome == Outcome::SilentlyWrong { 3.0 } else { 1.2 };
    format!("<path d=\"{path}\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>")
}

/// A result in words.
fn title(result: &CaseResult) -> String {
    let mut text = format!("{}: {}", tick(result.value), result.outcome.name());
    if let Some(note) = &result.note {
        let _ = write!(text, ": {note}");
    }
    text
}

/// A case with every number.
fn section(stability: &Stability, case: &Case, configurations: &[Configuration]) -> String {
    let Some(first) = configurations.first() else { return String::new() };
    let row = |of_first: &CaseResult| {
        let cells: String = configurations
            .iter()
            .map(|configuration| {
                let mut of_configuration = stability.of(case.name, &configuration.name);
                of_configuration
                    .find(|result| result.value == of_first.value)
                    .map_or_else(|| "<td></td>".to_owned(), value_cell)
            })
            .collect();
        // A method that refuses has judged no ray.
        let judged = stability.results.iter().find(|result| {
            result.case == case.name
                && result.value == of_first.value
                && result.clear + result.ambiguous > 0
        });
        let rays = judged
            .map_or_else(String::new, |result| format!("{} + {}", result.clear, result.ambiguous));
        format!("<tr><th>{}</th><td>{rays}</td>{cells}</tr>\n", tick(of_first.value))
    };
    let rows: String = stability.of(case.name, &first.name).map(row).collect();
    let (name, about, parameter) = (case.name, escape(case.about), escape(case.parameter));
    format!(
        "<section class=\"case\" id=\"{name}\"><h3><code>{name}</code></h3>\n<p>{about} Turned: \
         {parameter}.</p>\n<div class=\"scroll\"><table class=\"values\">\n<thead><tr><th>Value</th>\
         <th>Rays<small>clear + too close</small></th>{}</tr></thead>\n<tbody>\n{rows}</tbody>\n\
         </table></div></section>\n",
        headings(configurations)
    )
}

fn value_cell(result: &CaseResult) -> String {
    let mut parts = Vec::new();
    for (count, name) in [
        (result.broken, "broken"),
        (result.silently_wrong, "silently wrong"),
        (result.reported, "reported"),
    ] {
        if count > 0 {
            parts.push(format!("{count} {name}"));
        }
    }
    if let Some(differing) = result.differing {
        parts.push(format!("{differing} differ"));
    }
    if is_refusal(result) {
        parts.push("refused".to_owned());
    } else if parts.is_empty() {
        parts.push(result.outcome.name().to_owned());
    }
    let error = result.error.map_or_else(String::new, |error| small(error.p99));
    let class = result.outcome.name().replace(' ', "-");
    let title = escape(&title(result));
    format!(
        "<td class=\"{class}\" title=\"{title}\">{}<small>{error}</small></td>",
        parts.join("<br>")
    )
}

/// Whether a method was run and drew nothing.
fn is_refusal(result: &CaseResult) -> bool {
    result.outcome == Outcome::Reported && result.clear + result.ambiguous == 0
}

/// The reasons of refusals, and of what was not run, each once.
fn notes(stability: &Stability) -> String {
    let list = |title: &str,
                results: &mut dyn Iterator<Item = &CaseResult>,
                who: fn(&CaseResult) -> String| {
        let mut reasons: Vec<_> = results
            .filter_map(|result| Some(format!("{}: {}", who(result), result.note.as_ref()?)))
            .collect();
        reasons.dedup();
        let items: String =
            reasons.iter().map(|reason| format!("<li>{}</li>\n", escape(reason))).collect();
        if items.is_empty() { items } else { format!("<h2>{title}</h2>\n<ul>\n{items}</ul>\n") }
    };
    let mut refused = stability.results.iter().filter(|result| is_refusal(result));
    let mut untried = stability.of_outcome(Outcome::Untried);
    let where_not = |result: &CaseResult| {
        format!("{} = {}, {}", result.case, tick(result.value), result.method)
    };
    list("Refusals", &mut refused, |result| result.case.clone())
        + &list("Not run", &mut untried, where_not)
}
