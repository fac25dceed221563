//! Light: its options.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::Vec3;
use metaball::{FloorKind, LightOptions};

use crate::values::vector;

/// Any of them turns on ray traced light instead of the shared Phong picture.
#[derive(Debug, Args)]
#[command(
    next_help_heading = "Light (shadows, occlusion, mirrored surfaces and refraction need a \
                              method that follows any ray: bvh, fbvh, fbvh-certified)"
)]
pub(crate) struct LightArgs {
    /// Lamps cast shadows.
    #[arg(long)]
    shadows: bool,
    /// A lamp in this direction, world space; may be repeated. A key and a fill lamp that move with
    /// the camera when left out.
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    lamp: Vec<Vec3>,
    /// Width of all lamps in degrees, for soft shadows; 0 for hard ones.
    #[arg(long, value_name = "DEGREES", requires = "shadows", allow_negative_numbers = true)]
    lamp_size: Option<f32>,
    /// Occlusion rays from each surface point.
    #[arg(long, value_name = "RAYS", value_parser = clap::value_parser!(u32).range(1..))]
    ambient_occlusion: Option<u32>,
    /// Where occlusion rays end, scene units; they cross the whole scene when left out.
    #[arg(long, value_name = "LENGTH", requires = "ambient_occlusion")]
    #[arg(allow_negative_numbers = true)]
    occlusion_reach: Option<f32>,
    /// Levels of mirror reflection; 0 mirrors the surroundings alone.
    #[arg(long, value_name = "LEVELS", conflicts_with = "refraction")]
    reflections: Option<u32>,
    /// Share of light mirrored at normal incidence, 0 to 1; 0.3 when left out.
    #[arg(long, value_name = "SHARE", requires = "reflections", allow_negative_numbers = true)]
    reflectivity: Option<f32>,
    /// A clear fluid of this index of refraction, such as 1.33. Needs the certified tree.
    #[arg(long, value_name = "INDEX", group = "layers", allow_negative_numbers = true)]
    #[arg(conflicts_with_all = ["shadows", "ambient_occlusion", "cel"])]
    refraction: Option<f32>,
    /// What the fluid absorbs of red, green and blue per scene unit; a little red over the scene's
    /// radius when left out.
    #[arg(long, value_name = "R,G,B", value_parser = vector, requires = "refraction")]
    #[arg(allow_hyphen_values = true)]
    absorption: Option<Vec3>,
    /// A see-through surface: its share in what is seen through it, 0 to 1. Each layer that a ray
    /// meets, where it enters the solid and where it leaves it, is lit as an opaque surface is and
    /// laid over what lies behind; what any number of them shadows has 1 − A of the light. Needs the
    /// certified tree, and the CPU.
    #[arg(long, value_name = "A", group = "layers", allow_negative_numbers = true)]
    #[arg(conflicts_with = "reflections")]
    opacity: Option<f32>,
    /// Surfaces seen through others, in the fluid or the see-through solid; behind the last there are
    /// the surroundings. 8 when left out.
    #[arg(long, value_name = "N", requires = "layers")]
    bounces: Option<u32>,
    /// What the scene stands on, below its lowest ball.
    #[arg(long, value_name = "KIND", value_enum)]
    floor: Option<FloorArg>,
    /// The surroundings: an equirectangular .hdr or .exr image. A generated sky when left out.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Bands of light in cel shading.
    #[arg(long, value_name = "BANDS", value_parser = clap::value_parser!(u32).range(1..))]
    cel: Option<u32>,
    /// Darken what lies behind something near, around it: depth-cued unsharp masking, such as 1.
    #[arg(long, value_name = "STRENGTH", allow_negative_numbers = true)]
    depth_cue: Option<f32>,
    /// Paths of light a pixel; more than one smooths edges. 1 when left out, 64 in a fluid.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Which random numbers.
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Brighten the picture by powers of two.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<f32>,
}

/// What a scene stands on.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum FloorArg {
    /// Of one colour.
    Plain,
    /// Tiles in two shades.
    Tiles,
}

impl LightArgs {
    pub(crate) fn options(self) -> LightOptions {
        LightOptions {
            shadows: self.shadows,
            lamps: self.lamp,
            lamp_size: self.lamp_size,
            ambient_occlusion: self.ambient_occlusion,
            occlusion_reach: self.occlusion_reach,
            reflections: self.reflections,
            reflectivity: self.reflectivity,
            refraction: self.refraction,
            absorption: self.absorption,
            opacity: self.opacity,
            bounces: self.bounces,
            floor: self.floor.map(|floor| match floor {
                FloorArg::Plain => FloorKind::Plain,
                FloorArg::Tiles => FloorKind::Tiles,
            }),
            environment: self.environment,
            cel: self.cel,
            depth_cue: self.depth_cue,
            samples: self.samples,
            seed: self.seed,
            exposure: self.exposure,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, parse};

    #[test]
    fn options_reach_the_library() {
        let line = "metaball render molecule --shadows --lamp 0,1,0 --lamp -1,0.5,0 --lamp-size 12 \
                    --ambient-occlusion 64 --occlusion-reach 3 --reflections 2 --reflectivity 0.5 \
                    --floor tiles --environment lake.hdr --cel 3 --depth-cue 1 --samples 4 --seed 7 \
                    --exposure -0.5";
        let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
        let wanted = LightOptions {
            shadows: true,
            lamps: vec![Vec3::Y, Vec3::new(-1.0, 0.5, 0.0)],
            lamp_size: Some(12.0),
            ambient_occlusion: Some(64),
            occlusion_reach: Some(3.0),
            reflections: Some(2),
            reflectivity: Some(0.5),
            floor: Some(FloorKind::Tiles),
            environment: Some("lake.hdr".into()),
            cel: Some(3),
            depth_cue: Some(1.0),
            samples: Some(4),
            seed: Some(7),
            exposure: Some(-0.5),
            ..LightOptions::default()
        };
        assert_eq!(render.light(), wanted);
        let line = "metaball render splash --refraction 1.33 --absorption 1,0,0 --bounces 4";
        let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
        let wanted = LightOptions {
            refraction: Some(1.33),
            absorption: Some(Vec3::X),
            bounces: Some(4),
            ..LightOptions::default()
        };
        assert_eq!(render.light(), wanted);
        let line = "metaball render splash --opacity 0.4 --shadows --bounces 5";
        let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
        let wanted = LightOptions {
            shadows: true,
            opacity: Some(0.4),
            bounces: Some(5),
            ..LightOptions::default()
        };
        assert_eq!(render.light(), wanted);
        let Ok(Command::Render(plain)) = parse("metaball render molecule") else {
            panic!("a legal command line")
        };
        assert!(!plain.light().is_asked());
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        for line in [
            "--refraction 1.33 --shadows",
            "--refraction 1.33 --reflections 1",
            "--opacity 0.5 --refraction 1.33",
            "--opacity 0.5 --reflections 1",
            "--lamp-size 3",
            "--reflectivity 0.5",
            "--absorption 1,0,0",
            "--bounces 4",
            "--occlusion-reach 2",
            "--cel 0",
            "--samples 0",
        ] {
            assert!(parse(&format!("metaball render molecule {line}")).is_err(), "{line}");
        }
    }
}
