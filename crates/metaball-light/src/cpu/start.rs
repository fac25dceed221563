//! Begins a sample of the picture: a path from the eye through a point of the pixel.

use glam::Vec3;
use metaball_core::{Ray, View};

use super::lighting::Lighting;
use super::sampling::{Points, tent};

impl Lighting {
    /// In direction `middle`, through the pixel's middle, when there is one sample; else through points
    /// weighted by a tent of two pixels' width, which smooths edges without blurring them.
    pub(super) fn eye_ray(&self, view: &View, middle: Vec3, (pixel, sample): (u32, u32)) -> Ray {
        let camera = view.camera();
        if self.has_one_sample() {
            return Ray::new(camera.eye(), middle);
        }
        let square = Points::new(self.settings.seed, pixel, 0).nth(sample);
        let pixel_height = 2.0 * camera.half_height() / view.height() as f32;
        let (right, up) = (pixel_height * tent(square.x), pixel_height * tent(square.y));
        // The picture lies at unit distance along `forward`.
        let toward =
            middle / middle.dot(camera.forward()) + right * camera.right() + up * camera.up();
        Ray::new(camera.eye(), toward / toward.length())
    }
}
