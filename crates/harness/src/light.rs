//! The effects of the commands `render` and `animate`: their options, and pictures lit by them.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, bail, ensure};
use clap::{Args, ValueEnum};
use exr::prelude::{SpecificChannels, WritableImage};
use fbvh::Kind;
use glam::Vec3;
use image::{DynamicImage, ImageReader};
use metaball_core::gpu::{Gpu, Image, IsoRenderer};
use metaball_core::{Camera, Hit, NO_LIMIT, Scene, View};
use metaball_light::{
    Effects, Environment, Film, Floor, Lamp, Occlusion, Panorama, PathTracer, Surface,
};

use crate::camera::vector;
use crate::measure::milliseconds;
use crate::methods::tree_options;
use crate::numbers::decimal;
use crate::output::write_atomically;

/// Surfaces that are seen through each other in a clear fluid unless asked otherwise.
const FLUID_BOUNCES: u32 = 8;

/// Standard deviation of the depth cue's Gaussian, in parts of the picture's height.
const DEPTH_CUE_WIDTH: f32 = 0.02;

/// How far a floor goes, in the scene's radius.
const FLOOR_REACH: f32 = 3.0;

/// Its colour, linear.
const FLOOR_COLOR: Vec3 = Vec3::new(0.60, 0.56, 0.50);

/// Tiles of a floor along the scene's radius.
const TILES_PER_RADIUS: f32 = 5.0;

/// Options of light. Any of them asks for ray traced light in place of the shared Phong picture.
#[derive(Debug, Clone, Default, PartialEq, Args)]
#[command(
    next_help_heading = "Light (shadows, occlusion, mirrored surfaces and refraction need a \
                              method that follows any ray: bvh, fbvh, fbvh-certified)"
)]
pub struct LightOptions {
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
    /// Rays from each surface point that feel for the surroundings.
    #[arg(long, value_name = "RAYS", value_parser = clap::value_parser!(u32).range(1..))]
    ambient_occlusion: Option<u32>,
    /// Where occlusion rays end, scene units; they feel the whole scene when left out.
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
    #[arg(long, value_name = "INDEX", allow_negative_numbers = true)]
    #[arg(conflicts_with_all = ["shadows", "ambient_occlusion", "cel"])]
    refraction: Option<f32>,
    /// What the fluid takes up of red, green and blue per scene unit; a little red over the scene's
    /// radius when left out.
    #[arg(long, value_name = "R,G,B", value_parser = vector, requires = "refraction")]
    #[arg(allow_hyphen_values = true)]
    absorption: Option<Vec3>,
    /// Surfaces seen through each other in the fluid; 8 when left out.
    #[arg(long, value_name = "N", requires = "refraction")]
    bounces: Option<u32>,
    /// What the scene stands on, below its lowest ball.
    #[arg(long, value_name = "KIND", value_enum)]
    floor: Option<FloorKind>,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FloorKind {
    /// Of one colour.
    Plain,
    /// Tiles in two shades.
    Tiles,
}

/// Light for any number of pictures by one camera: what its options ask for, checked and read.
pub struct Lighting {
    effects: Effects,
    samples: u32,
    seed: u32,
    depth_cue: Option<f32>,
    stops: f32,
}

/// A picture in the light asked for, and how long it took.
pub struct Lit {
    /// Linear light.
    pub film: Film,
    /// The same, developed.
    pub image: Image,
    /// Paths a pixel.
    pub samples: u32,
    /// Wall time of all samples.
    pub ms: f64,
    /// Rays of the last sample that the method could not answer.
    pub doubts: u64,
}

impl LightOptions {
    /// Whether any light is asked for.
    pub fn is_asked(&self) -> bool {
        *self != Self::default()
    }

    /// Whether the method answers all that the effects ask.
    pub fn is_given_by(&self, method: &str) -> bool {
        let follows = self.shadows
            || self.ambient_occlusion.is_some()
            || self.refraction.is_some()
            || self.reflections.is_some_and(|levels| levels > 0);
        let tree = tree_options(method).map(|options| options.kind());
        !follows || tree.is_some_and(|kind| self.refraction.is_none() || kind == Kind::Certified)
    }

    /// The light for a camera's pictures of a scene, or of one that moves and begins like this.
    ///
    /// # Errors
    /// When an option makes no sense or a file is not readable: names it.
    pub fn lighting(&self, camera: &Camera, scene: &Scene) -> anyhow::Result<Lighting> {
        let fallback = if self.refraction.is_some() { 64 } else { 1 };
        Ok(Lighting {
            effects: self.effects(camera, scene)?,
            samples: self.samples.unwrap_or(fallback),
            seed: self.seed.unwrap_or_default(),
            depth_cue: self.depth_cue.map(|cue| at_least(0.0, "--depth-cue", cue)).transpose()?,
            stops: at_least(f32::MIN, "--exposure", self.exposure.unwrap_or_default())?,
        })
    }

