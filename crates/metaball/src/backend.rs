//! What computes a picture.

use metaball_core::gpu::{AdapterChoice, Gpu, GpuError};

use crate::Error;

/// What computes a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Backend {
    /// A graphics adapter. Where the machine has none at all, and none was asked for by name, the
    /// CPU.
    Adapter(AdapterChoice),
    /// The CPU, without any graphics API.
    Cpu,
}

impl Default for Backend {
    /// The adapter that the environment variables of wgpu name, or the best.
    fn default() -> Self {
        Self::Adapter(AdapterChoice::Environment)
    }
}

impl Backend {
    /// The adapter; `None` when it is the CPU that computes.
    pub(crate) fn open(&self) -> Result<Option<Gpu>, Error> {
        let Self::Adapter(choice) = self else { return Ok(None) };
        match Gpu::new(choice) {
            Ok(gpu) => Ok(Some(gpu)),
            Err(GpuError::NoAdapter { choice, found })
                if found.is_empty() && !matches!(choice, AdapterChoice::Named(_)) =>
            {
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// What computes, in words; `gpu` is what [`Self::open`] found.
    pub(crate) fn describe(&self, gpu: Option<&Gpu>) -> String {
        match (gpu, self) {
            (Some(gpu), _) => format!("{} ({})", gpu.report().name, gpu.report().driver),
            (None, Self::Cpu) => "none asked for: traced on the CPU".to_owned(),
            (None, Self::Adapter(_)) => "no graphics adapter: traced on the CPU".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_adapter_asked_for_by_name_is_not_replaced() {
        let backend = Backend::Adapter(AdapterChoice::Named("Voodoo".to_owned()));
        assert!(backend.open().expect_err("refused").to_string().contains("Voodoo"));
        assert!(Backend::Cpu.open().expect("nothing to open").is_none());
    }
}
