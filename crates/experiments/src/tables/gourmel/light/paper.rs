//! What Gourmel et al. 2010 print in section 6 of pictures with effects: frames a second at 640 × 480 on
//! a GeForce GTX 280.

use super::effect::Effect;
use crate::tables::gourmel::paper_scene::PaperScene;

/// A scene of table 1 under its own effects (figure 8).
#[derive(Debug)]
pub struct Gain {
    /// The scene.
    pub scene: PaperScene,
    /// What it is drawn with.
    pub effect: Effect,
    /// Frames a second of the modified BVH, the mean.
    pub modified: f64,
    /// And of the Fitted BVH.
    pub fitted: f64,
}

/// A row of table 2: frames a second of the Fitted BVH, the mean, by effect.
#[derive(Debug)]
pub struct Costs {
    /// The scene.
    pub scene: PaperScene,
    /// In the order of [`COST_EFFECTS`].
    pub fps: [f64; 4],
}

use Effect::{Cast, Fresnel, Mirrors, Occlusion, ShadowedMirrors, Shadows};
use PaperScene::{Molecule, Pool, Tornado4k, Tornado128k};

/// Table 1, without the scattered balls, which have no effects.
pub const GAINS: &[Gain] = &[
    Gain { scene: Tornado4k, effect: Mirrors(3), modified: 4.6, fitted: 11.0 },
    Gain { scene: Tornado128k, effect: Mirrors(3), modified: 1.0, fitted: 2.4 },
    Gain { scene: Molecule, effect: Shadows, modified: 5.8, fitted: 17.7 },
    Gain { scene: Molecule, effect: Occlusion(64), modified: 0.6, fitted: 1.3 },
    Gain { scene: Pool, effect: Fresnel, modified: 1.9, fitted: 7.1 },
];

/// The columns of table 2.
pub const COST_EFFECTS: [Effect; 4] = [Cast, Shadows, ShadowedMirrors(1), ShadowedMirrors(3)];

/// Table 2. Of the tornado the paper does not say which; here it is the small one.
pub const COSTS: &[Costs] = &[
    Costs { scene: Molecule, fps: [22.3, 17.7, 12.7, 8.2] },
    Costs { scene: Tornado4k, fps: [5.7, 4.9, 3.4, 2.5] },
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's tables share a number: Molecule 1 is drawn with hard shadows.
    #[test]
    fn tables_agree_with_each_other() {
        let molecule = GAINS.iter().find(|gain| gain.effect == Shadows).expect("printed");
        assert_eq!((COSTS[0].scene, COST_EFFECTS[1]), (molecule.scene, molecule.effect));
        assert_eq!(COSTS[0].fps[1], molecule.fitted);
    }
}
