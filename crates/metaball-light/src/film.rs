//! A picture in linear light.

use glam::Vec3;
use metaball_core::{Color, Image};
use rayon::prelude::*;

/// Linear light of each pixel, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Linear light with the primaries of sRGB; 1 is white.
    pub light: Vec<Vec3>,
}

impl Film {
    /// The picture: see [`develop`].
    pub fn develop(&self, exposure: f32) -> Image {
        Image::new(self.width, self.height, &develop(&self.light, exposure))
    }
}

/// Linear light with sRGB's transfer function (IEC 61966-2-1). `exposure` is in stops: each doubles the
/// light. What is brighter than white is white.
pub fn develop(light: &[Vec3], exposure: f32) -> Vec<Color> {
    let gain = libm::exp2f(exposure);
    light.par_iter().map(|light| Color::from_linear(gain * *light)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_encoded() {
        // sRGB's 188 is half the light of white: 0.5028.
        let film = Film { width: 2, height: 1, light: vec![Vec3::splat(0.5), Vec3::splat(2.0)] };
        assert_eq!(film.develop(0.0).rgba, [188, 188, 188, 255, 255, 255, 255, 255]);
        assert_eq!(film.develop(-2.0).rgba[4..7], [188; 3]);
    }
}
