//! `index.html`: what a person looks at. One file that needs no other, and no network.

use std::fmt::Write;
use std::path::Path;

use crate::contest::{Contest, Pictures};
use crate::heat::{AMBIGUOUS, ERROR_RANGE, MISS, NOT_COMPARED, SCALE, UNDECIDED, WRONG};
use crate::methods;
use crate::output::write_atomically;
use crate::record::{Measured, Record, Records};

/// Writes the page about contests and their records.
///
/// # Errors
/// When the file cannot be written.
pub fn write_report(
    path: &Path,
    records: &Records,
    contests: &[Contest],
    remarks: &[String],
) -> anyhow::Result<()> {
    write_atomically(path, page(records, contests, remarks).as_bytes())
}

/// The page. `remarks` are about the whole run.
fn page(records: &Records, contests: &[Contest], remarks: &[String]) -> String {
    let rows: String = contests.iter().map(table_rows).collect();
    let scenes: String = contests.iter().map(scene_section).collect();
    let parts = [
        ("facts", facts(records)),
        ("remarks", remark_paragraphs(remarks)),
        ("rows", rows),
        ("scenes", scenes),
    ];
    fill(include_str!("report.html"), &parts)
}

/// Replaces each `{{name}}` of the template once, without looking into what was put in.
fn fill(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        page.push_str(before);
        if let Some((_, text)) = parts.iter().find(|(part, _)| *part == name) {
            page.push_str(text);
        }
        rest = after;
    }
    page + rest
}

fn facts(records: &Records) -> String {
    let machine = &records.machine;
    let memory = machine.memory_bytes.map_or_else(String::new, |bytes| {
        format!(", {:.0} GiB", bytes as f64 / f64::from(1 << 30))
    });
    let mut facts = vec![
        ("Command", format!("<code>{}</code>", escape(&records.command))),
        ("Commit", format!("<code>{}</code>", escape(&records.commit))),
        (
            "Machine",
            escape(&format!("{}, {} cores{memory}; {}", machine.cpu, machine.cores, machine.os)),
        ),
    ];
    if let Some(record) = records.records.first() {
        let adapter = &record.adapter;
        facts.push((
            "Adapter",
            escape(&format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver)),
        ));
        facts.push(("Picture", format!("{} × {} pixels", record.width, record.height)));
    }
    let fact = |(term, text): &(&str, String)| format!("<dt>{term}</dt><dd>{text}</dd>\n");
    facts.iter().map(fact).collect()
}

fn remark_paragraphs(remarks: &[String]) -> String {
    remarks.iter().map(|text| format!("<p class=\"remark\">{}</p>\n", escape(text))).collect()
}

fn table_rows(contest: &Contest) -> String {
    let mut rows = String::new();
    for (index, record) in contest.records.iter().enumerate() {
        let class = if index == 0 { " class=\"first\"" } else { "" };
        let _ = write!(
            rows,
            "<tr{class}><td class=\"text\">{}</td><td>{}</td><td class=\"text\">{}</td>",
            escape(&record.scene),
            grouped(record.balls),
            escape(&record.method)
        );
        match &record.measured {
            Some(measured) => rows.push_str(&measured_cells(measured)),
            None => {
                let reason = record.reason.as_deref().unwrap_or("no result");
                let _ = write!(
                    rows,
                    "<td class=\"reason\" colspan=\"11\">{}: {}</td>",
                    status_word(record),
                    escape(reason)
                );
            }
        }
        rows.push_str("</tr>\n");
    }
    rows
}

fn measured_cells(measured: &Measured) -> String {
    let accuracy = &measured.accuracy;
    let frame = &measured.frame_ms;
    let wrong = format!(
        "{} / {} / {}",
        accuracy.false_negative, accuracy.false_positive, accuracy.wrong_front
    );
    let cells = [
        format!("{} ({}–{})", decimal(frame.median), decimal(frame.p25), decimal(frame.p75)),
        decimal(measured.build_ms),
        decimal(measured.device_bytes as f64 / f64::from(1 << 20)),
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
        decimal(measured.work.nodes_per_ray),
        decimal(measured.work.balls_per_ray),
    ];
    let cell = |(index, text): (usize, &String)| {
        let class =
            if index == 4 && accuracy.wrong_verdicts() > 0 { " class=\"wrong\"" } else { "" };
        format!("<td{class}>{text}</td>")
    };
    cells.iter().enumerate().map(cell).collect()
}

