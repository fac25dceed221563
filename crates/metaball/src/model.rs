//! A scene that is built once, and drawn and traced again and again on the CPU: what a window shows, and what
//! Python holds.

use std::mem;
use std::ops::Range;
use std::time::Duration;

use fbvh::Tracer;
use glam::Vec3;
use metaball_core::{Aabb, Camera, Clip, Hit, Image, Picture, Ray, Scene, ValueRange, View};
use metaball_light::Film;
use metaball_light::cpu::PathTracer;

use crate::backend::Opened;
use crate::band::{Band, Planes, bands};
use crate::cpu::{Built, Painter};
use crate::draw::draw_built;
use crate::interruptible::{GoesOn, Interruptible};
use crate::light::{DEPTH_CUE_WIDTH, Lighting};
use crate::summary::Progress;
use crate::{DrawOptions, Drawing, Error, LightOptions, Method};

/// Pixels of a band: what is drawn between two questions whether to go on, some hundredths of a second.
const BAND_PIXELS: u32 = 1 << 15;

/// A scene with a method's tree. Pictures of it are those of [`draw()`](crate::draw()) on the CPU, byte
/// for byte.
///
/// ```
/// use metaball::{Camera, Clip, Method, Model, Picture, Scene, View};
/// use metaball_core::{Kernel, Metaball};
///
/// let scene = Scene::new([Metaball::new([0.0; 3].into(), 1.0)], Kernel::QUARTIC, 0.25)?;
/// let camera = Camera::framing(&scene.bounds(), [0.0, 0.0, 1.0].into());
/// let model = Model::new(scene, &Method::default())?;
/// let solid = model.cut(&Clip::default())?;
/// for size in [16, 64] {
///     let view = View::new(camera, size, size)?;
///     let shown = solid.draw(&view, Picture::Phong)?.flatten().last();
///     assert!(shown.is_some_and(|shown| shown.hits.iter().any(|hit| hit.is_hit())));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Model {
    scene: Scene,
    bounds: Aabb,
    method: Method,
    built: Built,
}

/// A model cut to a region. It keeps what its tracer learns, so that later pictures take less time.
#[derive(Debug)]
pub struct Solid<'a> {
    model: &'a Model,
    tracer: Interruptible<'a>,
}

/// A picture, and what its rays found.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// The picture: eight bits a channel, sRGB.
    pub image: Image,
    /// The first hit of each primary ray, row by row from the top left.
    pub hits: Vec<Hit>,
}

impl Model {
    /// Builds the method's tree.
    ///
    /// # Errors
    /// When the method has no tree on the CPU, or it cannot be built for the scene.
    pub fn new(scene: Scene, method: &Method) -> Result<Self, Error> {
        Self::new_while(scene, method, || true)
    }

    /// The same as long as `goes_on` says so; it is asked on any thread.
    ///
    /// # Errors
    /// As [`new`](Model::new), and when it was broken off.
    pub fn new_while(
        scene: Scene,
        method: &Method,
        goes_on: impl Fn() -> bool + Sync,
    ) -> Result<Self, Error> {
        let built = Built::while_wanted(method, &scene, &goes_on)?;
        Ok(Self { bounds: scene.bounds(), scene, method: method.clone(), built })
    }

    /// The balls.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The smallest box around all support spheres.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The method that traces it.
    pub fn method(&self) -> &Method {
        &self.method
    }

    /// The time that building took.
    pub fn build_time(&self) -> Duration {
        self.built.time
    }

    /// Memory of the tree, bytes.
    pub fn tree_bytes(&self) -> usize {
        self.built.bytes()
    }

