//! Another camera than the scene's own.

use glam::{DVec3, Vec3};
use metaball_core::{Camera, CameraError, Scene};

/// Where a picture is seen from; what is left out is as the scene's own camera has it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Viewpoint {
    /// The eye, in the coordinates of the scene's file ([`Scene::origin`]). Alone it looks at the middle of
    /// the scene.
    pub eye: Option<DVec3>,
    /// What it looks at, in the same coordinates.
    pub look_at: Option<DVec3>,
    /// What is up in the picture; for another eye or direction the y axis, or the z axis where the view is
    /// along that.
    pub up: Option<Vec3>,
    /// Degrees from the bottom of the picture to its top.
    pub fov: Option<f32>,
}

impl Viewpoint {
    /// Whether it is any other than the scene's own.
    pub fn is_asked(&self) -> bool {
        *self != Self::default()
    }

    /// The camera in a scene that has one of its own.
    ///
    /// # Errors
    /// When the parts make no camera.
    pub fn camera(&self, own: &Camera, scene: &Scene) -> Result<Camera, CameraError> {
        if !self.is_asked() {
            return Ok(*own);
        }
        let in_scene = |point: DVec3| (point - scene.origin()).as_vec3();
        let eye = self.eye.map_or(own.eye(), in_scene);
        let ahead = || match self.eye {
            Some(_) => scene.bounds().center(),
            None => eye + own.forward(),
        };
        let look_at = self.look_at.map_or_else(ahead, in_scene);
        let degrees = self.fov.unwrap_or(2.0 * own.half_height().atan().to_degrees());
        let turns = self.eye.is_some() || self.look_at.is_some();
        match self.up.or((!turns).then_some(own.up())) {
            Some(up) => Camera::look_at(eye, look_at, up, degrees),
            None => Camera::upright(eye, look_at, degrees),
        }
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::{Kernel, Metaball};

    use super::*;

    #[test]
    fn what_is_left_out_is_the_scenes_own() {
        let own = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::X, 30.0).expect("legal");
        let around_y = [Metaball::new(Vec3::Y, 1.0)];
        let scene = Scene::new(around_y, Kernel::QUARTIC, 0.25).expect("legal");
        let camera = |viewpoint: Viewpoint| viewpoint.camera(&own, &scene);
        assert_eq!(camera(Viewpoint::default()), Ok(own));
        let near = camera(Viewpoint { fov: Some(10.0), ..Default::default() });
        let near = near.expect("a camera");
        assert_eq!((near.eye(), near.up()), (own.eye(), own.up()));
        assert!(near.half_height() < 0.5 * own.half_height());
        let moved = camera(Viewpoint { eye: Some(DVec3::X), ..Default::default() });
        let moved = moved.expect("a camera");
        assert!((moved.forward() - (Vec3::Y - Vec3::X).normalize()).length() < 1e-6);
        assert!((moved.half_height() - own.half_height()).abs() < 1e-6);
        let above = Viewpoint { eye: Some(9.0 * DVec3::Y), ..Default::default() };
        let top = camera(above).expect("a camera");
        assert!(top.up().z > 0.99 && top.forward().y < -0.99);
        assert!(camera(Viewpoint { up: Some(Vec3::Y), ..above }).is_err());
        let within = Viewpoint { look_at: Some(DVec3::Z), ..Default::default() };
        assert!(camera(within).is_err());
        let far = scene.clone().with_origin(DVec3::new(5e6, 0.0, -3e5));
        let eye = Some(DVec3::new(5e6 + 0.25, 0.0, 3.0 - 3e5));
        let far = Viewpoint { eye, ..Default::default() }.camera(&own, &far).expect("a camera");
        assert_eq!(far.eye(), Vec3::new(0.25, 0.0, 3.0));
    }
}
