//! Another camera than the scene's own: its options.

use clap::Args;
use glam::{DVec3, Vec3};
use metaball::Viewpoint;
use metaball_core::CameraError;

use crate::values::{point, vector};

#[derive(Debug, Args)]
#[command(next_help_heading = "Camera (the scene's own where left out)")]
pub(crate) struct CameraArgs {
    /// The eye, in the file's coordinates. Alone it looks at the middle of the scene.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    eye: Option<DVec3>,
    /// What it looks at, in the file's coordinates.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// What is up in the picture; for another eye or direction the y axis, or the z axis where the view is
    /// along that.
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    up: Option<Vec3>,
    /// Degrees from the bottom of the picture to its top.
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f32>,
}

impl CameraArgs {
    pub(crate) fn viewpoint(&self) -> Viewpoint {
        let &Self { eye, look_at, up, fov } = self;
        Viewpoint { eye, look_at, up, fov }
    }
}

/// The error, with an option as it is written on the command line.
pub(crate) fn by_flag(error: CameraError) -> anyhow::Error {
    match error {
        CameraError::Up { found } => {
            anyhow::anyhow!("--up: needed a direction that is not along the view's, found {found}")
        }
        CameraError::FieldOfView { found } => {
            anyhow::anyhow!("--fov: needed an angle above 0 and below 180, found {found}")
        }
        CameraError::NoDirection { found } => {
            anyhow::anyhow!("--eye, --look-at: needed two points, found both at {found}")
        }
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use metaball::Camera;

    use super::*;

    #[test]
    fn mistakes_are_named_by_their_options() {
        let refused = |eye, up, fov| {
            let camera = Camera::look_at(eye, Vec3::ZERO, up, fov);
            by_flag(camera.expect_err("refused")).to_string()
        };
        assert!(refused(Vec3::Y, Vec3::Y, 38.0).starts_with("--up: needed"));
        assert!(refused(Vec3::Z, Vec3::Y, 180.0).ends_with("found 180"));
        assert!(refused(Vec3::ZERO, Vec3::Y, 38.0).starts_with("--eye, --look-at: needed"));
    }
}
