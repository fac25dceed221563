//! No more than a scene needs: `auto` draws with the cheapest method, variant and knobs whose error
//! on this scene, in this view, is small enough.
//!
//! Every method draws a sparse picture, which is held against the oracle, and cruder versions of those
//! methods that are right enough and quick draw one too. The quickest that are right enough draw the
//! whole picture, are held against the oracle along rays that the first picture did not have, and are
//! timed there. The quickest that still is right enough draws.

pub mod cache;
pub mod calibration;
pub mod choice;
pub mod reference_view;

use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RayTracer, RenderError,
};
use metaball_core::{Scene, View};

use self::cache::{Cache, Key};
use self::calibration::calibrate;
use self::choice::Choice;
use crate::configuration::Configuration;

/// Default of the largest error, mean support radii: a fiftieth of what makes a wrong front, and what
/// the coarsest published root finder keeps.
pub const MAX_ERROR: f64 = 1e-3;

/// Draws with what it has chosen for the scene. Building includes choosing, whose time is not in the
/// report of the build.
pub struct Auto {
    candidates: Vec<Configuration>,
    view: View,
    max_error: f64,
    cache: Cache,
    counting: bool,
    chosen: Option<Chosen>,
}

struct Chosen {
    choice: Choice,
    renderer: Box<dyn IsoRenderer>,
    /// Whether the cache knew the choice, or why it could not keep it.
    origin: String,
}

impl Auto {
    /// Will choose among the candidates by how they do in the view, with an error of at most
    /// `max_error` mean support radii. The renderer that it chooses counts its work or, as when
    /// timing, does not.
    pub fn new(
        candidates: Vec<Configuration>,
        view: View,
        max_error: f64,
        cache: Cache,
        counting: bool,
    ) -> Self {
        Self { candidates, view, max_error, cache, counting, chosen: None }
    }

    /// What was chosen for the scene built last.
    pub fn choice(&self) -> Option<&Choice> {
        self.chosen.as_ref().map(|chosen| &chosen.choice)
    }

    /// What was chosen, why, and what it expects, as names and texts.
    pub fn account(&self) -> Vec<(&'static str, String)> {
        let Some(chosen) = &self.chosen else { return Vec::new() };
        let mut lines = chosen.choice.account();
        lines.push(("choice", chosen.origin.clone()));
        lines
    }

    fn choose(&self, gpu: &Gpu, scene: &Scene) -> Result<(Choice, String), RenderError> {
        let names = self.candidates.iter().map(|configuration| configuration.name.as_str());
        let key = Key::new(gpu, scene, &self.view, self.max_error, names);
        let is_known = |choice: &Choice| self.configuration(choice).is_some();
        if let Some(choice) = self.cache.find(&key).filter(is_known) {
            return Ok((choice, "made earlier, for the same scene, view and adapter".to_owned()));
        }
        let choice = calibrate(gpu, scene, &self.view, &self.candidates, self.max_error)?;
        let origin = match self.cache.keep(&key, &choice) {
            Ok(()) => "made now".to_owned(),
            Err(error) => format!("made now, and not kept: {error:#}"),
        };
        Ok((choice, origin))
    }

    fn configuration(&self, choice: &Choice) -> Option<&Configuration> {
        self.candidates.iter().find(|configuration| configuration.name == choice.configuration)
    }

    fn renderer(&mut self) -> Result<&mut dyn IsoRenderer, RenderError> {
        match &mut self.chosen {
            Some(chosen) => Ok(chosen.renderer.as_mut()),
            None => Err(RenderError::NotBuilt { method: NAME }),
        }
    }
}

const NAME: &str = "auto";

