//! The certified tree on the CPU and on the adapter against the oracle, over rays that are hard to answer:
//! a short run of `metaball certify`.

use std::path::PathBuf;

use harness::certify::record::Certificate;
use harness::certify::{Order, run};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;

use super::on_gpu;

/// Rays of the run: every case at its quick values, and some arbitrary scenes.
const RAYS: u64 = 12_000;

pub(super) fn trials() -> Vec<Trial> {
    vec![on_gpu("certify::a_short_run".to_owned(), a_short_run)]
}

fn a_short_run(gpu: &Gpu) -> Result<(), Failed> {
    let out = PathBuf::new();
    let order = Order { rays: RAYS, quick: true, seed: 2, adapter: None, out };
    let certificate = run(&order, Some(gpu), Certificate::fresh(Some(gpu)), |_| Ok(()))?;
    let shortfalls = certificate.shortfalls(RAYS);
    if !shortfalls.is_empty() {
        return Err(format!("{}\n{:#?}", shortfalls.join("; "), certificate.wrong).into());
    }
    Ok(())
}
