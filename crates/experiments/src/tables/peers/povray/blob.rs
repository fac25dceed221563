//! A scene and a view of it in POV-Ray's language.

use std::fmt::Write;

use glam::DVec3;
use metaball_core::{Scene, View};

/// What a blob is drawn in, in POV-Ray's language.
#[derive(Debug, Default)]
pub(super) struct Look {
    /// What stands in its `global_settings`.
    pub(super) settings: String,
    /// Lights and background.
    pub(super) around: String,
    /// Pigment and finish.
    pub(super) surface: String,
}

/// The scene's file. The field is that of α = 2 whatever the scene's kernel is.
///
/// POV-Ray's axes are left-handed by convention only: its camera takes any three vectors.
pub(super) fn scene_text(scene: &Scene, view: &View, look: &Look) -> String {
    let camera = view.camera();
    let height = 2.0 * f64::from(camera.half_height());
    let width = height * f64::from(view.width()) / f64::from(view.height());
    let mut text = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 {} }}\n\
         camera {{ perspective location {} direction {} right {} up {} }}\n\
         {}\nblob {{ threshold {:e}\n",
        look.settings,
        vector(camera.eye().as_dvec3()),
        vector(camera.forward().as_dvec3()),
        vector(width * camera.right().as_dvec3()),
        vector(height * camera.up().as_dvec3()),
        look.around,
        scene.threshold()
    );
    for ball in scene.balls() {
        let center = vector(ball.center.as_dvec3());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "sphere {{ {center}, {:e}, {:e} }}", ball.radius, ball.strength);
    }
    text + &look.surface + " }\n"
}

pub(super) fn vector(vector: DVec3) -> String {
    format!("<{:e},{:e},{:e}>", vector.x, vector.y, vector.z)
}
