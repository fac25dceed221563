//! Pictures on the CPU, band by band: rays made on the host, traced by fbvh's own tracer.

use std::ops::Range;
use std::time::Duration;

use fbvh::{BuildError, ClippedTracer, Tracer, Tree};
use metaball_core::shade::{CpuPicture, Shader};
use metaball_core::{Clip, Hit, Scene, ValueRange, View};
use metaball_light::DepthCue;
use metaball_light::cpu::PathTracer;
use web_time::Instant;

use crate::band::{Band, Planes};
use crate::interruptible::{GoesOn, Interruptible};
use crate::light::Lighting;
use crate::summary::Tally;
use crate::{DrawOptions, Error, Method};

/// A method's tree, with the time that it took.
#[derive(Debug)]
pub(crate) struct Built {
    tree: Tree,
    pub(crate) time: Duration,
}

impl Built {
    /// Builds the method's tree.
    pub(crate) fn new(method: &Method, scene: &Scene) -> Result<Self, Error> {
        Self::while_wanted(method, scene, &|| true)
    }

    /// The same as long as it is wanted.
    pub(crate) fn while_wanted(
        method: &Method,
        scene: &Scene,
        goes_on: GoesOn<'_>,
    ) -> Result<Self, Error> {
        let options = method.tree().ok_or_else(|| match method.is_on_host() {
            false => Error::NeedsAdapter {
                what: format!("method {}", method.name()),
                instead: "the CPU traces bvh, fbvh, fbvh-certified".to_owned(),
            },
            true => Error::Option {
                option: "method",
                needed: "a tree, or a method on an adapter".to_owned(),
                found: format!("{}, which is there to be compared", method.name()),
            },
        })?;
        let start = Instant::now();
        let tree = Tree::build_while(scene, &options, goes_on).map_err(|source| match source {
            BuildError::BrokenOff => Error::Interrupted,
            source => Error::Build { method: method.name().to_owned(), source },
        })?;
        Ok(Self { tree, time: start.elapsed() })
    }

    /// Memory of the tree, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.tree.stats().bytes
    }

    /// What traces the scene that it was built for.
    pub(crate) fn whole_tracer<'a>(&'a self, scene: &'a Scene) -> Tracer<'a, Scene> {
        Tracer::new(&self.tree, scene)
    }

    /// The same, cut to a region.
    pub(crate) fn tracer<'a>(
        &'a self,
        scene: &'a Scene,
        clip: &Clip,
    ) -> Result<ClippedTracer<'a, Scene>, Error> {
        Ok(ClippedTracer::new(self.whole_tracer(scene), clip.clone())?)
    }
}

/// Draws bands of a view, in any order: each is the same, bit for bit, as in the whole picture.
pub(crate) struct Painter<'a> {
    view: &'a View,
    tracer: &'a Interruptible<'a>,
    look: Look<'a>,
}

/// How a picture is shaded.
enum Look<'a> {
    Shared(Shader<'a>),
    Lit(&'a Lighting, Box<Paths<'a>>),
}

type Paths<'a> = PathTracer<'a, Interruptible<'a>>;

impl<'a> Painter<'a> {
    /// Of a view in this light, if there is any, else of what the options say.
    pub(crate) fn new(
        tracer: &'a Interruptible<'a>,
        scene: &'a Scene,
        view: &'a View,
        options: &DrawOptions,
        lighting: Option<&'a Lighting>,
    ) -> Result<Self, Error> {
        let look = match lighting {
            None => {
                let picture =
                    CpuPicture::of(options.picture).ok_or_else(|| Error::NeedsAdapter {
                        what: format!("picture {:?}", options.picture),
                        instead: CpuPicture::CHOICE.to_owned(),
                    })?;
                Look::Shared(Shader::new(scene, view, picture))
            }
            Some(lighting) => {
                let paths = lighting
                    .on_cpu(tracer, scene, view)
                    .ok_or_else(|| Error::unlit(&options.method))?;
                Look::Lit(lighting, paths.into())
            }
        };
        Ok(Self { view, tracer, look })
    }

    /// Pixels of a band. Those of light take long: they are few, so that progress is seen and kept.
    pub(crate) fn band_pixels(&self) -> u32 {
        match self.look {
            Look::Shared(_) => 1 << 20,
            Look::Lit(..) => 1 << 16,
        }
    }

