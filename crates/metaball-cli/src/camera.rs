//! Another camera than the scene's own: its options.

use clap::Args;
use glam::Vec3;
use metaball::Viewpoint;

use crate::values::vector;

#[derive(Debug, Args)]
#[command(next_help_heading = "Camera (the scene's own where left out)")]
pub(crate) struct CameraArgs {
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

impl CameraArgs {
    pub(crate) fn viewpoint(&self) -> Viewpoint {
        let &Self { eye, look_at, up, fov } = self;
        Viewpoint { eye, look_at, up, fov }
    }
}