    /// What traces it.
    pub fn tracer(&self) -> Tracer<'_, Scene> {
        self.built.whole_tracer(&self.scene)
    }

    /// Draws it on the CPU, byte for byte as [`draw`](crate::draw()) does, as long as `goes_on` says so: it is
    /// asked often, on any thread, and once it has said no it must stay with that. `camera` is the scene's own.
    /// Of each part that is done `progress` is told.
    ///
    /// # Errors
    /// When an option cannot be used, another method or an adapter is asked for, or it was broken off.
    pub fn draw(
        &self,
        camera: &Camera,
        options: &DrawOptions,
        goes_on: impl Fn() -> bool + Sync,
        progress: impl FnMut(Progress),
    ) -> Result<Drawing, Error> {
        let refused = |option, needed: &str, found| {
            Err(Error::Option { option, needed: needed.to_owned(), found })
        };
        if options.method.tree() != self.method.tree() {
            let needed = format!("{}, whose tree it has", self.method.name());
            return refused("method", &needed, options.method.name().to_owned());
        }
        if let Some(adapter) = options.backend.adapter_asked() {
            return refused("backend", "the CPU, which draws models", adapter);
        }
        let view = options.view(&self.scene, camera)?;
        let lighting = options.lighting(&view, &self.scene)?;
        let computed_by = Opened::cpu("it has the tree").describe();
        let of = (&self.scene, &view);
        let watched = (&goes_on as GoesOn<'_>, progress);
        draw_built(&self.built, of, options, lighting.as_ref(), computed_by, watched)
    }

    /// What a region leaves of it, in the coordinates of the scene's file ([`Scene::origin`]).
    ///
    /// # Errors
    /// When something is cut and the tree is not certified.
    pub fn cut(&self, clip: &Clip) -> Result<Solid<'_>, Error> {
        let clip = clip.clone().relative_to(self.scene.origin());
        let tracer = Interruptible::never(self.built.tracer(&self.scene, &clip)?);
        Ok(Solid { model: self, tracer })
    }
}

impl Solid<'_> {
    /// What a ray finds, in the scene's coordinates.
    pub fn first_hit(&self, ray: &Ray) -> Hit {
        self.tracer.first_hit(ray)
    }

    /// Draws a view without ray traced light, a band at each step; the last step hands out the picture.
    /// Between steps it may be broken off, or others may have their turn.
    ///
    /// # Errors
    /// When only an adapter draws such a picture.
    pub fn draw<'s>(
        &'s self,
        view: &'s View,
        picture: Picture,
    ) -> Result<impl Iterator<Item = Option<Shown>> + 's, Error> {
        let options = self.options(picture);
        let painter = Painter::new(&self.tracer, &self.model.scene, view, &options, None)?;
        let planes = painter.planes(true, false);
        let mut whole = Band::default();
        Ok(bands(view, 0, BAND_PIXELS).map(move |rows| {
            let is_last = rows.end == view.height();
            whole.append(painter.band(rows, planes));
            is_last.then(|| finished(&painter, planes, mem::take(&mut whole)))
        }))
    }

    /// Draws a view in ray traced light, a band of a sample at each step. The last step of a sample hands
    /// out the number of samples that are done with the picture of them; after all of them that is the
    /// whole picture. Between steps it may be broken off, or others may have their turn.
    ///
    /// # Errors
    /// When an option makes no sense, or the tree does not follow the rays that the light needs.
    pub fn light<'s>(
        &'s self,
        view: &'s View,
        light: &LightOptions,
    ) -> Result<impl Iterator<Item = Option<(u32, Shown)>> + 's, Error> {
        let scene = &self.model.scene;
        let lighting = light.lighting(view.camera(), scene)?;
        let paths = lighting
            .on_cpu(&self.tracer, scene, view)
            .ok_or_else(|| Error::unlit(&self.model.method))?;
        let samples = lighting.samples();
        let (hits, sums) = (Vec::new(), vec![Vec3::ZERO; view.pixels()]);
        let mut gathering = Gathering { view, lighting, paths, hits, sums };
        let first = bands(view, 0, BAND_PIXELS).map(|rows| (None, rows));
        let lit = (0..samples).flat_map(|sample| {
            bands(view, 0, BAND_PIXELS / 4).map(move |rows| (Some(sample), rows))
        });
        Ok(first.chain(lit).map(move |(sample, rows)| gathering.step(sample, rows)))
    }

    fn options(&self, picture: Picture) -> DrawOptions {
        DrawOptions { method: self.model.method.clone(), picture, ..DrawOptions::default() }
    }
}