    /// Pixels of a band of a picture that someone watches, and may break off: those of light are the least
    /// that there are.
    pub(crate) fn watched_pixels(&self) -> u32 {
        match self.look {
            Look::Shared(_) => 1 << 16,
            Look::Lit(..) => 1,
        }
    }

    /// What a band has to keep for a picture, and for files of hits and of light where they are wanted.
    pub(crate) fn planes(&self, hits: bool, light: bool) -> Planes {
        let (waits, lit) = match &self.look {
            Look::Shared(shader) => (shader.needs_range(), false),
            Look::Lit(lighting, _) => (lighting.cues_depth(), true),
        };
        Planes { pixels: !waits, hits: hits || waits, light: lit && (light || waits) }
    }

    /// Draws some rows, from a multiple of sixteen on.
    pub(crate) fn band(&self, rows: Range<u32>, planes: Planes) -> Band {
        let mut band = match &self.look {
            Look::Shared(shader) => self.shared_band(shader, rows, planes),
            Look::Lit(lighting, paths) => lit_band(lighting, paths, rows, planes),
        };
        band.keep(planes);
        band
    }

    fn shared_band(&self, shader: &Shader<'_>, rows: Range<u32>, planes: Planes) -> Band {
        let start = Instant::now();
        let rays = self.view.rays_of_rows(rows.clone());
        let hits = self.tracer.picture_hits(&rays, self.view.width() as usize);
        let tally = Tally { frame: start.elapsed(), ..Tally::of(&hits) };
        let mut pixels = Vec::new();
        if planes.pixels {
            pixels = shader.pixels(rows.start, &rays, &hits, ValueRange::default());
        }
        Band { rows, pixels, hits, light: Vec::new(), tally }
    }

    /// Makes the pixels of bands without any, of a picture with these distances.
    pub(crate) fn finisher(&self, range: ValueRange) -> Finisher<'_, 'a> {
        let cue = match &self.look {
            Look::Shared(_) => None,
            Look::Lit(lighting, _) => lighting.depth_cue(self.view, range),
        };
        Finisher { painter: self, range, cue }
    }
}

fn lit_band(lighting: &Lighting, paths: &Paths<'_>, rows: Range<u32>, planes: Planes) -> Band {
    let start = Instant::now();
    let found = paths.first_hits(rows.clone());
    let frame = start.elapsed();
    let lit = paths.rows_behind(rows.clone(), &found);
    let hits: Vec<_> = found.iter().map(|found| found.hit).collect();
    let (light, undecided_light) = (start.elapsed() - frame, lit.rays.undecided);
    let tally = Tally { frame, light, undecided_light, ..Tally::of(&hits) };
    let pixels = if planes.pixels { lighting.develop(&lit.light) } else { Vec::new() };
    Band { rows, pixels, hits, light: lit.light, tally }
}

/// Makes pixels that depend on the whole picture, from its top to its bottom.
pub(crate) struct Finisher<'p, 'a> {
    painter: &'p Painter<'a>,
    range: ValueRange,
    cue: Option<DepthCue>,
}

impl Finisher<'_, '_> {
    /// What black and white stand for, if anything.
    pub(crate) fn scale(&self) -> Option<ValueRange> {
        matches!(self.painter.look, Look::Shared(_)).then_some(self.range)
    }

    /// Whether it has to see more rows before it finishes those up to `end`.
    pub(crate) fn has_to_see(&self, end: u32) -> bool {
        self.cue.as_ref().is_some_and(|cue| cue.seen() < cue.needed(end))
    }

    /// Sees the next rows.
    pub(crate) fn see(&mut self, hits: &[Hit]) {
        if let Some(cue) = &mut self.cue {
            cue.see(hits);
        }
    }

