//! What a method draws with: passes on an adapter, or the CPU.

use std::time::Instant;

use metaball_core::gpu::{BuildReport, Gpu, IsoRenderer, RenderError};
use metaball_core::{HostMethod, HostRenderer, Scene};

/// A method of either kind, without a scene.
pub enum Renderer {
    /// It records passes for an adapter.
    Adapter(Box<dyn IsoRenderer>),
    /// It traces rays on the CPU, and needs no adapter.
    Host(Box<dyn HostMethod>),
}

/// A renderer that has its scene.
pub enum Built<'s> {
    /// On an adapter.
    Adapter(Box<dyn IsoRenderer>),
    /// On the CPU.
    Host(Box<dyn HostRenderer + 's>),
}

impl Renderer {
    /// The method's stable name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Adapter(renderer) => renderer.name(),
            Self::Host(method) => method.name(),
        }
    }

    /// The renderer on an adapter; `None` of a method on the CPU.
    pub fn on_adapter(self) -> Option<Box<dyn IsoRenderer>> {
        match self {
            Self::Adapter(renderer) => Some(renderer),
            Self::Host(_) => None,
        }
    }

    /// Builds for the scene. The report of a method on the CPU has main memory for the device's.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`] where one is needed and none given, and whatever the method refuses.
    pub fn build<'s>(
        self,
        gpu: Option<&Gpu>,
        scene: &'s Scene,
    ) -> Result<(Built<'s>, BuildReport), RenderError> {
        match self {
            Self::Adapter(mut renderer) => {
                let report = renderer.build(gpu.ok_or(RenderError::NoAdapter)?, scene)?;
                Ok((Built::Adapter(renderer), report))
            }
            Self::Host(method) => {
                let start = Instant::now();
                let tracer = method.build(scene)?;
                let structure = start.elapsed();
                let device_bytes = tracer.bytes();
                let report = BuildReport { structure, device_bytes, ..BuildReport::default() };
                Ok((Built::Host(tracer), report))
            }
        }
    }
}

impl Built<'_> {
    /// Bytes held by now, on the device or in main memory, in addition to those of the build.
    pub fn frame_bytes(&self) -> u64 {
        match self {
            Self::Adapter(renderer) => renderer.frame_bytes(),
            Self::Host(_) => 0,
        }
    }
}
