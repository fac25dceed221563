//! The head of every file of tables.

use metaball_core::gpu::Gpu;
use serde::{Deserialize, Serialize};

use crate::page::{adapter_fact, remark_paragraphs, run_facts};
use crate::table::Table;
use harness::machine::Provenance;
use harness::record::Adapter;

/// Where the numbers of a file come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    /// Format, command, commit and machine.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What drew; missing where nothing was drawn with an adapter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adapter: Option<Adapter>,
    /// What a reader should know.
    pub remarks: Vec<String>,
}

impl Heading {
    /// Of a file in that format, made by this process.
    pub(super) fn new(schema: &str, gpu: Option<&Gpu>, remarks: Vec<String>) -> Self {
        let adapter = gpu.map(|gpu| Adapter::from(gpu.report()));
        Self { provenance: Provenance::here(schema), adapter, remarks }
    }

    /// The facts at the top of a page: the content of a `<dl>`.
    pub(super) fn facts(&self) -> String {
        let adapter = self.adapter.as_ref().map(adapter_fact);
        run_facts(&self.provenance) + &adapter.unwrap_or_default()
    }

    /// The remarks for a page.
    pub(super) fn remark_paragraphs(&self) -> String {
        remark_paragraphs(&self.remarks)
    }

    /// A table and the remarks for the terminal.
    pub(super) fn text_with_remarks(&self, table: &Table) -> String {
        let remarks = self.remarks.iter().map(|remark| format!("  {remark}"));
        std::iter::once(table.text()).chain(remarks).collect::<Vec<_>>().join("\n")
    }
}
