//! Pictures on a graphics adapter.

mod certain;
mod light;

use std::ops::ControlFlow;
use std::time::Duration;

use metaball_core::gpu::{self, Gpu, IsoRenderer, RenderError, Shading, Targets};
use metaball_core::{Picture, Scene, View};

pub(crate) use self::certain::Certain;
#[cfg(feature = "harness")]
use crate::Method;
use crate::summary::{Progress, Summary, Tally};
use crate::{DrawOptions, Drawing, Error};

/// Draws on the adapter, which is described by these words.
pub(crate) fn draw(
    (gpu, computed_by): (&Gpu, String),
    options: &DrawOptions,
    scene: &Scene,
    view: &View,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Drawing, Error> {
    let targets = options.targets(gpu, scene)?;
    let Prepared { mut renderer, build, account } = prepared(gpu, options, scene, view)?;
    gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let frame = gpu::render(gpu, renderer.as_mut(), &targets, view)?.wall;
    let certain = Certain::new(scene);
    let mut hits = targets.read_hits(gpu)?;
    let asked_again = certain.decide(gpu, &targets, view, &mut hits)?;
    let tally = Tally { frame, asked_again, ..Tally::of(&hits) };
    let mut summary = Summary { tally, range: None, samples: None, account, computed_by, build };
    let Some(lighting) = options.lighting(view, scene)? else {
        let shaded = Shading::new(gpu).draw(&targets, view, scene, options.picture)?;
        summary.range = shaded.range;
        return Ok(Drawing { image: shaded.image, hits, film: None, summary });
    };
    let lit = lighting.draw(gpu, renderer.as_mut(), &certain, view, &hits, progress)?;
    summary.samples = Some(lit.samples);
    summary.tally.light = lit.time;
    summary.tally.asked_again += lit.asked_again;
    Ok(Drawing { image: lit.image, hits, film: Some(lit.film), summary })
}

/// A renderer that has its scene.
struct Prepared {
    renderer: Box<dyn IsoRenderer>,
    build: Duration,
    account: Vec<(&'static str, String)>,
}

fn prepared(
    gpu: &Gpu,
    options: &DrawOptions,
    scene: &Scene,
    view: &View,
) -> Result<Prepared, Error> {
    #[cfg(feature = "harness")]
    if let Method::Auto(choosing) = &options.method {
        return chosen(gpu, options, choosing, scene, view);
    }
    #[cfg(not(feature = "harness"))]
    let _asked_by_auto_alone = view;
    let mut renderer = options.renderer()?;
    let build = renderer.build(gpu, scene)?.structure;
    Ok(Prepared { renderer, build, account: options.method.account() })
}

#[cfg(feature = "harness")]
fn chosen(
    gpu: &Gpu,
    options: &DrawOptions,
    choosing: &crate::Choosing,
    scene: &Scene,
    view: &View,
) -> Result<Prepared, Error> {
    let mut candidates = harness::configuration::sweeps::candidates();
    candidates.retain(|configuration| {
        let tree = configuration.technique.tree().map(|options| options.kind());
        configuration.needs_adapter() && options.light.is_given_by_tree(tree)
    });
    let auto = harness::auto::Auto::new(candidates, choosing.max_error, choosing.cache.clone());
    let chosen = auto.choose(Some(gpu), scene, view)?;
    let account = chosen.account();
    let method = Method::Listed(chosen.configuration);
    let mut renderer = DrawOptions { method, ..options.clone() }.renderer()?;
    let build = renderer.build(gpu, scene)?.structure;
    Ok(Prepared { renderer, build, account })
}

impl DrawOptions {
    /// What an adapter refused, with what there is instead where it is too large.
    pub(crate) fn refused(&self, refusal: RenderError) -> Error {
        if !refusal.is_too_large() {
            return refusal.into();
        }
        let instead = match self.method.tree() {
            Some(_) if self.is_for_cpu() => "the CPU draws any size",
            Some(_) => "a smaller size may fit",
            None => "a smaller size may fit; the CPU draws any with bvh, fbvh or fbvh-certified",
        };
        Error::TooLarge { refusal, instead }
    }

    /// What the frames of such a scene are drawn to.
    pub(crate) fn targets(&self, gpu: &Gpu, scene: &Scene) -> Result<Targets, RenderError> {
        let (width, height) = self.size;
        Targets::new(gpu, width, height, scene.colors().is_some(), self.counts())
    }

    /// A renderer of the method, without a scene.
    pub(crate) fn renderer(&self) -> Result<Box<dyn IsoRenderer>, Error> {
        self.method.on_adapter(self.counts()).ok_or_else(|| Error::Option {
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
    use metaball_core::gpu::AdapterChoice;

    use super::*;
    use crate::{Backend, draw};

    /// A row is longer than any adapter dispatches.
    #[test]
    fn what_does_not_fit_the_adapter_is_left_to_the_cpu() {
        if Gpu::for_test().is_none() {
            return;
        }
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let backend = Backend::Adapter(AdapterChoice::Environment);
        let long = DrawOptions { size: (600_000, 1), backend, ..DrawOptions::default() };
        let drawing = draw(&bench.scene, &bench.camera, &long).expect("drawn");
        let reason = drawing.summary.computed_by;
        assert!(
            reason.starts_with("the CPU, ") && reason.ends_with("found 600000 × 1"),
            "{reason}"
        );
        let on_cpu = DrawOptions { backend: Backend::Cpu, ..long.clone() };
        let wanted = draw(&bench.scene, &bench.camera, &on_cpu).expect("drawn");
        assert!(drawing.image == wanted.image && drawing.hits == wanted.hits);

        let refused = |options: &DrawOptions| {
            draw(&bench.scene, &bench.camera, options).expect_err("too large").to_string()
        };
        let spheres = DrawOptions { picture: Picture::Spheres, ..long.clone() };
        let error = refused(&spheres);
        assert!(error.ends_with("found 600000 × 1; a smaller size may fit"), "{error}");
        #[cfg(feature = "harness")]
        {
            let kanamori = harness::methods::find("kanamori").expect("listed");
            let method = Method::Listed(kanamori.into());
            let error = refused(&DrawOptions { method, ..long });
            assert!(
                error.ends_with("the CPU draws any with bvh, fbvh or fbvh-certified"),
                "{error}"
            );
        }
    }
}
