//! Choosing an adapter, and describing it.

use std::fmt;

use thiserror::Error;

use super::shader_checks::ShaderChecks;

/// Which adapter to draw with.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// By wgpu's environment variables `WGPU_ADAPTER_NAME`, `WGPU_BACKEND` and `WGPU_POWER_PREF`;
    /// where they are not set, the fastest adapter.
    #[default]
    Environment,
    /// The fastest adapter that is a graphics processor.
    Hardware,
    /// The first adapter whose name contains this text, whatever the case.
    Named(String),
    /// An adapter that computes on the CPU, the same on every machine with the same driver.
    Software,
}

/// Why no adapter was opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter, or none that was chosen.
    #[error("no graphics adapter{}{}\n{INSTALL_SOFTWARE_ADAPTER}", for_choice(choice), list(found))]
    NoAdapter {
        /// The choice.
        choice: AdapterChoice,
        /// Names of the adapters there are.
        found: Vec<String>,
    },
    /// The environment names no [`ShaderChecks`].
    #[error("{variable}: needed on or off, found {found}")]
    ShaderChecks {
        /// The variable.
        variable: &'static str,
        /// Its value.
        found: String,
    },
    /// The adapter refused to open a device.
    #[error("adapter {adapter}: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// wgpu's text.
        reason: String,
    },
}

/// How to get an adapter where there is none.
const INSTALL_SOFTWARE_ADAPTER: &str = "\
A Vulkan, Metal or Direct3D 12 driver is needed. One that computes on the CPU will do:
  Debian, Ubuntu   sudo apt-get install mesa-vulkan-drivers libvulkan1
  Fedora           sudo dnf install mesa-vulkan-drivers vulkan-loader
  Arch             sudo pacman -S vulkan-swrast vulkan-icd-loader
  macOS, Windows   part of the system (Metal; Direct3D 12 with WARP)";

fn for_choice(choice: &AdapterChoice) -> String {
    match choice {
        AdapterChoice::Environment => String::new(),
        AdapterChoice::Hardware => " that is a graphics processor".to_owned(),
        AdapterChoice::Named(name) => format!(" with \"{name}\" in its name"),
        AdapterChoice::Software => " that computes on the CPU".to_owned(),
    }
}

fn list(found: &[String]) -> String {
    if found.is_empty() { String::new() } else { format!("; found {}", found.join(", ")) }
}

/// An adapter, its driver and its limits. Printed, it is one line a fact.
#[derive(Debug, Clone, PartialEq)]
pub struct AdapterReport {
    /// The adapter's name.
    pub name: String,
    /// The API it is driven by, such as `vulkan`.
    pub backend: String,
    /// Driver and its version, as the driver names them.
    pub driver: String,
    /// The kind of processor; software adapters are `Cpu`.
    pub kind: wgpu::DeviceType,
    /// Whether passes can be timed.
    pub timestamps: bool,
    /// Bytes of the largest buffer.
    pub max_buffer_bytes: u64,
    /// Bytes of the largest storage binding: sixteen times this many balls fit a scene.
    pub max_binding_bytes: u64,
    /// Storage buffers that one shader can see.
    pub max_storage_buffers: u32,
    /// Whether shaders check their indices and loops.
    pub shader_checks: ShaderChecks,
}

impl AdapterReport {
    /// Whether shaders run on the CPU: times are not those of a GPU.
    pub fn is_software(&self) -> bool {
        self.kind == wgpu::DeviceType::Cpu
    }

    pub(super) fn new(info: &wgpu::AdapterInfo, limits: &wgpu::Limits, timestamps: bool) -> Self {
        Self {
            name: info.name.clone(),
            backend: info.backend.to_string(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            kind: info.device_type,
            timestamps,
            max_buffer_bytes: limits.max_buffer_size,
            max_binding_bytes: limits.max_storage_buffer_binding_size,
            max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
            shader_checks: ShaderChecks::of_adapter(info.device_type),
        }
    }
}

impl fmt::Display for AdapterReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mebibytes = |bytes: u64| bytes >> 20;
        let kind = match self.kind {
            wgpu::DeviceType::Cpu => "software (computes on the CPU)",
            wgpu::DeviceType::DiscreteGpu => "discrete GPU",
            wgpu::DeviceType::IntegratedGpu => "integrated GPU",
            wgpu::DeviceType::VirtualGpu => "virtual GPU",
            wgpu::DeviceType::Other => "of unknown kind",
        };
        writeln!(formatter, "adapter     {}", self.name)?;
        writeln!(formatter, "kind        {kind}")?;
        writeln!(formatter, "backend     {}", self.backend)?;
        writeln!(formatter, "driver      {}", self.driver)?;
        writeln!(formatter, "buffers     up to {} MiB", mebibytes(self.max_buffer_bytes))?;
        writeln!(
            formatter,
            "bindings    up to {} MiB, {} to a shader",
            mebibytes(self.max_binding_bytes),
            self.max_storage_buffers
        )?;
        writeln!(formatter, "timestamps  {}", if self.timestamps { "yes" } else { "no" })?;
        let is_checked = self.shader_checks == ShaderChecks::On;
        write!(formatter, "shaders     {}", if is_checked { "checked" } else { "unchecked" })
    }
}

/// The adapter of this choice.
pub(super) fn choose(choice: &AdapterChoice) -> Result<wgpu::Adapter, GpuError> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapters = || pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let choice = match (choice, std::env::var("WGPU_ADAPTER_NAME")) {
        (AdapterChoice::Environment, Ok(name)) => AdapterChoice::Named(name),
        _ => choice.clone(),
    };
    let adapter = if let AdapterChoice::Named(name) = &choice {
        let name = name.to_lowercase();
        adapters()
            .into_iter()
            .find(|adapter| adapter.get_info().name.to_lowercase().contains(&name))
    } else {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::from_env()
                .unwrap_or(wgpu::PowerPreference::HighPerformance),
            force_fallback_adapter: choice == AdapterChoice::Software,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).ok();
        let is_wanted = |adapter: &wgpu::Adapter| {
            choice != AdapterChoice::Hardware
                || adapter.get_info().device_type != wgpu::DeviceType::Cpu
        };
        adapter.filter(is_wanted)
    };
    adapter.ok_or_else(|| GpuError::NoAdapter {
        choice,
        found: adapters().iter().map(|adapter| adapter.get_info().name).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_adapter_says_what_to_install() {
        let nonsense = AdapterChoice::Named("Voodoo".to_owned());
        assert!(matches!(choose(&nonsense), Err(GpuError::NoAdapter { .. })));
        let error = GpuError::NoAdapter { choice: nonsense, found: vec!["llvmpipe".to_owned()] };
        let text = error.to_string();
        assert!(
            text.starts_with("no graphics adapter with \"Voodoo\" in its name; found llvmpipe")
        );
        assert!(text.contains("apt-get install mesa-vulkan-drivers libvulkan1"));
    }
}
