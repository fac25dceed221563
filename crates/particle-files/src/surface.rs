//! How the balls of particles make a surface.

use glam::DVec3;
use metaball_core::{Kernel, Scene};

use crate::error::LoadError;
use crate::formula::{ByFormula, Formula};
use crate::notes::Notes;
use crate::overrides::Overrides;
use crate::particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles};

/// A kernel and a threshold, or a formula with its own; `None` where nothing is asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Surface {
    pub(crate) kernel: Option<Kernel>,
    pub(crate) threshold: Option<f32>,
    pub(crate) formula: Option<Formula>,
}

impl Surface {
    /// With a formula under the kernel and the threshold that replace its own: it makes other balls for
    /// them. Without one scenes are changed when they are made, and their supports stay.
    pub(crate) fn overridden(self, overrides: &Overrides) -> Result<Self, LoadError> {
        let Some(formula) = self.formula else { return Ok(self) };
        let own = self.kernel.unwrap_or_else(|| formula.kernel());
        Ok(Self {
            kernel: Some(overrides.kernel_for(own)?),
            threshold: overrides.threshold.or(self.threshold),
            ..self
        })
    }

    /// The scene of particles, in coordinates that begin at `origin` or where they need to, and what making
    /// it had to say.
    pub(crate) fn scene(
        &self,
        particles: Particles,
        origin: Option<DVec3>,
    ) -> Result<(Scene, Notes), LoadError> {
        let ByFormula { mut particles, kernel, threshold } = match self.formula {
            Some(formula) => formula.apply(particles, self.kernel, self.threshold)?,
            None => ByFormula {
                particles,
                kernel: self.kernel.unwrap_or(DEFAULT_KERNEL),
                threshold: self.threshold.unwrap_or(DEFAULT_THRESHOLD),
            },
        };
        let notes = std::mem::take(&mut particles.notes);
        Ok((particles.into_scene_at(origin, kernel, threshold)?, notes))
    }
}
