//! Begins a sample of the picture: a path from the eye through a point of the pixel.

use metaball_core::{Ray, View};

use super::lighting::Lighting;
use super::sampling::{point_in_square, tent};

impl Lighting {
    /// Through the pixel's middle when there is one sample; else through points weighted by a tent of
    /// two pixels' width, which smooths edges without blurring them.
    pub(super) fn eye_ray(&self, view: &View, (pixel, sample): (u32, u32)) -> Ray {
        let camera = view.camera();
        let (width, height) = (view.width(), view.height());
        let (column, row) = (pixel % width, pixel / width);
        let middle = camera.exact_direction(column, row, width, height).as_vec3();
        if self.settings.samples == 1 {
            return Ray::new(camera.eye(), middle);
        }
        let square = point_in_square(self.settings.seed, pixel, 0, sample);
        let pixel_height = 2.0 * camera.half_height() / height as f32;
        let (right, up) = (pixel_height * tent(square.x), pixel_height * tent(square.y));
        // The picture lies at unit distance along `forward`.
        let toward =
            middle / middle.dot(camera.forward()) + right * camera.right() + up * camera.up();
        Ray::new(camera.eye(), toward / toward.length())
    }
}
