//! What all effects of a picture read.

use crate::path::{Lamp, Settings};
use crate::{Effects, Environment};

/// Settings, lamps and surroundings of a picture. Each effect adds its functions to it in a file of its
/// own.
#[derive(Debug)]
pub(super) struct Lighting {
    pub(super) settings: Settings,
    pub(super) lamps: Vec<Lamp>,
    pub(super) environment: Environment,
    /// The share of light that the metaballs' surface lets pass straight on.
    pub(super) transparency: f32,
}

impl Lighting {
    pub(super) fn new(effects: &Effects, samples: u32, seed: u32) -> Self {
        Self {
            settings: Settings::new(effects, samples, seed),
            lamps: effects.lamps.iter().map(Lamp::new).collect(),
            environment: effects.environment.clone(),
            transparency: effects.transparency(),
        }
    }

    /// Whether the only path of a pixel begins through its middle.
    pub(super) fn has_one_sample(&self) -> bool {
        self.settings.samples == 1
    }
}
