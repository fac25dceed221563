//! Another camera than the scene's own: its options.

use clap::Args;
use glam::Vec3;
use metaball_core::{Camera, CameraError};

/// Options of the camera.
#[derive(Debug, Clone, Copy, Default, PartialEq, Args)]
#[command(next_help_heading = "Camera (the scene's own where left out)")]
pub struct CameraOptions {
    /// The eye, world space. Alone it looks at the middle of the scene.
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    eye: Option<Vec3>,
    /// What it looks at, world space.
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    look_at: Option<Vec3>,
    /// What is up in the picture; the y axis for another eye or direction.
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    up: Option<Vec3>,
    /// Degrees from the bottom of the picture to its top.
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f32>,
}

impl CameraOptions {
    /// Whether any other camera is asked for.
    pub fn is_asked(&self) -> bool {
        *self != Self::default()
    }

    /// The camera asked for, of a scene that has one of its own and this middle.
    ///
    /// # Errors
    /// When the options make no camera.
    pub fn camera(&self, own: &Camera, middle: Vec3) -> Result<Camera, CameraError> {
        if !self.is_asked() {
            return Ok(*own);
        }
        let eye = self.eye.unwrap_or(own.eye());
        let ahead = if self.eye.is_some() { middle } else { eye + own.forward() };
        let turns = self.eye.is_some() || self.look_at.is_some();
        let up = self.up.unwrap_or(if turns { Vec3::Y } else { own.up() });
        let degrees = self.fov.unwrap_or(2.0 * own.half_height().atan().to_degrees());
        Camera::look_at(eye, self.look_at.unwrap_or(ahead), up, degrees)
    }
}

/// Three numbers with commas between.
pub(crate) fn vector(text: &str) -> Result<Vec3, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if Vec3::new(x, y, z).is_finite() => Ok(Vec3::new(x, y, z)),
        _ => Err("needed three numbers such as 0.5,1,-0.3".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_three_numbers() {
        assert_eq!(vector("1,-2, 0.5"), Ok(Vec3::new(1.0, -2.0, 0.5)));
        assert!(vector("1,2").is_err() && vector("1,2,nan").is_err() && vector("a,b,c").is_err());
    }

    #[test]
    fn what_is_left_out_is_the_scenes_own() {
        let own = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::X, 30.0).expect("legal");
        let camera = |options: CameraOptions| options.camera(&own, Vec3::Y);
        assert_eq!(camera(CameraOptions::default()), Ok(own));
        let near = camera(CameraOptions { fov: Some(10.0), ..Default::default() });
        let near = near.expect("a camera");
        assert_eq!((near.eye(), near.up()), (own.eye(), own.up()));
        assert!(near.half_height() < 0.5 * own.half_height());
        let moved = camera(CameraOptions { eye: Some(Vec3::X), ..Default::default() });
        let moved = moved.expect("a camera");
        assert!((moved.forward() - (Vec3::Y - Vec3::X).normalize()).length() < 1e-6);
        assert!((moved.half_height() - own.half_height()).abs() < 1e-6);
        let within = CameraOptions { look_at: Some(Vec3::Z), ..Default::default() };
        assert!(camera(within).is_err());
    }
}
