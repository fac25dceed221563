//! One picture.

use std::path::Path;
use std::time::Duration;

use metaball_core::gpu::{self, Gpu, IsoRenderer, RenderError, Shading, Targets};
use metaball_core::{Camera, Hit, Image, Picture, Scene, Shaded, ValueRange, View};
use picture_files::{encode_png, write_atomically, write_hits, write_light};

use crate::light::Lit;
use crate::shade::{self, CpuPicture};
use crate::{Backend, Error, LightOptions, Method, Viewpoint, cpu};

/// How to draw.
#[derive(Debug, Clone)]
pub struct DrawOptions {
    /// Who finds the surface.
    pub method: Method,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Where it is seen from.
    pub viewpoint: Viewpoint,
    /// What the picture shows.
    pub picture: Picture,
    /// Ray traced light, instead of the shared Phong picture.
    pub light: LightOptions,
    /// What computes.
    pub backend: Backend,
}

impl Default for DrawOptions {
    /// The certified tree, 640 × 480 pixels, the scene's own camera, Phong shading, the best adapter.
    fn default() -> Self {
        Self {
            method: Method::default(),
            size: (640, 480),
            viewpoint: Viewpoint::default(),
            picture: Picture::Phong,
            light: LightOptions::default(),
            backend: Backend::default(),
        }
    }
}

/// What was drawn.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Drawing {
    /// The picture: eight bits a channel, sRGB.
    pub image: Image,
    /// The first hit of each primary ray, row by row from the top left.
    pub hits: Vec<Hit>,
    /// What black and white stand for in pictures of a number.
    pub range: Option<ValueRange>,
    /// Ray traced light, where there is any.
    pub light: Option<Lit>,
    /// The method, or what was chosen and why, as names and texts.
    pub account: Vec<(&'static str, String)>,
    /// What computed, in words.
    pub computed_by: String,
    /// Time for the structure.
    pub build: Duration,
    /// Time for the rays; on an adapter that of a second frame, since shaders are compiled with the
    /// first.
    pub frame: Duration,
}

impl Drawing {
    /// Rays that hit, or start inside.
    pub fn hit_count(&self) -> usize {
        self.hits.iter().filter(|hit| hit.is_hit()).count()
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save_image(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(write_atomically(path.as_ref(), &encode_png(&self.image)?)?)
    }

    /// Writes distances (`Z`, along the unit primary ray) and normals (`N.X`, `N.Y`, `N.Z`) as f32
    /// channels of an OpenEXR file: see [`picture_files::write_hits`].
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save_hits(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let Image { width, height, .. } = self.image;
        Ok(write_hits(path.as_ref(), width, height, &self.hits)?)
    }

    /// Writes the linear light as an OpenEXR file.
    ///
    /// # Errors
    /// When there is no ray traced light, or the file cannot be written.
    pub fn save_light(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let lit = self.light.as_ref().ok_or_else(|| Error::Option {
            option: "light",
            needed: "an option of light, such as shadows".to_owned(),
            found: "none".to_owned(),
        })?;
        Ok(write_light(path.as_ref(), lit.film.width, lit.film.height, &lit.film.light)?)
    }
}

/// Draws a scene. `camera` is the scene's own.
///
/// # Errors
/// When an option cannot be used, or method or adapter cannot draw the scene.
pub fn draw(scene: &Scene, camera: &Camera, options: &DrawOptions) -> Result<Drawing, Error> {
    draw_with_progress(scene, camera, options, |_, _| ())
}

/// As [`draw()`]; after each sample of ray traced light the callback gets how many are done, and of how
/// many.
///
/// # Errors
/// As [`draw()`].
pub fn draw_with_progress(
    scene: &Scene,
    camera: &Camera,
    options: &DrawOptions,
    after_sample: impl FnMut(u32, u32),
) -> Result<Drawing, Error> {
    let (width, height) = options.size;
    let camera = options.viewpoint.camera(camera, scene.bounds().center())?;
    let view = View::new(camera, width, height)?;
    match options.backend.open()? {
        Some(gpu) => on_adapter(&gpu, options, scene, &view, after_sample),
        None => on_cpu(options, scene, &view),
    }
}

fn on_adapter(
    gpu: &Gpu,
    options: &DrawOptions,
    scene: &Scene,
    view: &View,
    after_sample: impl FnMut(u32, u32),
) -> Result<Drawing, Error> {
    let targets = options.targets(gpu, scene)?;
    let Built { mut renderer, build, account } = built(gpu, options, scene, view)?;
    gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let frame = gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let hits = targets.read_hits(gpu)?;
    let (image, range, light) = if options.light.is_asked() {
        let lighting = options.light.lighting(view.camera(), scene)?;
        let (image, lit) =
            lighting.draw(gpu, renderer.as_mut(), scene, view, &hits, after_sample)?;
        (image, None, Some(lit))
    } else {
        let shaded = Shading::new(gpu).draw(&targets, view, scene, options.picture)?;
        (shaded.image, shaded.range, None)
    };
    let computed_by = options.backend.describe(Some(gpu));
    let frame = frame.wall;
    Ok(Drawing { image, hits, range, light, account, computed_by, build, frame })
}

/// A renderer that has its scene.
struct Built {
    renderer: Box<dyn IsoRenderer>,
    build: Duration,
    account: Vec<(&'static str, String)>,
}

fn built(gpu: &Gpu, options: &DrawOptions, scene: &Scene, view: &View) -> Result<Built, Error> {
    #[cfg(feature = "harness")]
    if let Method::Auto(choosing) = &options.method {
        return chosen(gpu, options, choosing, scene, view);
    }
    let mut renderer = options.renderer()?;
    let build = renderer.build(gpu, scene)?.structure;
    Ok(Built { renderer, build, account: options.method.account() })
}

#[cfg(feature = "harness")]
fn chosen(
    gpu: &Gpu,
    options: &DrawOptions,
    choosing: &crate::Choosing,
    scene: &Scene,
    view: &View,
) -> Result<Built, Error> {
    let mut candidates = harness::configuration::sweeps::candidates();
    candidates.retain(|configuration| {
        options.light.is_given_by_tree(configuration.technique.tree().map(|options| options.kind()))
    });
    let (cache, counts) = (choosing.cache.clone(), options.counts());
    let mut auto =
        harness::auto::Auto::new(candidates, view.clone(), choosing.max_error, cache, counts);
    let build = auto.build(gpu, scene)?.structure;
    let account = auto.account();
    Ok(Built { renderer: Box::new(auto), build, account })
}

/// Traces and shades without an adapter.
pub(crate) fn on_cpu(options: &DrawOptions, scene: &Scene, view: &View) -> Result<Drawing, Error> {
    if options.light.is_asked() {
        return Err(Error::NeedsAdapter {
            what: "light".to_owned(),
            instead: CpuPicture::CHOICE.to_owned(),
        });
    }
    let picture = CpuPicture::of(options.picture)?;
    let traced = cpu::trace(&options.method, scene, view)?;
    let Shaded { image, range } = shade::draw(scene, view, &traced.rays, &traced.hits, picture);
    Ok(Drawing {
        image,
        range,
        hits: traced.hits,
        light: None,
        account: options.method.account(),
        computed_by: options.backend.describe(None),
        build: traced.build,
        frame: traced.frame,
    })
}

impl DrawOptions {
    /// What the frames of such a scene are drawn to.
    pub(crate) fn targets(&self, gpu: &Gpu, scene: &Scene) -> Result<Targets, RenderError> {
        let (width, height) = self.size;
        Targets::new(gpu, width, height, scene.colors().is_some(), self.counts())
    }