/// The picture of all bands.
fn finished(painter: &Painter<'_>, planes: Planes, mut whole: Band) -> Shown {
    if !planes.pixels {
        let range = ValueRange::of_distances(&whole.hits);
        painter.finisher(range).finish(&mut whole);
    }
    let Range { start, end } = whole.rows;
    let height = end - start;
    let width = (whole.pixels.len() / height as usize) as u32;
    Shown { image: Image::new(width, height, &whole.pixels), hits: whole.hits }
}

/// Light that is being gathered.
struct Gathering<'a> {
    view: &'a View,
    lighting: Lighting,
    paths: PathTracer<'a, Interruptible<'a>>,
    /// Of the rays through the middles of pixels.
    hits: Vec<Hit>,
    /// Of all samples so far.
    sums: Vec<Vec3>,
}

impl Gathering<'_> {
    /// Finds the first hits of some rows, or adds a sample's light to theirs; after its last row the picture
    /// of all samples up to it.
    fn step(&mut self, sample: Option<u32>, rows: Range<u32>) -> Option<(u32, Shown)> {
        let Some(sample) = sample else {
            self.hits.extend(self.paths.first_hits(rows).into_iter().map(|found| found.hit));
            return None;
        };
        let (first, is_last) = (rows.start * self.view.width(), rows.end == self.view.height());
        let light = self.paths.rows_of_sample(rows, sample).light;
        let sums = &mut self.sums[first as usize..];
        sums.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
        is_last.then(|| (sample + 1, self.shown(sample + 1)))
    }

    /// The picture of so many samples.
    fn shown(&self, samples: u32) -> Shown {
        let (width, height) = (self.view.width(), self.view.height());
        let light = self.sums.iter().map(|sum| sum / samples as f32).collect();
        let mut film = Film { width, height, light };
        if let Some(strength) = self.lighting.depth_cue_strength() {
            film.cue_depth(&self.hits, DEPTH_CUE_WIDTH, strength);
        }
        let pixels = self.lighting.develop(&film.light);
        Shown { image: Image::new(width, height, &pixels), hits: self.hits.clone() }
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{BenchScene, Overrides, load};

    use super::*;
    use crate::{Backend, draw};

    const SIZE: (u32, u32) = (61, 45);

    fn bench() -> BenchScene {
        load("colors-100", &Overrides::default()).expect("known")
    }

    fn options(picture: Picture, light: LightOptions) -> DrawOptions {
        let clip = Clip::default().and_plane(Vec3::X, 0.301).expect("a plane");
        let backend = Backend::Cpu;
        DrawOptions { size: SIZE, backend, picture, clip, light, ..DrawOptions::default() }
    }

    #[test]
    fn pictures_are_those_of_a_single_drawing() {
        let bench = bench();
        let view = View::new(bench.camera, SIZE.0, SIZE.1).expect("a size");
        let model = Model::new(bench.scene.clone(), &Method::default()).expect("built");
        for picture in [Picture::Phong, Picture::Normal, Picture::Depth, Picture::Color] {
            let options = options(picture, LightOptions::default());
            let solid = model.cut(&options.clip).expect("certified");
            let wanted = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            for _ in 0..2 {
                let steps = solid.draw(&view, picture).expect("a picture of the CPU");
                let shown = steps.flatten().last().expect("drawn");
                assert!(shown.image == wanted.image && shown.hits == wanted.hits, "{picture:?}");
            }
        }
    }

    #[test]
    fn light_gathers_to_that_of_a_single_drawing() {
        let bench = bench();
        let view = View::new(bench.camera, SIZE.0, SIZE.1).expect("a size");
        let model = Model::new(bench.scene.clone(), &Method::default()).expect("built");
        let light = |samples| LightOptions {
            shadows: true,
            ambient_occlusion: Some(2),
            samples: Some(samples),
            depth_cue: Some(0.5),
            ..LightOptions::default()
        };
        for samples in [1, 3] {
            let options = options(Picture::Phong, light(samples));
            let wanted = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            let solid = model.cut(&options.clip).expect("certified");
            let steps = solid.light(&view, &options.light).expect("lit").flatten();
            let (counts, mut shown): (Vec<_>, Vec<_>) = steps.unzip();
            assert!(counts.into_iter().eq(1..=samples));
            let last = shown.pop().expect("a picture");
            assert!(last.image == wanted.image && last.hits == wanted.hits, "{samples}");
            assert!(shown.iter().all(|early| early.image != wanted.image));
        }
    }

    #[test]
    fn steps_are_small() {
        let bench = bench();
        let view = View::new(bench.camera, 640, 480).expect("a size");
        let model = Model::new(bench.scene, &Method::default()).expect("built");
        let solid = model.cut(&Clip::default()).expect("whole");
        let steps = solid.draw(&view, Picture::Phong).expect("a picture of the CPU");
        let drawn: Vec<_> = steps.map(|shown| shown.is_some()).collect();
        let (last, early) = drawn.split_last().expect("steps");
        assert!(*last && early.len() > 5 && early.iter().all(|is_there| !is_there));
    }

    #[test]
    fn what_a_tree_cannot_do_is_refused_by_name() {
        let fitted = Method::Tree(fbvh::Options::fitted());
        let model = Model::new(bench().scene, &fitted).expect("built");
        let cut = Clip::default().and_plane(Vec3::X, 0.0).expect("a plane");
        assert!(model.cut(&cut).is_err());
        let solid = model.cut(&Clip::default()).expect("whole");
        let view = View::new(bench().camera, 4, 4).expect("a size");
        let water = LightOptions { refraction: Some(1.33), ..LightOptions::default() };
        let error = solid.light(&view, &water).err().expect("refused");
        assert!(error.to_string().starts_with("method: needed fbvh-certified"), "{error}");
        let error = solid.draw(&view, Picture::Spheres).err().expect("refused");
        assert!(error.to_string().contains("needs a graphics adapter"), "{error}");
    }

    #[test]
    fn it_is_drawn_as_its_scene_is() {
        let bench = bench();
        let model = Model::new(bench.scene.clone(), &Method::default()).expect("built");
        let plain = DrawOptions { size: (61, 83), backend: Backend::Cpu, ..DrawOptions::default() };
        let light = LightOptions { shadows: true, depth_cue: Some(1.0), ..LightOptions::default() };
        let lit = DrawOptions { light, ..plain.clone() };
        for options in [plain, lit] {
            let wanted = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            let mut rows = Vec::new();
            let watch = |progress: Progress| rows.push(progress.done);
            let found = model.draw(&bench.camera, &options, || true, watch).expect("drawn");
            assert!(found.image == wanted.image && found.hits == wanted.hits);
            assert_eq!((rows.first(), rows.last()), (Some(&0), Some(&83)));
            let stopped = model.draw(&bench.camera, &options, || false, |_| ());
            assert!(matches!(stopped, Err(Error::Interrupted)));
        }
        let stopped = Model::new_while(bench.scene.clone(), &Method::default(), || false);
        assert!(matches!(stopped, Err(Error::Interrupted)));
        let fitted =
            DrawOptions { method: Method::Tree(fbvh::Options::fitted()), ..DrawOptions::default() };
        let refused = model.draw(&bench.camera, &fitted, || true, |_| ());
        let refused = refused.expect_err("another method").to_string();
        assert!(refused.starts_with("method: needed fbvh-certified"), "{refused}");
    }
}
