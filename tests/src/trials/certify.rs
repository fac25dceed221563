//! The certified tree on the CPU and on the adapter against the oracle, over rays that are hard to answer:
//! a short run of `metaball certify`.

use std::path::PathBuf;

use experiments::certify::record::Certificate;
use experiments::certify::{Options, run};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;

use super::on_gpu;

/// Rays that the run may end after: it does not before every case has been tried at its quick values, and
/// pipelines for arbitrary scenes would take longer to make than all the rays to answer.
const RAYS: u64 = 1;

pub(super) fn trials() -> Vec<Trial> {
    vec![on_gpu("certify::a_short_run".to_owned(), a_short_run)]
}

fn a_short_run(gpu: &Gpu) -> Result<(), Failed> {
    let out = PathBuf::new();
    let options = Options { rays: RAYS, time: None, quick: true, seed: 1, adapter: None, out };
    let certificate = run(&options, Some(gpu), Certificate::fresh(Some(gpu)), |_| Ok(()))?;
    let shortfalls = certificate.shortfalls(RAYS);
    if !shortfalls.is_empty() {
        return Err(format!("{}\n{:#?}", shortfalls.join("; "), certificate.wrong).into());
    }
    Ok(())
}
