//! What moves, as the library that draws takes it.

use std::ops::Range;

use bench_scenes::Moving;
use metaball::{AnimatedScene, BoxError, Overrides};
use metaball_core::{Camera, Scene};

/// A moving scene of any kind, and what was changed about it.
pub(crate) struct Motion {
    moving: Moving,
    overrides: Overrides,
}

impl Motion {
    /// By name, generator or file.
    pub(crate) fn load(spec: &str, overrides: &Overrides) -> anyhow::Result<Self> {
        Ok(Self { moving: Moving::load(spec, overrides)?, overrides: *overrides })
    }
}

impl AnimatedScene for Motion {
    fn name(&self) -> &str {
        &self.moving.name
    }

    fn description(&self) -> String {
        format!("{} with {:?}", self.moving.name, self.overrides)
    }

    fn camera(&self) -> &Camera {
        &self.moving.camera
    }

    fn frames(&self) -> Range<u32> {
        self.moving.frames.clone()
    }

    fn present(&self, range: Range<u32>) -> Result<Vec<u32>, BoxError> {
        Ok(self.moving.present(range)?)
    }

    fn frame(&self, number: u32) -> Result<Scene, BoxError> {
        Ok(self.moving.frame(number)?)
    }
}