    fn effects(&self, camera: &Camera, scene: &Scene) -> anyhow::Result<Effects> {
        let base = Effects::phong(camera);
        let diameter = self.lamp_size.unwrap_or_default();
        ensure!(
            (0.0..=180.0).contains(&diameter),
            "--lamp-size: needed degrees from 0 to 180, found {diameter}"
        );
        ensure!(!self.lamp.contains(&Vec3::ZERO), "--lamp: needed a direction, found 0,0,0");
        let lamps = if self.lamp.is_empty() {
            base.lamps.iter().map(|lamp| Lamp { diameter, ..*lamp }).collect()
        } else {
            // Together as bright as the key lamp that they replace.
            let color = base.lamps[0].color / self.lamp.len() as f32;
            self.lamp.iter().map(|&toward| Lamp { toward, diameter, color }).collect()
        };
        let reach = self.occlusion_reach.map(|reach| at_least(0.0, "--occlusion-reach", reach));
        let reach = reach.transpose()?.unwrap_or(NO_LIMIT);
        Ok(Effects {
            surface: self.surface(radius_of(scene))?,
            lamps,
            shadows: self.shadows,
            occlusion: self.ambient_occlusion.map(|rays| Occlusion { rays, reach }),
            bounces: match self.refraction {
                Some(_) => self.bounces.unwrap_or(FLUID_BOUNCES),
                None => self.reflections.unwrap_or_default(),
            },
            floor: self.floor.map(|kind| floor(kind, scene)),
            environment: match &self.environment {
                Some(path) => Environment::Panorama(read_panorama(path)?),
                None => Environment::Sky,
            },
            bands: self.cel.unwrap_or_default(),
        })
    }

    fn surface(&self, radius: f32) -> anyhow::Result<Surface> {
        if let Some(refraction) = self.refraction {
            ensure!(
                refraction > 0.0 && refraction.is_finite(),
                "--refraction: needed a finite index above 0, found {refraction}"
            );
            let watery = Vec3::new(0.9, 0.28, 0.12) / radius;
            let absorption = self.absorption.unwrap_or(watery);
            ensure!(
                absorption.min_element() >= 0.0,
                "--absorption: needed numbers of at least 0, found {absorption}"
            );
            return Ok(Surface::Fluid { refraction, absorption });
        }
        let reflectivity = match self.reflections {
            Some(_) => self.reflectivity.unwrap_or(0.3),
            None => 0.0,
        };
        ensure!(
            (0.0..=1.0).contains(&reflectivity),
            "--reflectivity: needed a share from 0 to 1, found {reflectivity}"
        );
        Ok(Surface::Opaque { reflectivity })
    }
}

/// A floor that a scene stands on: so large that its edge is nowhere in the scene's way.
fn floor(kind: FloorKind, scene: &Scene) -> Floor {
    let lowest = scene.balls().filter_map(|ball| {
        let core = scene.kernel().core_radius(&ball, scene.threshold())? as f32;
        Some(ball.center.y - core)
    });
    let bounds = scene.bounds();
    let lowest = lowest.reduce(f32::min).unwrap_or(bounds.min.y);
    let radius = radius_of(scene);
    Floor {
        middle: bounds.center().with_y(lowest),
        reach: FLOOR_REACH * radius,
        color: FLOOR_COLOR,
        tile: match kind {
            FloorKind::Plain => 0.0,
            FloorKind::Tiles => radius / TILES_PER_RADIUS,
        },
    }
}

/// Half of the diagonal of the scene's bounds, above 0.
fn radius_of(scene: &Scene) -> f32 {
    let bounds = scene.bounds();
    let diagonal = if bounds.is_empty() { 2.0 } else { bounds.extent().length() };
    (0.5 * diagonal).max(f32::MIN_POSITIVE)
}

impl Lighting {
    /// Paths of light a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Exposes a picture. `renderer` has built the scene; `hits` are the view's first hits.
    ///
    /// # Errors
    /// When the method cannot follow the rays, or the device fails.
    pub fn expose(
        &self,
        gpu: &Gpu,
        renderer: &mut dyn IsoRenderer,
        scene: &Scene,
        view: &View,
        hits: &[Hit],
        mut after_sample: impl FnMut(),
    ) -> anyhow::Result<Lit> {
        let samples = self.samples;
        let mut tracer =
            PathTracer::new(gpu, scene, view, self.effects.clone(), samples, self.seed)?;
        let start = Instant::now();
        for _ in 0..samples {
            tracer.add_sample(renderer)?;
            after_sample();
        }
        let ms = milliseconds(start.elapsed());
        let mut film = tracer.film()?;
        if let Some(strength) = self.depth_cue {
            film.cue_depth(hits, DEPTH_CUE_WIDTH, strength);
        }
        let image = film.develop(self.stops);
        Ok(Lit { film, image, samples, ms, doubts: tracer.undecided()? })
    }
}

/// Writes linear light as an OpenEXR file.
///
/// # Errors
/// When the file cannot be written.
pub fn write_light(path: &Path, film: &Film) -> anyhow::Result<()> {
    let (width, height) = (film.width as usize, film.height as usize);
    let pixel = |at: exr::math::Vec2<usize>| {
        let light = film.light[at.y() * width + at.x()];
        (light.x, light.y, light.z)
    };
    let mut file = Cursor::new(Vec::new());
    exr::image::Image::from_channels((width, height), SpecificChannels::rgb(pixel))
        .write()
        .to_buffered(&mut file)
        .with_context(|| format!("cannot encode {}", path.display()))?;
    write_atomically(path, file.get_ref())
}

/// The finite number that an option has, not below the least.
fn at_least(least: f32, option: &str, found: f32) -> anyhow::Result<f32> {
    ensure!(found.is_finite(), "{option}: needed a finite number, found {found}");
    ensure!(found >= least, "{option}: needed at least {least}, found {found}");
    Ok(found)
}

/// Linear light from a file that holds linear light.
fn read_panorama(path: &Path) -> anyhow::Result<Panorama> {
    let name = path.display();
    let image = ImageReader::open(path)
        .with_context(|| format!("cannot open {name}"))?
        .with_guessed_format()
        .with_context(|| format!("cannot read {name}"))?
        .decode()
        .with_context(|| format!("cannot decode {name}"))?;
    let (DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) = image else {
        bail!("environment {name}: needed an .hdr or .exr image, found {:?}", image.color());
    };
    let image = image.into_rgb32f();
    let light = image.pixels().map(|pixel| Vec3::from(pixel.0));
    Ok(Panorama::new(image.width(), image.height(), light)?)
}

/// What the picture took, for the console.
pub fn facts(lit: &Lit) -> String {
    let each = decimal(lit.ms / f64::from(lit.samples));
    let doubts = if lit.doubts == 0 {
        String::new()
    } else {
        format!(", {} rays undecided in the last", lit.doubts)
    };
    format!("{} samples of {each} ms{doubts}", lit.samples)
}

#[cfg(test)]
pub(crate) mod tests {
    use bench_scenes::{Overrides, load};
    use clap::FromArgMatches;

