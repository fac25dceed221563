//! The adapter that tests run on.

use std::sync::OnceLock;

use metaball_core::gpu::{AdapterChoice, Gpu};

/// The adapter, opened once; `None` where there is none and the environment does not insist.
///
/// # Panics
/// When `REQUIRE_GPU` is set and no adapter opens: a test that did not run has not passed.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| match Gpu::new(&AdapterChoice::Environment) {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("REQUIRE_GPU").is_none(), "{error}");
            None
        }
    })
    .as_ref()
}
