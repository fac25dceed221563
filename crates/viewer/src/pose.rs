//! Where the eye is, and how it moves.

use glam::{DQuat, DVec3, Vec3};
use metaball::{Camera, Viewpoint};

/// The least angle between the direction of view and the axis that is up, radians.
const LEAST_TILT: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// An eye and what it turns about, in the coordinates of the scene's file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The eye.
    pub eye: DVec3,
    /// The middle of the picture, about which the eye turns.
    pub look_at: DVec3,
    /// The axis that is up in the picture; a unit vector.
    pub up: DVec3,
    /// Degrees from the bottom of the picture to its top.
    pub fov: f32,
}

impl Pose {
    /// That of a camera in a scene whose coordinates begin at `origin`. It turns about the point of its
    /// middle ray that is nearest to `middle`, in the scene's coordinates.
    pub fn of(camera: &Camera, origin: DVec3, middle: Vec3) -> Self {
        let (eye, forward) = (camera.eye().as_dvec3(), camera.forward().as_dvec3());
        let ahead = (middle.as_dvec3() - eye).dot(forward);
        let distance = if ahead > 0.0 { ahead } else { 1.0 };
        Self {
            eye: eye + origin,
            look_at: eye + distance * forward + origin,
            up: axis_up(camera),
            fov: 2.0 * camera.half_height().atan().to_degrees(),
        }
    }

    /// The same as options of drawing.
    pub fn viewpoint(&self) -> Viewpoint {
        Viewpoint {
            eye: Some(self.eye),
            look_at: Some(self.look_at),
            up: Some(self.up.as_vec3()),
            fov: Some(self.fov),
        }
    }

    /// From the eye to what it looks at.
    pub fn distance(&self) -> f64 {
        self.eye.distance(self.look_at)
    }

    /// Unit vectors to the right of the picture, to its top, and into it.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.look_at - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }

    /// Scene units that a picture of unit height shows at this distance.
    pub fn height_at(&self, distance: f64) -> f64 {
        2.0 * distance * (0.5 * f64::from(self.fov)).to_radians().tan()
    }

    /// Turned about what it looks at: about the axis that is up, and over it as far as it goes; radians.
    #[must_use]
    pub fn orbited(&self, right: f64, up: f64) -> Self {
        let [across, _, forward] = self.axes();
        let tilt = self.up.angle_between(-forward);
        let up = tilt - (tilt - up).clamp(LEAST_TILT, std::f64::consts::PI - LEAST_TILT);
        let turn = DQuat::from_axis_angle(self.up, -right) * DQuat::from_axis_angle(across, -up);
        Self { eye: self.look_at + turn * (self.eye - self.look_at), ..*self }
    }

    /// Rolled to the right about the direction of view, radians.
    #[must_use]
    pub fn rolled(&self, right: f64) -> Self {
        let [_, up, forward] = self.axes();
        Self { up: (DQuat::from_axis_angle(forward, right) * up).normalize(), ..*self }
    }

    /// Moved by scene units to the right, upwards, and into the picture.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        let [right, up, forward] = self.axes();
        let by = by.x * right + by.y * up + by.z * forward;
        Self { eye: self.eye + by, look_at: self.look_at + by, ..*self }
    }

    /// At this share of its distance from a point, which stays where it is in the picture.
    #[must_use]
    pub fn zoomed(&self, about: DVec3, share: f64) -> Self {
        let moved = |point: DVec3| about + share * (point - about);
        Self { eye: moved(self.eye), look_at: moved(self.look_at), ..*self }
    }

    /// Looking at another point from the same side and distance.
    #[must_use]
    pub fn centered(&self, look_at: DVec3) -> Self {
        Self { eye: self.eye + (look_at - self.look_at), look_at, ..*self }
    }

    /// Looking at the same point along an axis: `from` points from it to the eye.
    #[must_use]
    pub fn seen_from(&self, from: DVec3) -> Self {
        let from = from.normalize();
        let upright = [self.up, DVec3::Y, DVec3::Z, DVec3::X];
        let is_free = |up: &DVec3| from.cross(*up).length() > 0.1;
        let up = upright.into_iter().find(is_free).unwrap_or(self.up);
        Self { eye: self.look_at + self.distance() * from, up, ..*self }
    }
}

/// The axis of the world that is straight up in a camera's picture, or the picture's own up.
fn axis_up(camera: &Camera) -> DVec3 {
    let is_up =
        |axis: &Vec3| camera.right().dot(*axis).abs() < 1e-6 && camera.up().dot(*axis) > 0.1;
    let upright = [Vec3::Y, Vec3::Z].into_iter().find(is_up);
    upright.unwrap_or(camera.up()).as_dvec3().normalize()
}

