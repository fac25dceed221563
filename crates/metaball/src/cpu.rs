//! Pictures on the CPU, band by band: rays made on the host, traced by fbvh's own tracer.

use std::ops::Range;
use std::time::{Duration, Instant};

use fbvh::{Tracer, Tree};
use metaball_core::{Scene, ValueRange, View};

use crate::band::{Band, Planes};
use crate::shade::{CpuPicture, Shader};
use crate::summary::Tally;
use crate::{DrawOptions, Error, Method};

/// A method's tree, with the time that it took.
#[derive(Debug)]
pub(crate) struct Built {
    pub(crate) tree: Tree,
    pub(crate) time: Duration,
}

/// Builds the method's tree.
pub(crate) fn build(method: &Method, scene: &Scene) -> Result<Built, Error> {
    let options = method.tree().ok_or_else(|| Error::NeedsAdapter {
        what: format!("method {}", method.name()),
        instead: "the CPU traces bvh, fbvh, fbvh-certified".to_owned(),
    })?;
    let start = Instant::now();
    let tree = Tree::build(scene, &options)
        .map_err(|source| Error::Build { method: method.name().to_owned(), source })?;
    Ok(Built { tree, time: start.elapsed() })
}

/// Draws bands of a view, in any order: each is the same, bit for bit, as in the whole picture.
pub(crate) struct Painter<'a> {
    view: &'a View,
    tracer: Tracer<'a, Scene>,
    shader: Shader<'a>,
}

impl<'a> Painter<'a> {
    pub(crate) fn new(
        built: &'a Built,
        scene: &'a Scene,
        view: &'a View,
        options: &DrawOptions,
    ) -> Result<Self, Error> {
        if options.light.is_asked() {
            return Err(Error::NeedsAdapter {
                what: "light".to_owned(),
                instead: CpuPicture::CHOICE.to_owned(),
            });
        }
        let picture = CpuPicture::of(options.picture)?;
        let tracer = Tracer::new(&built.tree, scene);
        Ok(Self { view, tracer, shader: Shader::new(scene, view, picture) })
    }

    /// Whether pixels depend on hits of the whole picture: then no band has any before it is
    /// [finished](Finisher).
    pub(crate) fn waits(&self) -> bool {
        self.shader.needs_range()
    }

    /// Draws some rows, from a multiple of sixteen on.
    pub(crate) fn band(&self, rows: Range<u32>, planes: Planes) -> Band {
        let start = Instant::now();
        let rays = self.view.rays_of_rows(rows.clone());
        let hits = self.tracer.picture_hits(&rays, self.view.width() as usize);
        let tally = Tally { frame: start.elapsed(), ..Tally::of(&hits) };
        let shade = || self.shader.pixels(rows.start, &rays, &hits, ValueRange::default());
        let pixels = planes.pixels.then(shade).unwrap_or_default();
        let hits = if planes.hits { hits } else { Vec::new() };
        Band { rows, pixels, hits, light: Vec::new(), tally }
    }
}

/// Makes the pixels of a picture that waits for all of its hits.
pub(crate) struct Finisher<'p, 'a> {
    painter: &'p Painter<'a>,
    range: ValueRange,
}

impl<'p, 'a> Finisher<'p, 'a> {
    /// Of a picture with these distances.
    pub(crate) fn new(painter: &'p Painter<'a>, range: ValueRange) -> Self {
        Self { painter, range }
    }

    /// Makes the pixels of a band that has hits.
    pub(crate) fn finish(&self, band: &mut Band) {
        let rays = self.painter.view.rays_of_rows(band.rows.clone());
        band.pixels = self.painter.shader.pixels(band.rows.start, &rays, &band.hits, self.range);
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

    const PLANES: Planes = Planes { pixels: true, hits: true, light: false };

    fn bench(name: &str) -> BenchScene {
        load(name, &Overrides::default()).expect("known")
    }

    /// A view drawn in bands of at least so many pixels.
    fn drawn(scene: &Scene, view: &View, options: &DrawOptions, pixels: u32) -> Band {
        let built = build(&options.method, scene).expect("built");
        let painter = Painter::new(&built, scene, view, options).expect("a painter");
        let mut whole = Band::default();
        for rows in bands(view, 0, pixels) {
            whole.append(painter.band(rows, PLANES));
        }
        whole.tally.frame = Duration::ZERO;
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
        let error = build(&Method::Listed(kanamori.into()), &bench.scene);
        let error = error.expect_err("no tree").to_string();
        assert!(
            error.contains("kanamori") && error.ends_with("bvh, fbvh, fbvh-certified"),
            "{error}"
        );
    }
}
