//! Light of lamps, along shadow rays where they cast shadows.

use glam::Vec3;
use metaball_core::{NO_LIMIT, Ray};

use super::lighting::Lighting;
use super::sampling::{Frame, on_disc};
use super::secondary::Purpose;
use crate::path::Path;

impl Lighting {
    /// Adds the light of all lamps, without shadows.
    pub(super) fn add_unshadowed(&self, path: &mut Path, direction: Vec3) {
        let share = self.own_share(path, direction);
        for (index, lamp) in self.lamps.iter().enumerate() {
            path.radiance += share * self.reflected(path, direction, index, lamp.toward);
        }
    }

    /// A ray towards a point of a lamp, and the light that it brings if it hits nothing; none where the
    /// surface faces away.
    pub(super) fn shadow_ray(
        &self,
        path: &Path,
        (pixel, sample): (u32, u32),
        direction: Vec3,
        lamp: usize,
    ) -> Option<(Ray, Vec3)> {
        let Lighting { lamps, .. } = self;
        let mut toward = lamps[lamp].toward;
        if lamps[lamp].size > 0.0 {
            let number = sample.wrapping_mul(lamps.len() as u32).wrapping_add(lamp as u32);
            let square = self.points(path, pixel, Purpose::Lamp).nth(number);
            toward = Frame::around(toward).over(lamps[lamp].size * on_disc(square));
        }
        let ray = path.send(toward, NO_LIMIT)?;
        let share = self.own_share(path, direction);
        Some((ray, share * self.reflected(path, direction, lamp, toward)))
    }
}
