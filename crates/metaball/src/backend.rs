//! What computes a picture.

#[cfg(feature = "gpu")]
use metaball_core::gpu::{AdapterChoice, Gpu, GpuError};

use crate::Error;

/// What computes a picture.
///
/// On Linux a layer of Mesa's drivers prints an error on standard error, and goes on, when adapters are
/// looked for and `XDG_RUNTIME_DIR` is not set. The variable `NODEVICE_SELECT`, set before the process
/// begins, turns the layer off; the binary `metaball` does that for itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Backend {
    /// A graphics processor if the machine has one, else the CPU: an adapter that computes on the CPU
    /// itself is slower than the CPU's own tracer, and is taken only for what needs an adapter. An
    /// adapter that the environment variable `WGPU_ADAPTER_NAME` names counts as asked for.
    #[default]
    Fastest,
    /// A graphics adapter.
    #[cfg(feature = "gpu")]
    Adapter(AdapterChoice),
    /// The CPU, without any graphics API.
    Cpu,
}

/// What was opened to compute a picture, and why.
pub(crate) struct Opened {
    #[cfg(feature = "gpu")]
    /// The adapter; `None` when it is the CPU that computes.
    pub(crate) gpu: Option<Gpu>,
    pub(crate) why: String,
}

#[cfg(feature = "gpu")]
impl Backend {
    /// The adapter that was asked for, in words, if one was.
    pub(crate) fn adapter_asked(&self) -> Option<String> {
        match self {
            Self::Adapter(choice) => Some(format!("adapter {choice:?}")),
            Self::Fastest if is_named() => {
                Some("the adapter that WGPU_ADAPTER_NAME names".to_owned())
            }
            Self::Fastest | Self::Cpu => None,
        }
    }

    /// Opens what computes. `needs_adapter` says what cannot be drawn without an adapter, if anything.
    pub(crate) fn open(&self, needs_adapter: Option<&str>) -> Result<Opened, Error> {
        let choice = match self {
            Self::Cpu => return Ok(Opened::cpu("asked for")),
            Self::Adapter(choice) => {
                let gpu = Some(Gpu::new(choice)?);
                return Ok(Opened { gpu, why: "asked for".to_owned() });
            }
            Self::Fastest if is_named() => {
                let gpu = Some(Gpu::new(&AdapterChoice::Environment)?);
                return Ok(Opened { gpu, why: "named by WGPU_ADAPTER_NAME".to_owned() });
            }
            Self::Fastest if needs_adapter.is_some() => AdapterChoice::Environment,
            Self::Fastest => AdapterChoice::Hardware,
        };
        match (Gpu::new(&choice), needs_adapter) {
            (Ok(gpu), Some(what)) => {
                Ok(Opened { gpu: Some(gpu), why: format!("{what} needs an adapter") })
            }
            (Ok(gpu), None) => {
                Ok(Opened { gpu: Some(gpu), why: "a graphics processor".to_owned() })
            }
            (Err(GpuError::NoAdapter { .. }), None) => {
                Ok(Opened::cpu("no graphics processor found"))
            }
            (Err(error), _) => Err(error.into()),
        }
    }
}

/// Without the feature `gpu` the CPU is all there is.
#[cfg(not(feature = "gpu"))]
impl Backend {
    /// The adapter that was asked for, in words, if one was.
    pub(crate) fn adapter_asked(&self) -> Option<String> {
        None
    }

    /// Opens what computes. `needs_adapter` says what cannot be drawn without an adapter, if anything.
    pub(crate) fn open(&self, needs_adapter: Option<&str>) -> Result<Opened, Error> {
        match (needs_adapter, self) {
            (Some(what), _) => Err(Error::NeedsAdapter {
                what: what.to_owned(),
                instead: "metaball was built without its feature gpu".to_owned(),
            }),
            (None, Self::Cpu) => Ok(Opened::cpu("asked for")),
            (None, Self::Fastest) => Ok(Opened::cpu("built without adapters")),
        }
    }
}

/// Whether the environment names an adapter.
#[cfg(feature = "gpu")]
fn is_named() -> bool {
    std::env::var_os("WGPU_ADAPTER_NAME").is_some()
}

impl Opened {
    /// The CPU, and why.
    pub(crate) fn cpu(why: impl Into<String>) -> Self {
        Self {
            #[cfg(feature = "gpu")]
            gpu: None,
            why: why.into(),
        }
    }

    /// What computes and why, in a line.
    pub(crate) fn describe(&self) -> String {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return format!("{} ({}): {}", gpu.report().name, gpu.report().driver, self.why);
        }
        format!("the CPU ({} threads): {}", rayon::current_num_threads(), self.why)
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    #[test]
    fn an_adapter_asked_for_by_name_is_not_replaced() {
        let backend = Backend::Adapter(AdapterChoice::Named("Voodoo".to_owned()));
        let error = backend.open(None).map(|opened| opened.describe()).expect_err("refused");
        assert!(error.to_string().contains("Voodoo"), "{error}");
    }

    #[test]
    fn the_cpu_draws_unless_there_is_a_graphics_processor() {
        let cpu = Backend::Cpu.open(Some("method kanamori")).expect("nothing to open");
        assert!(cpu.gpu.is_none() && cpu.describe().starts_with("the CPU ("));
        let fastest = Backend::Fastest.open(None).expect("the CPU at least");
        let is_software = fastest.gpu.as_ref().is_some_and(|gpu| gpu.report().is_software());
        assert!(is_named() || !is_software, "{}", fastest.describe());
    }

    #[test]
    fn what_needs_an_adapter_gets_one_or_says_so() {
        match Backend::Fastest.open(Some("method kanamori")) {
            Ok(opened) => assert!(opened.gpu.is_some() && opened.describe().contains("kanamori")),
            Err(error) => assert!(error.to_string().contains("no graphics adapter"), "{error}"),
        }
    }
}
