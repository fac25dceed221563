//! What all pages have: one file each that needs no other, and no network.

use crate::html::{escape, fill};
use harness::machine::Provenance;
use harness::record::{Adapter, Processor, Record};
use metaball_core::gpu::Gpu;

/// A page. `body` is the template of what is beneath the title, which is HTML as the parts are.
pub(crate) fn page(title: &str, body: &str, parts: &[(&str, String)]) -> String {
    let frame = [
        ("title", title.to_owned()),
        ("style", include_str!("style.css").to_owned()),
        ("body", fill(body, parts)),
    ];
    fill(include_str!("page.html"), &frame)
}

/// The conclusions at the top of a page.
pub(crate) fn conclusion_paragraphs(sentences: &[String]) -> String {
    sentences.iter().map(|text| format!("<p class=\"conclusion\">{}</p>\n", escape(text))).collect()
}

/// Where the numbers of a page come from.
pub(crate) fn run_facts(provenance: &Provenance) -> String {
    let Provenance { command, commit, machine, .. } = provenance;
    let memory = machine.memory_bytes.map_or_else(String::new, |bytes| {
        format!(", {:.0} GiB", bytes as f64 / f64::from(1 << 30))
    });
    let machine = format!("{}, {} cores{memory}; {}", machine.cpu, machine.cores, machine.os);
    fact("Command", &format!("<code>{}</code>", escape(command)))
        + &fact("Commit", &format!("<code>{}</code>", escape(commit)))
        + &fact("Machine", &escape(&machine))
}

/// What drew.
pub(crate) fn adapter_fact(adapter: &Adapter) -> String {
    fact(kind_of(adapter), &escape(&adapter.to_string()))
}

fn kind_of(adapter: &Adapter) -> &'static str {
    match adapter.processor {
        Some(Processor::Cpu) => "CPU",
        Some(Processor::Gpu | Processor::Software) | None => "Adapter",
    }
}

/// What drew, each with its methods among the records.
pub(crate) fn adapter_facts<'a>(records: impl IntoIterator<Item = &'a Record>) -> String {
    let mut methods: Vec<(&Adapter, Vec<&str>)> = Vec::new();
    for record in records.into_iter().filter(|record| record.measured.is_some()) {
        let (adapter, method) = (&record.adapter, record.method.as_str());
        match methods.iter_mut().find(|(known, _)| *known == adapter) {
            Some((_, known)) if known.contains(&method) => {}
            Some((_, known)) => known.push(method),
            None => methods.push((adapter, vec![method])),
        }
    }
    let line = |(adapter, methods): &(&Adapter, Vec<&str>)| {
        fact(kind_of(adapter), &escape(&format!("{adapter}: {}", methods.join(", "))))
    };
    methods.iter().map(line).collect()
}

/// A line of a list of facts; both parts are HTML.
pub(crate) fn fact(term: &str, text: &str) -> String {
    format!("<dt>{term}</dt><dd>{text}</dd>\n")
}

/// What a reader should know first.
pub(crate) fn remark_paragraphs(remarks: &[String]) -> String {
    remarks.iter().map(|text| format!("<p class=\"remark\">{}</p>\n", escape(text))).collect()
}

/// What a reader of times should know where the CPU has drawn.
pub(crate) fn cpu_remark(gpu: Option<&Gpu>) -> Option<String> {
    let text = match gpu {
        None => "Without a graphics adapter: every method that is timed here runs on the CPU.",
        Some(gpu) if gpu.report().is_software() => {
            "This adapter is software: every method here is a program on the CPU, and the times say \
             nothing of a GPU."
        }
        Some(_) => return None,
    };
    Some(text.to_owned())
}