fn scene_section(contest: &Contest) -> String {
    let mut section = format!(
        "<section>\n<h2>{}</h2>\n<p>{}</p>\n{}",
        escape(&contest.scene),
        escape(&contest.about),
        remark_paragraphs(&contest.remarks)
    );
    if let Some(reference) = &contest.reference {
        let columns = contest.pictures.len() + 1;
        let shaded = |pictures: &Pictures| {
            figure(&pictures.shaded, &pictures_title(pictures), "its picture")
        };
        let heat = |pictures: &Pictures| {
            figure(&pictures.heat, &pictures_title(pictures), "difference to the reference")
        };
        let _ = write!(
            section,
            "<div class=\"row\" style=\"--columns:{columns}\">\n{}{}</div>\n\
             <div class=\"row\" style=\"--columns:{columns}\">\n{}{}</div>\n",
            figure(reference, "Reference", "exact, computed in f64"),
            contest.pictures.iter().map(shaded).collect::<String>(),
            legend(),
            contest.pictures.iter().map(heat).collect::<String>(),
        );
    }
    section + "</section>\n"
}

fn pictures_title(pictures: &Pictures) -> String {
    methods::find(pictures.method)
        .map_or_else(|| pictures.method.to_owned(), |method| method.title.to_owned())
}

fn figure(png: &[u8], title: &str, what: &str) -> String {
    let title = escape(title);
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
        key(WRONG, "wrong verdict, drawn three pixels wide"),
        key(UNDECIDED, "the method could not tell"),
        key(AMBIGUOUS, "too close to call for the reference"),
        key(MISS, "both miss"),
        key(NOT_COMPARED, "not compared"),
    )
}

fn css([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn status_word(record: &Record) -> &'static str {
    use crate::record::Status;
    match record.status {
        Status::Ok => "ok",
        Status::Incomplete => "incomplete",
        Status::Unsupported => "unsupported",
    }
}

fn dash() -> String {
    "–".to_owned()
}

/// Three digits of a quantity of everyday size.
pub(crate) fn decimal(value: f64) -> String {
    match value.abs() {
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        size if size >= 0.01 || size == 0.0 => format!("{value:.2}"),
        _ => small(value),
    }
}

/// Two digits of an error.
pub(crate) fn small(value: f64) -> String {
    if value == 0.0 || !value.is_finite() { format!("{value}") } else { format!("{value:.1e}") }
}

/// A count with its thousands apart.
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Text as HTML shows it, also between quotation marks.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Base64 of RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |index: usize| u32::from(chunk.get(index).copied().unwrap_or(0));
        let group = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = ALPHABET[(group >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Machine;

    #[test]
    fn html_is_escaped() {
        assert_eq!(
            escape("<a href='x'>\"&\"</a>"),
            "&lt;a href=&#39;x&#39;&gt;&quot;&amp;&quot;&lt;/a&gt;"
        );
        assert_eq!(escape("r²/R² ≤ 1"), "r²/R² ≤ 1");
    }

    #[test]
    fn base64_is_that_of_the_rfc() {
        let vectors = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, encoded) in vectors {
            assert_eq!(base64(plain.as_bytes()), encoded);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [decimal(1234.5), decimal(12.34), decimal(0.5), decimal(0.0)],
            ["1234", "12.3", "0.50", "0.00"]
        );
        assert_eq!([small(1.234e-6), small(0.0), small(f64::INFINITY)], ["1.2e-6", "0", "inf"]);
        assert_eq!([grouped(0), grouped(999), grouped(307_200)], ["0", "999", "307\u{202f}200"]);
    }

    #[test]
    fn a_page_needs_nothing_else_and_trusts_no_name() {
        let records = Records {
            schema: crate::record::SCHEMA.to_owned(),
            command: "metaball compare '<script>'".to_owned(),
            commit: "unknown".to_owned(),
            machine: Machine {
                cpu: "c".into(),
                cores: 1,
                memory_bytes: Some(1 << 30),
                os: "o".into(),
            },
            records: Vec::new(),
        };
        let contest = Contest {
            scene: "{{facts}}<b>".to_owned(),
            about: "<i>".to_owned(),
            records: Vec::new(),
            reference: Some(vec![1, 2, 3]),
            pictures: vec![Pictures { method: "bvh", shaded: vec![4], heat: vec![5] }],
            remarks: vec!["<u>".to_owned()],
        };
        let page = page(&records, &[contest], &["R < 1".to_owned()]);
        for forbidden in ["<script", "<b>", "<i>", "<u>", "http", "src=\"/", "url("] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        for needed in ["{{facts}}&lt;b&gt;", "data:image/png;base64,AQID", "R &lt; 1", "</html>"] {
            assert!(page.contains(needed), "{needed}");
        }
        assert_eq!(page.matches("<figure>").count(), 3);
    }
}
