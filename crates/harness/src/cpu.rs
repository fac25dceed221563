//! Drawing without a graphics adapter: rays made on the host, traced by fbvh's own tracer.

use std::time::{Duration, Instant};

use anyhow::Context;
use fbvh::{Options, TraceOptions, Tracer, Tree};
use metaball_core::{Hit, Ray, Scene, View};

use crate::methods::{METHODS, Method, tree_options};

/// A view traced on the CPU.
#[derive(Debug, Clone)]
pub struct Traced {
    /// The rays, row by row from the top left.
    pub rays: Vec<Ray>,
    /// Their hits.
    pub hits: Vec<Hit>,
    /// Time for the tree.
    pub build: Duration,
    /// Time for the rays: making and tracing them.
    pub frame: Duration,
}

/// Builds the method's tree and traces the view's rays through it.
///
/// # Errors
/// When the method has no tree that the CPU traces, or a tree for the scene cannot be built.
pub fn trace(method: &Method, scene: &Scene, view: &View) -> anyhow::Result<Traced> {
    let options = options_of(method)?;
    let start = Instant::now();
    let tree = Tree::build(scene, &options).with_context(|| format!("method {}", method.name))?;
    let build = start.elapsed();

    let start = Instant::now();
    let rays = view.rays();
    let tracer = Tracer::new(&tree, scene, TraceOptions::DEFAULT);
    let hits = tracer.picture_hits(&rays, view.width() as usize);
    Ok(Traced { rays, hits, build, frame: start.elapsed() })
}

fn options_of(method: &Method) -> anyhow::Result<Options> {
    tree_options(method.name).with_context(|| {
        let able = METHODS.iter().map(|method| method.name);
        let able: Vec<_> = able.filter(|name| tree_options(name).is_some()).collect();
        format!(
            "method {} needs a graphics adapter; the CPU traces {}",
            method.name,
            able.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use bench_scenes::{Overrides, load};
    use metaball_core::reference::Oracle;

    use super::*;
    use crate::methods::find;

    fn method(name: &str) -> &'static Method {
        find(name).expect("listed")
    }

    /// The certified tree is never wrong: away from rays that are too close to call, what is traced
    /// is the truth.
    #[test]
    fn pictures_are_right_without_an_adapter() {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 40, 30).expect("a size");
        let traced = trace(method("fbvh-certified"), &bench.scene, &view).expect("traced");
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
        let traced = trace(method("fbvh"), &bench.scene, &view).expect("traced");
        assert_eq!([traced.hits[0].is_hit(), traced.hits[1].is_hit()], [false, true]);
    }

    #[test]
    fn methods_without_a_tree_are_refused_by_name() {
        let bench = load("empty", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 2, 2).expect("a size");
        let error =
            trace(method("kanamori"), &bench.scene, &view).expect_err("no tree").to_string();
        assert!(
            error.contains("kanamori") && error.ends_with("bvh, fbvh, fbvh-certified"),
            "{error}"
        );
    }
}
