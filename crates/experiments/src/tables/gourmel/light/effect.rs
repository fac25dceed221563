//! The effects of the paper's pictures.

use metaball_core::{Camera, NO_LIMIT};
use metaball_light::{Effects, Lamp, Occlusion, Surface};

/// What a scene is drawn with. Where there are shadows, a single lamp casts them: the paper does not say
/// how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Phong's model by primary rays alone: the paper's "ray cast".
    Cast,
    /// Hard shadows.
    Shadows,
    /// Hard shadows, and so many levels of reflection.
    ShadowedMirrors(u32),
    /// Reflections alone.
    Mirrors(u32),
    /// So many occlusion rays a surface point.
    Occlusion(u32),
    /// One reflection, of Fresnel's share for water.
    Fresnel,
}

impl Effect {
    /// Its name in files and tables.
    pub fn name(self) -> String {
        let levels = |levels| if levels == 1 { "reflection" } else { "reflections" };
        match self {
            Self::Cast => "ray cast".to_owned(),
            Self::Shadows => "hard shadows".to_owned(),
            Self::ShadowedMirrors(n) => format!("hard shadows, {n} {}", levels(n)),
            Self::Mirrors(n) => format!("{n} {}", levels(n)),
            Self::Occlusion(rays) => format!("{rays} occlusion rays"),
            Self::Fresnel => "Fresnel reflection".to_owned(),
        }
    }

    /// What it is made of.
    pub(super) fn effects(self, camera: &Camera) -> Effects {
        let [lamp, _] = Lamp::studio(camera);
        let base = Effects { lamps: vec![lamp], ..Effects::phong(camera) };
        let mirror = |reflectivity, bounces, shadows| Effects {
            surface: Surface::Opaque { reflectivity },
            bounces,
            shadows,
            ..base.clone()
        };
        match self {
            Self::Cast => base,
            Self::Shadows => Effects { shadows: true, ..base },
            Self::ShadowedMirrors(levels) => mirror(0.5, levels, true),
            Self::Mirrors(levels) => mirror(0.5, levels, false),
            Self::Occlusion(rays) => {
                Effects { occlusion: Some(Occlusion { rays, reach: NO_LIMIT }), ..base }
            }
            // ((1.33 − 1)/(1.33 + 1))² of light at normal incidence.
            Self::Fresnel => mirror(0.02, 1, false),
        }
    }
}