    /// Makes the pixels of the next rows.
    pub(crate) fn finish(&mut self, band: &mut Band) {
        band.pixels = match &self.painter.look {
            Look::Shared(shader) => {
                let rays = self.painter.view.rays_of_rows(band.rows.clone());
                shader.pixels(band.rows.start, &rays, &band.hits, self.range)
            }
            Look::Lit(lighting, _) => {
                if let Some(cue) = &mut self.cue {
                    cue.cue(band.rows.clone(), &band.hits, &mut band.light);
                }
                lighting.develop(&band.light)
            }
        };
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bench_scenes::{BenchScene, Overrides, load};
    use metaball_core::Picture;
    use metaball_core::reference::Oracle;

    use super::*;
    use crate::band::bands;

    const PLANES: Planes = Planes { pixels: true, hits: true, light: true };

    fn bench(name: &str) -> BenchScene {
        load(name, &Overrides::default()).expect("known")
    }

    /// A view drawn in bands of at least so many pixels.
    fn drawn(scene: &Scene, view: &View, options: &DrawOptions, pixels: u32) -> Band {
        let built = Built::new(&options.method, scene).expect("built");
        let tracer = built.tracer(scene, &options.clip).expect("a tracer");
        let tracer = Interruptible::never(tracer);
        let lighting = options.lighting(view, scene).expect("light");
        let painter = Painter::new(&tracer, scene, view, options, lighting.as_ref());
        let painter = painter.expect("a painter");
        let mut whole = Band::default();
        for rows in bands(view, 0, pixels) {
            whole.append(painter.band(rows, PLANES));
        }
        (whole.tally.frame, whole.tally.light) = (Duration::ZERO, Duration::ZERO);
        whole
    }

    /// The certified tree is never wrong: away from rays that are too close to call, what is traced
    /// is the truth.
    #[test]
    fn pictures_are_right_without_an_adapter() {
        let bench = bench("colors-100");
        let view = View::new(bench.camera, 40, 30).expect("a size");
        let hits = drawn(&bench.scene, &view, &DrawOptions::default(), 1).hits;
        let truths = Oracle::new(&bench.scene).first_hits(&view.rays());
        let clear = || truths.iter().zip(&hits).filter(|(truth, _)| !truth.is_ambiguous());
        assert!(clear().all(|(truth, hit)| truth.verdict == hit.verdict));
        assert!(clear().filter(|(_, hit)| hit.is_hit()).count() > 100);
    }

    /// Packets are the same eight rays in every band, so not a bit differs.
    #[test]
    fn bands_are_those_of_the_whole_picture() {
        for name in ["colors-100", "molecule", "eye-inside-surface"] {
            let bench = bench(name);
            let view = View::new(bench.camera, 61, 83).expect("a size");
            for method in [Method::default(), Method::Tree(fbvh::Options::fitted())] {
                for picture in [Picture::Phong, Picture::Normal, Picture::Color] {
                    let method = method.clone();
                    let options = DrawOptions { method, picture, ..DrawOptions::default() };
                    let band = |pixels| drawn(&bench.scene, &view, &options, pixels);
                    let whole = band(u32::MAX);
                    assert!(band(1) == whole && band(61 * 30) == whole, "{name}, {picture:?}");
                }
            }
        }
    }

    #[test]
    fn light_of_bands_is_that_of_the_whole_picture() {
        for name in ["colors-100", "molecule"] {
            let bench = bench(name);
            let view = View::new(bench.camera, 61, 83).expect("a size");
            let light = crate::LightOptions {
                shadows: true,
                ambient_occlusion: Some(2),
                reflections: Some(1),
                samples: Some(2),
                ..crate::LightOptions::default()
            };
            let options = DrawOptions { light, ..DrawOptions::default() };
            let band = |pixels| drawn(&bench.scene, &view, &options, pixels);
            let whole = band(u32::MAX);
            assert_eq!(whole.light.len(), view.pixels());
            assert!(band(1) == whole && band(61 * 30) == whole, "{name}");
        }
    }

    #[test]
    fn a_solid_scene_ends_rays() {
        let bench = bench("filling");
        let view = View::new(bench.camera, 2, 1).expect("a size");
        let view = view.with_opaque_distance(Arc::from([1e-3, f32::INFINITY])).expect("two pixels");
        let method = Method::Tree(fbvh::Options::fitted());
        let options = DrawOptions { method, ..DrawOptions::default() };
        let hits = drawn(&bench.scene, &view, &options, 1).hits;
        assert_eq!([hits[0].is_hit(), hits[1].is_hit()], [false, true]);
    }

    #[test]
    #[cfg(feature = "harness")]
    fn methods_without_a_tree_are_refused_by_name() {
        let bench = bench("empty");
        let kanamori = harness::methods::find("kanamori").expect("listed");
        let error = Built::new(&Method::Listed(kanamori.into()), &bench.scene);
        let error = error.expect_err("no tree").to_string();
        assert!(
            error.contains("kanamori") && error.ends_with("bvh, fbvh, fbvh-certified"),
            "{error}"
        );
        let compared = harness::methods::find("kanamori-cpu").expect("listed");
        let error = Built::new(&Method::Listed(compared.into()), &bench.scene);
        assert!(error.expect_err("no tree").to_string().contains("there to be compared"));
    }
}
