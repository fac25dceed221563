//! One picture.

use std::ops::ControlFlow;
use std::path::Path;

use metaball_core::shade::CpuPicture;
use metaball_core::{Camera, Clip, Hit, Image, Picture, Scene, ValueRange, View};
use metaball_light::Film;
use picture_files::{write_hits, write_light, write_picture};

#[cfg(feature = "gpu")]
use crate::adapter;
use crate::backend::Opened;
use crate::band::{Band, bands};
use crate::cpu::{Built, Painter};
use crate::interruptible::{GoesOn, Interruptible};
use crate::light::Lighting;
use crate::summary::{Progress, Stage, Summary};
use crate::{Backend, Error, LightOptions, Method, Viewpoint};

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
    /// The region that the solid is cut to, with filled faces, in the coordinates of the scene's file
    /// ([`Scene::origin`]). Needs the certified tree, and the CPU.
    pub clip: Clip,
    /// Ray traced light, instead of the shared Phong picture.
    pub light: LightOptions,
    /// What computes.
    pub backend: Backend,
}

impl Default for DrawOptions {
    /// The certified tree, 640 × 480 pixels, the scene's own camera, Phong shading, whatever is fastest.
    fn default() -> Self {
        Self {
            method: Method::default(),
            size: (640, 480),
            viewpoint: Viewpoint::default(),
            picture: Picture::Phong,
            clip: Clip::default(),
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
    /// Ray traced light, where there is any.
    pub film: Option<Film>,
    /// What is to be said of it.
    pub summary: Summary,
}

impl Drawing {
    /// Rays that hit, or start inside.
    pub fn hit_count(&self) -> usize {
        self.hits.iter().filter(|hit| hit.is_hit()).count()
    }

    /// Writes the picture as PNG or JPEG, as the ending says: see [`picture_files::PictureFile`].
    ///
    /// # Errors
    /// When the ending is another, or the file cannot be written.
    pub fn save_image(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(write_picture(path.as_ref(), &self.image)?)
    }

    /// Writes distances (`Z`, along the unit primary ray) and normals (`N.X`, `N.Y`, `N.Z`) as f32
    /// channels of an OpenEXR file, or as a NumPy array: see [`picture_files::HitsFile`].
    ///
    /// # Errors
    /// When the ending is another, or the file cannot be written.
    pub fn save_hits(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let Image { width, height, .. } = self.image;
        Ok(write_hits(path.as_ref(), width, height, &self.hits)?)
    }

    /// Writes the linear light as an OpenEXR file.
    ///
    /// # Errors
    /// When there is no ray traced light, the ending is not `.exr`, or the file cannot be written.
    pub fn save_light(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let film = self.film.as_ref().ok_or_else(no_light)?;
        Ok(write_light(path.as_ref(), film.width, film.height, &film.light)?)
    }
}

/// Why there is no file of light.
pub(crate) fn no_light() -> Error {
    Error::Option {
        option: "light",
        needed: "an option of light, such as shadows".to_owned(),
        found: "none".to_owned(),
    }
}

/// Draws a scene. `camera` is the scene's own. The picture is held in memory, 28 bytes a pixel, and 12
/// more with ray traced light; [`draw_to_files`](crate::draw_to_files()) does not.
///
/// # Errors
/// When an option cannot be used, or method or adapter cannot draw the scene.
pub fn draw(scene: &Scene, camera: &Camera, options: &DrawOptions) -> Result<Drawing, Error> {
    let view = options.view(scene, camera)?;
    let opened = options.open(Some(scene))?;
    match on_adapter(&opened, options, scene, &view, |_| ControlFlow::Continue(()))? {
        Attempt::Drawn(drawing) => Ok(*drawing),
        Attempt::Left { computed_by } => {
            let lighting = options.lighting(&view, scene)?;
            on_cpu(options, lighting.as_ref(), scene, &view, computed_by)
        }
    }
}

/// What became of a picture that an adapter was to draw.
pub(crate) enum Attempt {
    /// It is drawn.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only an adapter draws at once"))]
    Drawn(Box<Drawing>),
    /// It is left to the CPU, for the reason that these words give.
    Left { computed_by: String },
}

/// Draws a picture on the adapter, if there is one and the picture fits. After each sample of ray traced
/// light the callback gets how many are done, and may break off.
pub(crate) fn on_adapter(
    opened: &Opened,
    options: &DrawOptions,
    scene: &Scene,
    view: &View,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Attempt, Error> {
    #[cfg(feature = "gpu")]
    if let Some(gpu) = &opened.gpu {
        return match adapter::draw((gpu, opened.describe()), options, scene, view, progress) {
            Ok(drawing) => Ok(Attempt::Drawn(Box::new(drawing))),
            Err(Error::Render(refusal)) if refusal.is_too_large() && options.is_for_cpu() => {
                let computed_by = format!("the CPU, being too large for the adapter: {refusal}");
                Ok(Attempt::Left { computed_by })
            }
            Err(Error::Render(refusal)) => Err(options.refused(refusal)),
            Err(error) => Err(error),
        };
    }
    #[cfg(not(feature = "gpu"))]
    let _asked_by_adapters_alone = (options, scene, view, progress);
    Ok(Attempt::Left { computed_by: opened.describe() })
}

/// Draws without an adapter, in this light, if there is any. `computed_by` says why, in words.
pub(crate) fn on_cpu(
    options: &DrawOptions,
    lighting: Option<&Lighting>,
    scene: &Scene,
    view: &View,
    computed_by: String,
) -> Result<Drawing, Error> {
    let built = Built::new(&options.method, scene)?;
    draw_built(&built, (scene, view), options, lighting, computed_by, (&|| true, |_| ()))
}

/// Draws a scene that is built, without an adapter, as long as the picture is wanted. After each band the
/// callback gets how many rows are done.
pub(crate) fn draw_built(
    built: &Built,
    (scene, view): (&Scene, &View),
    options: &DrawOptions,
    lighting: Option<&Lighting>,
    computed_by: String,
    (goes_on, mut progress): (GoesOn<'_>, impl FnMut(Progress)),
) -> Result<Drawing, Error> {
    let tracer = built.tracer(scene, &options.clip_of(scene))?;
    let tracer = Interruptible::new(tracer, goes_on);
    let painter = Painter::new(&tracer, scene, view, options, lighting)?;
    let planes = painter.planes(true, true);
    let (stage, of, resumed) = (Stage::Drawing, view.height(), 0);
    let mut whole = Band::default();
    progress(Progress { stage, done: 0, of, resumed });
    for rows in bands(view, 0, painter.watched_pixels()) {
        whole.append(painter.band(rows, planes));
        if !tracer.goes_on() {
            return Err(Error::Interrupted);
        }
        progress(Progress { stage, done: whole.rows.end, of, resumed });
    }
    let mut range = None;
    if !planes.pixels {
        let mut finisher = painter.finisher(ValueRange::of_distances(&whole.hits));
        finisher.see(&whole.hits);
        finisher.finish(&mut whole);
        range = finisher.scale();
    }
    let Band { pixels, hits, light, tally, .. } = whole;
    let (width, height) = (view.width(), view.height());
    let summary = Summary {
        tally,
        range,
        samples: lighting.map(Lighting::samples),
        account: options.method.account(),
        computed_by,
        build: built.time,
    };
    Ok(Drawing {
        image: Image::new(width, height, &pixels),
        hits,
        film: lighting.map(|_| Film { width, height, light }),
        summary,
    })
}

impl DrawOptions {
    /// The view that is drawn; `camera` is the scene's own.
    pub(crate) fn view(&self, scene: &Scene, camera: &Camera) -> Result<View, Error> {
        let (width, height) = self.size;
        let camera = self.viewpoint.camera(camera, scene)?;
        Ok(View::new(camera, width, height)?)
    }

    /// The region that the solid is cut to, in the scene's coordinates.
    pub(crate) fn clip_of(&self, scene: &Scene) -> Clip {
        self.clip.clone().relative_to(scene.origin())
    }

    /// Opens what draws it; the scene is the picture's, or one like it, where it is known.
    pub(crate) fn open(&self, scene: Option<&Scene>) -> Result<Opened, Error> {
        if let Some(option) = self.cpu_alone(scene) {
            return self.open_cpu(option);
        }
        if self.method.is_on_host() {
            return Backend::Cpu.open(None);
        }
        let needs_adapter = if self.method.tree().is_none() {
            Some(format!("method {}", self.method.name()))
        } else if !self.is_for_cpu() {
            Some(format!("picture {:?}", self.picture))
        } else {
            None
        };
        self.backend.open(needs_adapter.as_deref())
    }

    /// The light that is asked for, if any is.
    pub(crate) fn lighting(&self, view: &View, scene: &Scene) -> Result<Option<Lighting>, Error> {
        let asked = self.light.is_asked();
        asked.then(|| self.light.lighting(view.camera(), scene)).transpose()
    }

    /// Whether the CPU draws such pictures too.
    pub(crate) fn is_for_cpu(&self) -> bool {
        let shades = self.light.is_asked() || CpuPicture::of(self.picture).is_some();
        shades && self.method.tree().is_some()
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    #[cfg(feature = "harness")]
    use metaball_core::gpu::AdapterChoice;

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

    #[test]
    #[cfg(feature = "harness")]
    fn a_tree_on_the_cpu_needs_no_adapter_whatever_computes() {
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let listed = harness::methods::find("fbvh-certified-cpu").expect("listed");
        let options = DrawOptions {
            method: Method::Listed(listed.into()),
            size: (48, 36),
            backend: Backend::Adapter(AdapterChoice::Environment),
            ..DrawOptions::default()
        };
        let drawing = draw(&bench.scene, &bench.camera, &options).expect("drawn");
        assert!(drawing.summary.computed_by.starts_with("the CPU"));
        assert!(drawing.hits.iter().filter(|hit| hit.is_hit()).count() > 100);
    }
}
