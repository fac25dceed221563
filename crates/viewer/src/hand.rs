//! What a hand does on the picture: it turns what is there, moves it, and brings it nearer.

use std::ops::RangeInclusive;

use glam::DVec3;

use crate::{Pose, Viewer};

/// Radians that the eye turns for a drag across the picture's height.
const TURN: f64 = std::f64::consts::PI;

/// The share of the distance that is left after one step, at most and at least.
const SHARES: RangeInclusive<f64> = 0.2..=5.0;

/// A hand, and the point that it has taken hold of. Places are from the top left of the picture, each from 0
/// to 1.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hand {
    /// In the coordinates of the scene's file.
    grabbed: Option<DVec3>,
}

impl Hand {
    /// Takes hold of what the picture shows at a place, if there is anything.
    pub fn grab(&mut self, viewer: &Viewer, place: (f64, f64)) {
        self.grabbed = viewer.point_at(place);
    }

    /// Turns the eye about the middle; in heights of the picture.
    pub fn turn(&self, viewer: &mut Viewer, right: f64, down: f64) {
        if let Some(pose) = viewer.pose() {
            viewer.set_pose(pose.orbited(TURN * right, TURN * down));
        }
    }

    /// Moves so that the point stays under the hand, or the middle where it holds none; in heights of the
    /// picture.
    pub fn slide(&self, viewer: &mut Viewer, right: f64, down: f64) {
        let Some(pose) = viewer.pose() else { return };
        let depth = self.grabbed.map_or(pose.distance(), |point| depth_of(&pose, point));
        let units = pose.height_at(depth);
        viewer.set_pose(pose.moved(units * DVec3::new(-right, down, 0.0)));
    }

    /// Leaves a share of the distance to the point at a place, or to the one behind it that is as far as the
    /// middle.
    pub fn zoom(&self, viewer: &mut Viewer, place: (f64, f64), share: f64) {
        let (Some(pose), Some((width, height))) = (viewer.pose(), viewer.size()) else { return };
        let share = share.clamp(*SHARES.start(), *SHARES.end());
        if share == 1.0 {
            return;
        }
        let aspect = f64::from(width) / f64::from(height);
        let about = viewer.point_at(place).unwrap_or_else(|| behind(&pose, aspect, place));
        viewer.set_pose(pose.zoomed(about, share));
    }
}

/// How far in front of the eye.
fn depth_of(pose: &Pose, point: DVec3) -> f64 {
    (point - pose.eye).dot(pose.axes()[2])
}

/// The point behind a place of the picture that is as far in front of the eye as the middle.
fn behind(pose: &Pose, aspect: f64, (right, down): (f64, f64)) -> DVec3 {
    let units = pose.height_at(pose.distance());
    let across = DVec3::new((right - 0.5) * aspect, 0.5 - down, 0.0);
    pose.moved(units * across).look_at
}
