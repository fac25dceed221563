//! Phong's model, in bands where cel shading is asked for.

use glam::Vec3;

use super::lighting::Lighting;
use crate::path::Path;

/// Phong's highlight: its brightness beside a white surface's.
const HIGHLIGHT: f32 = 0.22;

impl Lighting {
    /// Light of a lamp in direction `toward` that the surface reflects back along the ray.
    pub(super) fn reflected(
        &self,
        path: &Path,
        direction: Vec3,
        lamp: usize,
        toward: Vec3,
    ) -> Vec3 {
        let cosine = path.normal.dot(toward);
        if cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let mut light = path.base * self.shaded(Vec3::splat(cosine));
        if path.on_floor == 0 {
            let mirrored = direction.reflect(path.normal).dot(toward).max(0.0);
            light += HIGHLIGHT * self.shaded(Vec3::splat(to_the_48th(mirrored)));
        }
        self.lamps[lamp].color * light
    }

    /// In bands of brightness where cel shading is asked for; the light keeps its colour.
    pub(super) fn shaded(&self, light: Vec3) -> Vec3 {
        let brightness = light.max_element();
        if self.settings.bands == 0 || brightness == 0.0 {
            return light;
        }
        let bands = self.settings.bands as f32;
        light * ((brightness * bands + 0.5).floor() / (bands * brightness))
    }
}

/// The highlight's exponent is 48, 32 + 16.
fn to_the_48th(x: f32) -> f32 {
    let square = |x: f32| x * x;
    let sixteenth = square(square(square(square(x))));
    square(sixteenth) * sixteenth
}
