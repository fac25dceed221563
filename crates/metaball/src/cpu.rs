//! Tracing without a graphics adapter: rays made on the host, traced by fbvh's own tracer.

use std::time::{Duration, Instant};

use fbvh::{Options, Tracer, Tree};
use metaball_core::{Hit, Ray, Scene, View};

use crate::{Error, Method};

/// A view traced on the CPU.
#[derive(Debug, Clone)]
pub(crate) struct Traced {
    /// The rays, row by row from the top left.
    pub(crate) rays: Vec<Ray>,
    /// Their hits.
    pub(crate) hits: Vec<Hit>,
    /// Time for the tree.
    pub(crate) build: Duration,
    /// Time for the rays: making and tracing them.
    pub(crate) frame: Duration,
}

/// Builds the method's tree and traces the view's rays through it.
pub(crate) fn trace(method: &Method, scene: &Scene, view: &View) -> Result<Traced, Error> {
    let options = options_of(method)?;
    let start = Instant::now();
    let tree = Tree::build(scene, &options)
        .map_err(|source| Error::Build { method: method.name().to_owned(), source })?;
    let build = start.elapsed();

    let start = Instant::now();
    let rays = view.rays();
    let tracer = Tracer::new(&tree, scene);
    let hits = tracer.picture_hits(&rays, view.width() as usize);
    Ok(Traced { rays, hits, build, frame: start.elapsed() })
}

fn options_of(method: &Method) -> Result<Options, Error> {
    method.tree().ok_or_else(|| Error::NeedsAdapter {
        what: format!("method {}", method.name()),
        instead: "the CPU traces bvh, fbvh, fbvh-certified".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bench_scenes::{Overrides, load};
    use metaball_core::reference::Oracle;

    use super::*;

    /// The certified tree is never wrong: away from rays that are too close to call, what is traced
    /// is the truth.
    #[test]
    fn pictures_are_right_without_an_adapter() {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 40, 30).expect("a size");
        let traced = trace(&Method::default(), &bench.scene, &view).expect("traced");
        let truths = Oracle::new(&bench.scene).first_hits(&traced.rays);
        let clear = || truths.iter().zip(&traced.hits).filter(|(truth, _)| !truth.is_ambiguous());
        assert!(clear().all(|(truth, hit)| truth.verdict == hit.verdict));
        assert!(clear().filter(|(_, hit)| hit.is_hit()).count() > 100);
    }

    #[test]
    fn a_solid_scene_ends_rays() {
        let bench = load("filling", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 2, 1).expect("a size");
        let view = view.with_opaque_distance(Arc::from([1e-3, f32::INFINITY])).expect("two pixels");
        let traced = trace(&Method::Tree(Options::fitted()), &bench.scene, &view).expect("traced");
        assert_eq!([traced.hits[0].is_hit(), traced.hits[1].is_hit()], [false, true]);
    }

    #[test]
    #[cfg(feature = "harness")]
    fn methods_without_a_tree_are_refused_by_name() {
        let bench = load("empty", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 2, 2).expect("a size");
        let kanamori = harness::methods::find("kanamori").expect("listed");
        let error = trace(&Method::Listed(kanamori.into()), &bench.scene, &view);
        let error = error.expect_err("no tree").to_string();
        assert!(
            error.contains("kanamori") && error.ends_with("bvh, fbvh, fbvh-certified"),
            "{error}"
        );
    }
}
