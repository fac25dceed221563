//! What light may be asked for.

use std::path::PathBuf;

use fbvh::Kind;
use glam::Vec3;
use metaball_core::{Camera, NO_LIMIT, Scene};
use metaball_light::{Effects, Environment, Floor, Lamp, Occlusion, Panorama, Surface};
use picture_files::read_light;

use super::Lighting;
use crate::{Error, Method};

/// Surfaces that are seen through each other, in a clear fluid or a see-through solid, unless asked
/// otherwise.
const LAYERS: u32 = 8;

/// How far a floor goes, in the scene's radius.
const FLOOR_REACH: f32 = 3.0;

/// Its colour, linear.
const FLOOR_COLOR: Vec3 = Vec3::new(0.60, 0.56, 0.50);

/// Tiles of a floor along the scene's radius.
const TILES_PER_RADIUS: f32 = 5.0;

/// Options of light; `None` and `false` leave an effect out, or to its default. Any of them asks for
/// ray traced light instead of the shared Phong picture.
///
/// Shadows, occlusion, mirrored surfaces and refraction need a method that follows any ray, which the
/// trees are; refraction and opacity need the certified one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightOptions {
    /// Lamps cast shadows.
    pub shadows: bool,
    /// Lamps in these directions, world space, any length above 0. A key and a fill lamp that move
    /// with the camera when empty.
    pub lamps: Vec<Vec3>,
    /// Width of all lamps in degrees, 0 to 180, for soft shadows; 0 for hard ones.
    pub lamp_size: Option<f32>,
    /// Occlusion rays from each surface point.
    pub ambient_occlusion: Option<u32>,
    /// Where occlusion rays end, scene units; they cross the whole scene when left out.
    pub occlusion_reach: Option<f32>,
    /// Levels of mirror reflection; 0 mirrors the surroundings alone.
    pub reflections: Option<u32>,
    /// Share of light mirrored at normal incidence, 0 to 1; 0.3 when left out.
    pub reflectivity: Option<f32>,
    /// A clear fluid of this index of refraction, above 0, such as 1.33.
    pub refraction: Option<f32>,
    /// What the fluid absorbs of red, green and blue per scene unit; a little red over the scene's
    /// radius when left out.
    pub absorption: Option<Vec3>,
    /// A see-through surface: the share of each layer in what is seen through it, 0 to 1. Layers are
    /// where a ray enters the solid and where it leaves it, each lit as an opaque surface is; what any
    /// number of them shadows has 1 − opacity of the light. Needs the certified tree and the CPU, and
    /// goes with neither reflections nor refraction.
    pub opacity: Option<f32>,
    /// Surfaces seen through others, in the fluid or the see-through solid; behind the last there are the
    /// surroundings. 8 when left out.
    pub bounces: Option<u32>,
    /// What the scene stands on, below its lowest ball; y is up.
    pub floor: Option<FloorKind>,
    /// The surroundings: an equirectangular `.hdr` or `.exr` image. A generated sky when left out.
    pub environment: Option<PathBuf>,
    /// Bands of light in cel shading.
    pub cel: Option<u32>,
    /// Darken what lies behind something near, around it: the strength of depth-cued unsharp masking.
    pub depth_cue: Option<f32>,
    /// Paths of light a pixel; more than one smooths edges. 1 when left out, 64 in a fluid.
    pub samples: Option<u32>,
    /// Which random numbers.
    pub seed: Option<u32>,
    /// Brighten the picture by powers of two.
    pub exposure: Option<f32>,
}

/// What a scene stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FloorKind {
    /// Of one colour.
    Plain,
    /// Tiles in two shades.
    Tiles,
}

impl LightOptions {
    /// Whether any light is asked for.
    pub fn is_asked(&self) -> bool {
        *self != Self::default()
    }

    /// Whether the method answers all rays that the effects need.
    pub fn is_given_by(&self, method: &Method) -> bool {
        self.is_given_by_tree(method.tree().map(|options| options.kind()))
    }

    /// The same of a method by the tree that it traces, if it is one.
    pub(crate) fn is_given_by_tree(&self, tree: Option<Kind>) -> bool {
        let has_secondary_rays = self.shadows
            || self.ambient_occlusion.is_some()
            || self.goes_inside()
            || self.reflections.is_some_and(|levels| levels > 0);
        !has_secondary_rays
            || tree.is_some_and(|kind| !self.goes_inside() || kind == Kind::Certified)
    }

    /// Whether the surface is seen through.
    pub(crate) fn is_see_through(&self) -> bool {
        self.opacity.is_some_and(|opacity| opacity < 1.0)
    }

    /// Whether paths go on inside the solid.
    fn goes_inside(&self) -> bool {
        self.refraction.is_some() || self.is_see_through()
    }

