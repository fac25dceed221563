//! What the surface is made of, where light shows it.

use metaball::LightOptions;

/// Kinds of matter that exclude each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Material {
    /// It mirrors nothing.
    Matt,
    /// It mirrors a share of the light.
    Mirror,
    /// Layers lie behind each other.
    SeeThrough,
    /// It refracts and absorbs.
    Fluid,
}

impl Material {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Matt, Self::Mirror, Self::SeeThrough, Self::Fluid];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Matt => "matt",
            Self::Mirror => "mirror",
            Self::SeeThrough => "see-through",
            Self::Fluid => "clear fluid",
        }
    }

    /// That of a light.
    pub fn of(light: &LightOptions) -> Self {
        match light {
            LightOptions { refraction: Some(_), .. } => Self::Fluid,
            LightOptions { opacity: Some(_), .. } => Self::SeeThrough,
            LightOptions { reflections: Some(_), .. } => Self::Mirror,
            _ => Self::Matt,
        }
    }

    /// Makes the surface of it, without what does not go with it.
    pub fn put_into(self, light: &mut LightOptions) {
        let plain = LightOptions::default();
        *light = LightOptions {
            reflections: (self == Self::Mirror).then_some(2),
            reflectivity: plain.reflectivity,
            opacity: (self == Self::SeeThrough).then_some(0.4),
            refraction: (self == Self::Fluid).then_some(1.33),
            absorption: plain.absorption,
            bounces: plain.bounces,
            ..light.clone()
        };
        if self == Self::Fluid {
            (light.shadows, light.lamp_size) = (false, None);
            (light.ambient_occlusion, light.occlusion_reach, light.cel) = (None, None, None);
        }
    }
}