impl IsoRenderer for Auto {
    fn name(&self) -> &'static str {
        NAME
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.chosen = None;
        let (choice, origin) = self.choose(gpu, scene)?;
        let configuration =
            self.configuration(&choice).ok_or_else(|| RenderError::Unsupported {
                method: NAME,
                reason: format!("needed a candidate called {}, found none", choice.configuration),
            })?;
        let mut renderer = configuration.renderer(self.counting);
        let report = renderer.build(gpu, scene)?;
        self.chosen = Some(Chosen { choice, renderer, origin });
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        self.renderer()?.encode(frame)
    }

    fn frame_facts(&self, gpu: &Gpu) -> Result<Vec<(&'static str, f64)>, RenderError> {
        self.chosen.as_ref().map_or(Ok(Vec::new()), |chosen| chosen.renderer.frame_facts(gpu))
    }

    fn frame_bytes(&self) -> u64 {
        self.chosen.as_ref().map_or(0, |chosen| chosen.renderer.frame_bytes())
    }

    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        self.renderer()?.grow(gpu, status)
    }

    fn ray_tracer(&mut self) -> Option<&mut dyn RayTracer> {
        self.chosen.as_mut().and_then(|chosen| chosen.renderer.ray_tracer())
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{BenchScene, Overrides, load};
    use metaball_core::gpu::{Targets, render};
    use metaball_core::reference::Oracle;

    use super::*;
    use crate::auto::choice::Errors;
    use crate::configuration::sweeps::candidates;

    fn few() -> Vec<Configuration> {
        let kept = ["fbvh-certified", "illes", "illes-exact"];
        candidates()
            .into_iter()
            .filter(|configuration| kept.contains(&configuration.name.as_str()))
            .collect()
    }

    fn auto(bench: &BenchScene, max_error: f64, cache: &Cache) -> Auto {
        let view = View::new(bench.camera, 48, 36).expect("a view");
        Auto::new(few(), view, max_error, cache.clone(), false)
    }

    #[test]
    fn the_picture_keeps_the_error_and_the_choice_is_kept() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("random-200", &Overrides::default()).expect("known");
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::at(folder.path().to_owned());
        let mut first = auto(&bench, MAX_ERROR, &cache);
        first.build(&gpu, &bench.scene).expect("chosen");

        let targets = Targets::new(&gpu, 48, 36, false, false).expect("targets");
        let view = first.view.clone();
        render(&gpu, &mut first, &targets, &view).expect("drawn");
        let rays = targets.read_rays(&gpu, &view).expect("rays");
        let truths = Oracle::new(&bench.scene).first_hits(&rays);
        let hits = targets.read_hits(&gpu).expect("hits");
        let errors =
            Errors::of(truths.iter().zip(&hits), reference_view::mean_radius(&bench.scene));
        assert!(errors.keep(MAX_ERROR), "{errors:?}");
        // The cubic is out at this error: its p99 is percents of a radius.
        let choice = first.choice().expect("chosen").clone();
        assert!(choice.left_out.iter().any(|(name, _)| name == "illes"), "{choice:?}");

        // The second one finds the choice; a broken file is replaced, not believed.
        let mut second = auto(&bench, MAX_ERROR, &cache);
        second.build(&gpu, &bench.scene).expect("chosen");
        assert_eq!(second.choice().expect("chosen").configuration, choice.configuration);
        assert!(second.account().iter().any(|(_, text)| text.starts_with("made earlier")));
        for file in std::fs::read_dir(folder.path()).expect("made") {
            std::fs::write(file.expect("there").path(), "{ half a fi").expect("written");
        }
        second.build(&gpu, &bench.scene).expect("chosen anew");
        assert!(second.account().iter().any(|(_, text)| text == "made now"));
    }

    #[test]
    fn what_nobody_keeps_is_refused_with_reasons() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("random-200", &Overrides::default()).expect("known");
        let mut auto = auto(&bench, 1e-12, &Cache::none());
        let error = auto.build(&gpu, &bench.scene).expect_err("f32 is coarser").to_string();
        assert!(error.contains("1.0e-12") && error.contains("fbvh-certified: "), "{error}");
        assert!(auto.choice().is_none() && auto.account().is_empty());
        assert!(auto.ray_tracer().is_none());
    }
}
