//! The checks that wgpu writes into shaders, and where they are left out.
//!
//! A *checked* shader clamps what it indexes arrays with, and counts the turns of each loop so that none
//! runs for ever. Both are there for shaders of strangers, and cost most where ours spend their time: in
//! loops along lists. A graphics processor therefore runs the modules of `metaball-shaders` *unchecked*;
//! software Vulkan, and so every test, runs them checked; modules of a caller's own are checked
//! everywhere. Both twins find the same hits, bit for bit (`tests/src/trials/unchecked.rs`).
//!
//! # Why no loop runs for ever
//! A loop goes along an array or a list that the host or an earlier pass has made, each node of it once;
//! or halves an interval down to a width that it names; or counts against a budget of iterations, after
//! which its ray waits for the next dispatch (`shaders/wgsl/fbvh/budget.wgsl`,
//! `shaders/wgsl/illes_fraglist/budget.wgsl`, and the `budget` of
//! `shaders/wgsl/kanamori_robust/search.wgsl`). A comparison with a number that is none ends each.
//!
//! # Why every index holds
//! | array | index |
//! | --- | --- |
//! | rays, hits, work, colours, film, paths: one element a pixel | the pixel of an invocation that `in_picture` lets through, or one read from a list of such pixels, up to the list's count |
//! | supports, strengths, colours of balls: `scene.balls` elements | ball of an invocation below `scene.balls`; or read from a tree's, tile's or pixel's list, which name balls of the scene alone |
//! | nodes, leaves, lists of a tree | references and list ends of a tree that `fbvh` has built; a last leaf without balls ends the lists, so the leaf behind each exists; a list without balls is read nowhere |
//! | pools of suspended rays, of list nodes, of entries of tiles | below `arrayLength`; what is requested beyond is counted, not written, and the frame is incomplete |
//! | tiles | rows and columns below the grid's, which has `MOST_TILES` at most |
//! | `var<private>` stacks and arrays | a tree's depth, below `MAX_DEPTH`; the count of what was put in, which stops at the array's length or the smaller capacity that the host has checked |
//! | `var<workgroup>` arrays | the invocation's number in its group, or a digit of four bits times it |
//! | coefficients of a polynomial | up to its degree, which the kernel's module declares with the array |
//!
//! What is bound is what the module's interface says: the layouts are made beside the modules, by the
//! crates of this workspace, and a device with robust access, which wgpu asks for, bounds buffers anyhow.
//! Divisions by zero stay checked.

use std::borrow::Cow;

use metaball_shaders::naga;

use super::{Gpu, GpuError};

/// Whether the modules of `metaball-shaders` run with wgpu's checks of indices and loops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShaderChecks {
    /// With them, as on adapters that compute on the CPU.
    On,
    /// Without, as on graphics processors.
    Off,
}

/// Names [`ShaderChecks`] other than the adapter's: `on` or `off`.
const VARIABLE: &str = "METABALL_SHADER_CHECKS";

impl ShaderChecks {
    /// By the adapter alone.
    pub(super) fn of_adapter(kind: wgpu::DeviceType) -> Self {
        if kind == wgpu::DeviceType::Cpu { Self::On } else { Self::Off }
    }

    /// As the environment says, if it does.
    pub(super) fn of_environment() -> Result<Option<Self>, GpuError> {
        let Some(found) = std::env::var_os(VARIABLE) else { return Ok(None) };
        Self::named(&found.to_string_lossy()).map(Some)
    }

    fn named(name: &str) -> Result<Self, GpuError> {
        match name {
            "on" => Ok(Self::On),
            "off" => Ok(Self::Off),
            _ => Err(GpuError::ShaderChecks { variable: VARIABLE, found: name.to_owned() }),
        }
    }

    fn runtime_checks(self) -> wgpu::ShaderRuntimeChecks {
        let is_on = self == Self::On;
        wgpu::ShaderRuntimeChecks {
            bounds_checks: is_on,
            force_loop_bounding: is_on,
            ..wgpu::ShaderRuntimeChecks::checked()
        }
    }
}

/// A module that was composed of those of `metaball-shaders` alone, with the device's checks.
pub(super) fn own_module(gpu: &Gpu, label: &str, composed: naga::Module) -> wgpu::ShaderModule {
    let checks = gpu.report().shader_checks.runtime_checks();
    #[expect(unsafe_code, reason = "wgpu has no other way to leave checks out")]
    // SAFETY: the head of this file says why loops end and indices hold.
    unsafe {
        gpu.device.create_shader_module_trusted(descriptor(label, composed), checks)
    }
}

/// A module in which there is text of somebody else, checked.
pub(super) fn foreign_module(gpu: &Gpu, label: &str, composed: naga::Module) -> wgpu::ShaderModule {
    gpu.device.create_shader_module(descriptor(label, composed))
}

fn descriptor(label: &str, composed: naga::Module) -> wgpu::ShaderModuleDescriptor<'_> {
    wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Naga(Cow::Owned(composed)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_real_graphics_processors_run_unchecked_unless_told() {
        assert_eq!(ShaderChecks::of_adapter(wgpu::DeviceType::Cpu), ShaderChecks::On);
        assert_eq!(ShaderChecks::of_adapter(wgpu::DeviceType::DiscreteGpu), ShaderChecks::Off);
        assert_eq!(ShaderChecks::named("off").expect("a name"), ShaderChecks::Off);
        let error = ShaderChecks::named("no").expect_err("no name").to_string();
        assert_eq!(error, "METABALL_SHADER_CHECKS: needed on or off, found no");
    }

    #[test]
    fn divisions_stay_checked() {
        let off = ShaderChecks::Off.runtime_checks();
        assert!(!off.bounds_checks && !off.force_loop_bounding && off.int_div_checks);
        let on = ShaderChecks::On.runtime_checks();
        assert_eq!(format!("{on:?}"), format!("{:?}", wgpu::ShaderRuntimeChecks::checked()));
    }
}