    /// A renderer of the method, without a scene.
    pub(crate) fn renderer(&self) -> Result<Box<dyn IsoRenderer>, Error> {
        self.method.renderer(self.counts()).ok_or_else(|| Error::Option {
            option: "method",
            needed: "one method for all frames".to_owned(),
            found: format!("{}, which chooses for one picture", self.method.name()),
        })
    }

    fn counts(&self) -> bool {
        matches!(self.picture, Picture::Work(_))
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};

    use super::*;

    #[test]
    fn the_cpu_writes_picture_and_hits() {
        let folder = tempfile::tempdir().expect("a folder");
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let mut options = DrawOptions {
            method: Method::Tree(fbvh::Options::fitted()),
            size: (16, 12),
            backend: Backend::Cpu,
            ..DrawOptions::default()
        };
        let drawing = draw(&bench.scene, &bench.camera, &options).expect("drawn");
        let path = |name| folder.path().join(name);
        drawing.save_image(path("image.png")).expect("written");
        drawing.save_hits(path("hits.exr")).expect("written");
        assert!(path("image.png").is_file() && path("hits.exr").is_file());
        assert!(drawing.save_light(path("light.exr")).is_err() && !path("light.exr").exists());
        let refused = |options: &DrawOptions| {
            draw(&bench.scene, &bench.camera, options).expect_err("refused").to_string()
        };
        options.picture = Picture::Spheres;
        assert!(refused(&options).contains("graphics adapter"));
        options.light.shadows = true;
        assert!(refused(&options).starts_with("light needs a graphics adapter"));
    }

    #[test]
    #[cfg(feature = "harness")]
    fn auto_needs_an_adapter() {
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let cache = harness::auto::cache::Cache::none();
        let options = DrawOptions {
            method: Method::Auto(crate::Choosing { max_error: 1e-3, cache }),
            backend: Backend::Cpu,
            ..DrawOptions::default()
        };
        let error = draw(&bench.scene, &bench.camera, &options).expect_err("refused").to_string();
        assert!(error.starts_with("method auto needs a graphics adapter"), "{error}");
    }
}