    use super::*;
    use crate::output::tests::scratch;

    /// The options of a command line that has no others.
    pub(crate) fn options(line: &str) -> LightOptions {
        let command = LightOptions::augment_args(clap::Command::new("light").no_binary_name(true));
        let matches = command.try_get_matches_from(line.split(' ')).expect("options of light");
        LightOptions::from_arg_matches(&matches).expect("options of light")
    }

    #[test]
    fn raster_methods_give_what_ends_at_the_first_surface() {
        for line in ["--cel 4", "--reflections 0", "--depth-cue 1 --samples 4 --floor plain"] {
            assert!(options(line).is_given_by("illes") && options(line).is_given_by("fbvh"));
        }
        for line in ["--shadows", "--ambient-occlusion 4", "--reflections 1"] {
            assert!(!options(line).is_given_by("illes") && options(line).is_given_by("fbvh"));
        }
        let fluid = options("--refraction 1.33");
        assert!(!fluid.is_given_by("fbvh") && fluid.is_given_by("fbvh-certified"));
    }

    #[test]
    fn nonsense_is_named() {
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let message = |line: &str| {
            let lighting = options(line).lighting(&bench.camera, &bench.scene);
            lighting.err().expect(line).to_string()
        };
        for (before, option, values) in [
            ("", "--refraction", &["0", "-1", "inf"][..]),
            ("--refraction 1.33 ", "--absorption", &["0,-1,0"]),
            ("--reflections 1 ", "--reflectivity", &["2", "-0.1", "nan"]),
            ("", "--lamp", &["0,0,0"]),
            ("--shadows ", "--lamp-size", &["-1", "181", "nan"]),
            ("--ambient-occlusion 4 ", "--occlusion-reach", &["-1", "nan"]),
            ("", "--depth-cue", &["-1", "inf"]),
            ("", "--exposure", &["nan"]),
        ] {
            for value in values {
                let message = message(&format!("{before}{option} {value}"));
                assert!(message.starts_with(&format!("{option}: needed")), "{message}");
            }
        }
        assert_eq!(message("--environment nowhere.hdr"), "cannot open nowhere.hdr");
    }

    #[test]
    fn light_goes_through_a_file() {
        let folder = scratch("light");
        let path = folder.join("light.exr");
        let light = vec![Vec3::new(0.25, 4.0, 0.0), Vec3::splat(1e-3)];
        let film = Film { width: 2, height: 1, light: light.clone() };
        write_light(&path, &film).expect("written");
        let panorama = read_panorama(&path).expect("readable");
        std::fs::remove_dir_all(folder).expect("removable");
        assert_eq!(Panorama::new(2, 1, light).expect("light"), panorama);
    }
}