    /// The light for a camera's pictures of a scene, or of one that moves and begins like this.
    ///
    /// # Errors
    /// When an option makes no sense or a file is not readable: names it.
    pub(crate) fn lighting(&self, camera: &Camera, scene: &Scene) -> Result<Lighting, Error> {
        self.go_together()?;
        let samples = if self.refraction.is_some() { 64 } else { 1 };
        Ok(Lighting {
            effects: self.effects(camera, scene)?,
            samples: self.samples.unwrap_or(samples),
            seed: self.seed.unwrap_or_default(),
            depth_cue: self.depth_cue.map(|cue| at_least(0.0, "depth_cue", cue)).transpose()?,
            stops: at_least(f32::MIN, "exposure", self.exposure.unwrap_or_default())?,
        })
    }

    /// Refuses options that would do nothing: beside others that take their place, or without those that they
    /// are about.
    fn go_together(&self) -> Result<(), Error> {
        let layers = self.refraction.is_some() || self.opacity.is_some();
        for (option, is_asked, about, is_there) in [
            ("lamp_size", self.lamp_size.is_some(), "shadows", self.shadows),
            (
                "occlusion_reach",
                self.occlusion_reach.is_some(),
                "ambient_occlusion",
                self.ambient_occlusion.is_some(),
            ),
            (
                "reflectivity",
                self.reflectivity.is_some(),
                "reflections",
                self.reflections.is_some(),
            ),
            ("absorption", self.absorption.is_some(), "refraction", self.refraction.is_some()),
            ("bounces", self.bounces.is_some(), "refraction or opacity", layers),
        ] {
            require(is_there || !is_asked, option, format!("{about} beside it"), "none")?;
        }
        for (option, is_asked) in [
            ("shadows", self.shadows),
            ("ambient_occlusion", self.ambient_occlusion.is_some()),
            ("reflections", self.reflections.is_some()),
            ("cel", self.cel.is_some()),
        ] {
            let is_alone = self.refraction.is_none() || !is_asked;
            require(is_alone, option, "no refraction beside it", "some")?;
        }
        for (option, count) in [
            ("ambient_occlusion", self.ambient_occlusion),
            ("cel", self.cel),
            ("samples", self.samples),
        ] {
            require(count != Some(0), option, "a number above 0", "0")?;
        }
        Ok(())
    }

    fn effects(&self, camera: &Camera, scene: &Scene) -> Result<Effects, Error> {
        let base = Effects::phong(camera);
        let diameter = self.lamp_size.unwrap_or_default();
        require((0.0..=180.0).contains(&diameter), "lamp_size", "degrees from 0 to 180", diameter)?;
        require(!self.lamps.contains(&Vec3::ZERO), "lamp", "a direction", "0,0,0")?;
        let lamps = if self.lamps.is_empty() {
            base.lamps.iter().map(|lamp| Lamp { diameter, ..*lamp }).collect()
        } else {
            // Together as bright as the key lamp that they replace.
            let color = base.lamps[0].color / self.lamps.len() as f32;
            self.lamps.iter().map(|&toward| Lamp { toward, diameter, color }).collect()
        };
        let reach = self.occlusion_reach.map(|reach| at_least(0.0, "occlusion_reach", reach));
        let reach = reach.transpose()?.unwrap_or(NO_LIMIT);
        Ok(Effects {
            surface: self.surface(radius_of(scene))?,
            lamps,
            shadows: self.shadows,
            occlusion: self.ambient_occlusion.map(|rays| Occlusion { rays, reach }),
            bounces: if self.goes_inside() {
                self.bounces.unwrap_or(LAYERS)
            } else {
                self.reflections.unwrap_or_default()
            },
            floor: self.floor.map(|kind| floor(kind, scene)),
            environment: match &self.environment {
                Some(path) => {
                    let image = read_light(path)?;
                    let light = image.light.into_iter();
                    Environment::Panorama(Panorama::new(image.width, image.height, light)?)
                }
                None => Environment::Sky,
            },
            bands: self.cel.unwrap_or_default(),
        })
    }