#[cfg(test)]
mod tests {
    use metaball::Scene;
    use metaball_core::{Kernel, Metaball};

    use super::*;

    const ORIGIN: DVec3 = DVec3::new(5e6, 1.0, -3e5);

    fn scene() -> Scene {
        let ball = Metaball::new(Vec3::new(0.5, 0.0, 0.0), 1.0);
        Scene::new([ball], Kernel::QUARTIC, 0.25).expect("legal").with_origin(ORIGIN)
    }

    fn own() -> Camera {
        Camera::upright(Vec3::new(1.0, 2.0, 5.0), Vec3::ZERO, 40.0).expect("legal")
    }

    fn pose() -> Pose {
        Pose::of(&own(), ORIGIN, Vec3::ZERO)
    }

    fn camera(pose: &Pose) -> Camera {
        pose.viewpoint().camera(&own(), &scene()).expect("a camera")
    }

    /// Where a point of the file is in the picture: to the right and up, at unit distance.
    fn seen(pose: &Pose, point: DVec3) -> (f64, f64) {
        let [right, up, forward] = pose.axes();
        let ray = point - pose.eye;
        (ray.dot(right) / ray.dot(forward), ray.dot(up) / ray.dot(forward))
    }

    fn assert_near(found: DVec3, wanted: DVec3) {
        assert!((found - wanted).length() < 1e-6, "{found} for {wanted}");
    }

    #[test]
    fn a_pose_is_the_camera_that_it_came_from() {
        let (found, wanted) = (camera(&pose()), own());
        for (found, wanted) in [
            (found.eye(), wanted.eye()),
            (found.right(), wanted.right()),
            (found.up(), wanted.up()),
            (found.forward(), wanted.forward()),
        ] {
            assert!((found - wanted).length() < 1e-5, "{found} for {wanted}");
        }
        assert!((found.half_height() - wanted.half_height()).abs() < 1e-6);
        assert_near(pose().look_at, ORIGIN);
        assert_eq!(pose().up, DVec3::Y);
        let tilted = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), 40.0);
        let tilted = Pose::of(&tilted.expect("legal"), DVec3::ZERO, Vec3::ZERO);
        assert_near(tilted.up, DVec3::new(1.0, 1.0, 0.0).normalize());
    }

    #[test]
    fn orbits_keep_distance_and_middle_and_stop_at_the_poles() {
        let turned = pose().orbited(0.4, -0.3);
        assert!((turned.distance() - pose().distance()).abs() < 1e-6);
        assert_eq!(turned.look_at, pose().look_at);
        assert_near(turned.orbited(-0.4, 0.0).orbited(0.0, 0.3).eye, pose().eye);
        let top = pose().orbited(0.0, 10.0);
        assert!((top.eye - top.look_at).normalize().y > 0.9999);
        assert!(camera(&top).up().is_finite());
        let bottom = top.orbited(0.0, -10.0);
        assert!((bottom.eye - bottom.look_at).normalize().y < -0.9999);
        // A drag to the right shows what was to the left.
        let front = Pose { eye: ORIGIN + 5.0 * DVec3::Z, ..pose() };
        assert!(front.orbited(0.1, 0.0).eye.x < ORIGIN.x);
        assert!(front.orbited(0.0, 0.1).eye.y > ORIGIN.y);
    }

    #[test]
    fn zooming_keeps_the_point_under_the_cursor() {
        let point = ORIGIN + DVec3::new(0.7, -0.4, 0.2);
        let near = pose().zoomed(point, 0.25);
        let (before, after) = (seen(&pose(), point), seen(&near, point));
        assert!((before.0 - after.0).abs() < 1e-6 && (before.1 - after.1).abs() < 1e-6);
        assert!((near.eye.distance(point) - 0.25 * pose().eye.distance(point)).abs() < 1e-6);
    }

    #[test]
    fn moves_follow_the_picture() {
        let [right, up, forward] = pose().axes();
        let moved = pose().moved(DVec3::new(1.0, 2.0, 3.0));
        assert_near(moved.eye - pose().eye, right + 2.0 * up + 3.0 * forward);
        assert!((pose().height_at(2.0) - 4.0 * 20f64.to_radians().tan()).abs() < 1e-6);
        let rolled = pose().rolled(0.5);
        assert!(rolled.axes()[1].dot(right) > 0.4);
        assert_near(rolled.axes()[2], forward);
        let centered = pose().centered(ORIGIN + DVec3::X);
        assert_near(centered.eye - pose().eye, DVec3::X);
    }

    #[test]
    fn axes_views_have_an_upright_picture() {
        for from in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
            let pose = pose().seen_from(from);
            assert_near(pose.axes()[2], -from);
            assert!(camera(&pose).forward().dot(from.as_vec3()) < -0.999);
        }
    }
}
