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

use metaball_core::gpu::{Gpu, RenderError};
use metaball_core::{Scene, View};

use self::cache::{Cache, Key};
use self::calibration::calibrate;
use self::choice::Choice;
use crate::configuration::Configuration;

/// Default of the largest error, mean support radii: a fiftieth of what makes a wrong front, and what
/// the coarsest published root finder keeps.
pub const MAX_ERROR: f64 = 1e-3;

/// Chooses for scenes.
#[derive(Debug, Clone)]
pub struct Auto {
    candidates: Vec<Configuration>,
    max_error: f64,
    cache: Cache,
}

/// What was chosen for a scene, to draw it with.
#[derive(Debug, Clone)]
pub struct Chosen {
    /// The configuration.
    pub configuration: Configuration,
    /// Why it, and not another.
    pub choice: Choice,
    /// Whether the cache knew the choice, or why it could not keep it.
    origin: String,
}

impl Auto {
    /// Will choose among the candidates, for an error of at most `max_error` mean support radii.
    pub fn new(candidates: Vec<Configuration>, max_error: f64, cache: Cache) -> Self {
        Self { candidates, max_error, cache }
    }

    /// Chooses by how the candidates do on the scene in the view. Without an adapter those that need one are
    /// left out, with that for a reason.
    ///
    /// # Errors
    /// When none will do, with the reason for each; when the view cannot be drawn at all.
    pub fn choose(
        &self,
        gpu: Option<&Gpu>,
        scene: &Scene,
        view: &View,
    ) -> Result<Chosen, RenderError> {
        let names = self.candidates.iter().map(|configuration| configuration.name.as_str());
        let key = Key::new(gpu, scene, view, self.max_error, names);
        if let Some(choice) = self.cache.find(&key)
            && let Some(configuration) = self.configuration(&choice)
        {
            let origin = "made earlier, for the same scene, view and adapter".to_owned();
            return Ok(Chosen { configuration, choice, origin });
        }
        let choice = calibrate(gpu, scene, view, &self.candidates, self.max_error)?;
        let origin = match self.cache.keep(&key, &choice) {
            Ok(()) => "made now".to_owned(),
            Err(error) => format!("made now, and not kept: {error:#}"),
        };
        let configuration =
            self.configuration(&choice).ok_or_else(|| RenderError::Unsupported {
                method: NAME,
                reason: format!("needed a candidate called {}, found none", choice.configuration),
            })?;
        Ok(Chosen { configuration, choice, origin })
    }

    fn configuration(&self, choice: &Choice) -> Option<Configuration> {
        let is_chosen = |configuration: &&Configuration| configuration.name == choice.configuration;
        self.candidates.iter().find(is_chosen).cloned()
    }
}

impl Chosen {
    /// What was chosen, why, and what it expects, as names and texts.
    pub fn account(&self) -> Vec<(&'static str, String)> {
        let mut lines = self.choice.account();
        lines.push(("choice", self.origin.clone()));
        lines
    }
}

const NAME: &str = "auto";

#[cfg(test)]
mod tests {
    use bench_scenes::{BenchScene, Overrides, load};
    use metaball_core::gpu::Targets;
    use metaball_core::reference::Oracle;

    use super::*;
    use crate::auto::choice::Errors;
    use crate::canvas::Canvas;
    use crate::configuration::sweeps::candidates;
    use crate::measure::PreparedRenderer;

    fn auto(kept: &[&str], max_error: f64, cache: &Cache) -> Auto {
        let is_kept = |configuration: &Configuration| kept.contains(&configuration.name.as_str());
        Auto::new(candidates().into_iter().filter(is_kept).collect(), max_error, cache.clone())
    }

    const ON_ADAPTER: &[&str] = &["fbvh-certified", "illes-rebuilt", "illes-exact"];

    fn view_of(bench: &BenchScene) -> View {
        View::new(bench.camera, 48, 36).expect("a view")
    }

    #[test]
    fn the_picture_keeps_the_error_and_the_choice_is_kept() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("random-200", &Overrides::default()).expect("known");
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::at(folder.path().to_owned());
        let (auto, view) = (auto(ON_ADAPTER, MAX_ERROR, &cache), view_of(&bench));
        let choose = || auto.choose(Some(&gpu), &bench.scene, &view).expect("chosen");
        let first = choose();

        let targets = Targets::new(&gpu, 48, 36, false, false).expect("targets");
        let canvas = Canvas::on_adapter(&gpu, &targets);
        let rays = canvas.rays(&view).expect("rays");
        let renderer = first.configuration.renderer(false);
        let drawn =
            PreparedRenderer::prepare(canvas, renderer, &bench.scene, &view).expect("drawn");
        let truths = Oracle::new(&bench.scene).first_hits(&rays);
        let errors =
            Errors::of(truths.iter().zip(&drawn.hits), reference_view::mean_radius(&bench.scene));
        assert!(errors.keep(MAX_ERROR), "{errors:?}");
        // The cubic is out at this error: its p99 is percents of a radius.
        let choice = &first.choice;
        assert!(choice.left_out.iter().any(|(name, _)| name == "illes-rebuilt"), "{choice:?}");

        // The second one finds the choice; a broken file is replaced, not believed.
        let second = choose();
        assert_eq!(second.configuration.name, first.configuration.name);
        assert!(second.account().iter().any(|(_, text)| text.starts_with("made earlier")));
        for file in std::fs::read_dir(folder.path()).expect("made") {
            std::fs::write(file.expect("there").path(), "{ half a fi").expect("written");
        }
        assert!(choose().account().iter().any(|(_, text)| text == "made now"));
    }

    #[test]
    fn what_nobody_keeps_is_refused_with_reasons() {
        let bench = load("random-200", &Overrides::default()).expect("known");
        let auto = auto(&["fbvh-certified-cpu"], 1e-12, &Cache::none());
        let refused = auto.choose(None, &bench.scene, &view_of(&bench));
        let error = refused.expect_err("f32 is coarser").to_string();
        assert!(error.contains("1.0e-12") && error.contains("fbvh-certified-cpu: "), "{error}");
    }

    #[test]
    fn without_an_adapter_the_cpu_is_left_to_choose_from() {
        let bench = load("random-200", &Overrides::default()).expect("known");
        let names = ["fbvh-certified", "fbvh-certified-cpu", "kanamori-cpu"];
        let auto = auto(&names, MAX_ERROR, &Cache::none());
        let chosen = auto.choose(None, &bench.scene, &view_of(&bench)).expect("two will do");
        assert!(names[1..].contains(&chosen.configuration.name.as_str()));
        assert!(!chosen.configuration.needs_adapter());
        let reason = "needed a graphics adapter, found none".to_owned();
        assert_eq!(chosen.choice.left_out, [("fbvh-certified".to_owned(), reason)]);
    }
}