    fn surface(&self, radius: f32) -> Result<Surface, Error> {
        if let Some(opacity) = self.opacity {
            require((0.0..=1.0).contains(&opacity), "opacity", "a share from 0 to 1", opacity)?;
            let is_alone = self.refraction.is_none() && self.reflections.is_none();
            let alone = "neither refraction nor reflections beside it";
            require(is_alone, "opacity", alone, "one of them")?;
            return Ok(Surface::SeeThrough { opacity });
        }
        if let Some(refraction) = self.refraction {
            let is_index = refraction > 0.0 && refraction.is_finite();
            require(is_index, "refraction", "a finite index above 0", refraction)?;
            let watery = Vec3::new(0.9, 0.28, 0.12) / radius;
            let absorption = self.absorption.unwrap_or(watery);
            let absorbs = absorption.min_element() >= 0.0;
            require(absorbs, "absorption", "numbers of at least 0", absorption)?;
            return Ok(Surface::Fluid { refraction, absorption });
        }
        let reflectivity = match self.reflections {
            Some(_) => self.reflectivity.unwrap_or(0.3),
            None => 0.0,
        };
        let is_share = (0.0..=1.0).contains(&reflectivity);
        require(is_share, "reflectivity", "a share from 0 to 1", reflectivity)?;
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

/// The finite number that an option has, not below the least.
fn at_least(least: f32, option: &'static str, found: f32) -> Result<f32, Error> {
    require(found.is_finite(), option, "a finite number", found)?;
    require(found >= least, option, format!("at least {least}"), found)?;
    Ok(found)
}

fn require(
    holds: bool,
    option: &'static str,
    needed: impl Into<String>,
    found: impl std::fmt::Display,
) -> Result<(), Error> {
    if holds {
        return Ok(());
    }
    Err(Error::Option { option, needed: needed.into(), found: format!("{found}") })
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use fbvh::Options;

    use super::*;

    #[test]
    fn raster_methods_give_what_ends_at_the_first_surface() {
        let none = LightOptions::default();
        let first_surface = [
            LightOptions { cel: Some(4), ..none.clone() },
            LightOptions { reflections: Some(0), ..none.clone() },
            LightOptions {
                depth_cue: Some(1.0),
                samples: Some(4),
                floor: Some(FloorKind::Plain),
                ..none.clone()
            },
        ];
        for light in first_surface {
            assert!(light.is_given_by_tree(None) && light.is_given_by_tree(Some(Kind::Fitted)));
        }
        let secondary = [
            LightOptions { shadows: true, ..none.clone() },
            LightOptions { ambient_occlusion: Some(4), ..none.clone() },
            LightOptions { reflections: Some(1), ..none.clone() },
        ];
        for light in secondary {
            assert!(!light.is_given_by_tree(None) && light.is_given_by_tree(Some(Kind::Fitted)));
        }
        for light in [
            LightOptions { refraction: Some(1.33), ..none.clone() },
            LightOptions { opacity: Some(0.5), ..none },
        ] {
            assert!(light.is_given_by(&Method::default()));
            assert!(!light.is_given_by(&Method::Tree(Options::fitted())));
        }
    }

    #[test]
    fn nonsense_is_named() {
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let message = |light: LightOptions| {
            let lighting = light.lighting(&bench.camera, &bench.scene);
            lighting.expect_err("nonsense").to_string()
        };
        let none = LightOptions::default;
        let mirror = || LightOptions { reflections: Some(1), ..none() };
        let numbers = |option, values: &[f32], with: &dyn Fn(f32) -> LightOptions| {
            for &value in values {
                let message = message(with(value));
                assert!(message.starts_with(&format!("{option}: needed")), "{message}");
            }
        };
        let (infinite, nan) = (f32::INFINITY, f32::NAN);
        numbers("refraction", &[0.0, -1.0, infinite], &|index| LightOptions {
            refraction: Some(index),
            ..none()
        });
        numbers("absorption", &[-1.0], &|green| LightOptions {
            refraction: Some(1.33),
            absorption: Some(Vec3::new(0.0, green, 0.0)),
            ..none()
        });
        numbers("reflectivity", &[2.0, -0.1, nan], &|share| LightOptions {
            reflectivity: Some(share),
            ..mirror()
        });
        numbers("opacity", &[-0.1, 1.1, nan], &|share| LightOptions {
            opacity: Some(share),
            ..none()
        });
        numbers("opacity", &[0.5], &|share| LightOptions { opacity: Some(share), ..mirror() });
        numbers("lamp", &[0.0], &|x| LightOptions { lamps: vec![Vec3::X * x], ..none() });
        numbers("lamp_size", &[-1.0, 181.0, nan], &|size| LightOptions {
            shadows: true,
            lamp_size: Some(size),
            ..none()
        });
        numbers("occlusion_reach", &[-1.0, nan], &|reach| LightOptions {
            ambient_occlusion: Some(4),
            occlusion_reach: Some(reach),
            ..none()
        });
        numbers("depth_cue", &[-1.0, infinite], &|cue| LightOptions {
            depth_cue: Some(cue),
            ..none()
        });
        numbers("exposure", &[nan], &|stops| LightOptions { exposure: Some(stops), ..none() });
        for (option, light) in [
            ("lamp_size", LightOptions { lamp_size: Some(3.0), ..none() }),
            ("occlusion_reach", LightOptions { occlusion_reach: Some(2.0), ..none() }),
            ("reflectivity", LightOptions { reflectivity: Some(0.5), ..none() }),
            ("absorption", LightOptions { absorption: Some(Vec3::X), ..none() }),
            ("bounces", LightOptions { bounces: Some(4), ..mirror() }),
            ("reflections", LightOptions { refraction: Some(1.33), ..mirror() }),
            ("shadows", LightOptions { refraction: Some(1.33), shadows: true, ..none() }),
            ("samples", LightOptions { samples: Some(0), ..none() }),
        ] {
            let message = message(light);
            assert!(message.starts_with(&format!("{option}: needed")), "{message}");
        }
        let nowhere = LightOptions { environment: Some("nowhere.hdr".into()), ..none() };
        assert_eq!(message(nowhere), "cannot open nowhere.hdr");
    }
}
