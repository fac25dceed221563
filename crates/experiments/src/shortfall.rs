//! A run that came to its end without what it was asked for.

use harness::configuration::Configuration;
use metaball_core::gpu::{AdapterChoice, Gpu, RenderError};
use thiserror::Error;

/// What a run did not show, and why: of what it was given nothing could be measured, or what it holds
/// against the reference is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Shortfall(pub String);

/// Nothing could be done: for want of an adapter, where one was looked for and any of the configurations
/// needs it.
pub(crate) fn nothing_done<'a>(
    said: &str,
    (choice, gpu): (Option<&AdapterChoice>, Option<&Gpu>),
    configurations: impl IntoIterator<Item = &'a Configuration>,
) -> anyhow::Error {
    let is_missed = choice.is_some() && gpu.is_none();
    if is_missed && configurations.into_iter().any(Configuration::needs_adapter) {
        anyhow::Error::new(RenderError::NoAdapter).context(said.to_owned())
    } else {
        Shortfall(said.to_owned()).into()
    }
}
