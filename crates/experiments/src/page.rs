//! What all pages have: one file each that needs no other, and no network.

use crate::html::{escape, fill};
use harness::machine::Provenance;
use harness::record::Adapter;
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

/// Where the numbers of a page come from, and what drew.
pub(crate) fn run_facts(provenance: &Provenance, adapter: Option<&Adapter>) -> String {
    let Provenance { command, commit, machine, .. } = provenance;
    let memory = machine.memory_bytes.map_or_else(String::new, |bytes| {
        format!(", {:.0} GiB", bytes as f64 / f64::from(1 << 30))
    });
    let machine = format!("{}, {} cores{memory}; {}", machine.cpu, machine.cores, machine.os);
    let adapter = adapter.map(|Adapter { name, backend, driver, .. }| {
        fact("Adapter", &escape(&format!("{name} ({backend}, {driver})")))
    });
    fact("Command", &format!("<code>{}</code>", escape(command)))
        + &fact("Commit", &format!("<code>{}</code>", escape(commit)))
        + &fact("Machine", &escape(&machine))
        + &adapter.unwrap_or_default()
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
pub(crate) fn software_remark(gpu: &Gpu) -> Option<String> {
    let text = "Drawn on the CPU: these times say nothing of a GPU.";
    gpu.report().is_software().then(|| text.to_owned())
}
