//! Test scenes with their truth, and pictures of them: made once, shared by all trials.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use bench_scenes::BenchScene;
use harness::canvas::Canvas;
use harness::configuration::Configuration;
use harness::judge::Judge;
use libtest_mimic::Failed;
use metaball_core::gpu::{Gpu, Targets};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, View};

use super::{draw, load, view_of};

/// A known scene in its view, with the truth about every ray.
pub(super) struct Fixture {
    pub(super) scene: &'static BenchScene,
    pub(super) view: View,
    pub(super) judge: Judge<'static>,
}

/// The fixture of a known scene.
pub(super) fn fixture(gpu: &Gpu, scene: &'static str) -> Result<Arc<Fixture>, Failed> {
    static FIXTURES: Cache<&'static str, Fixture> = Cache::new();
    FIXTURES.get(scene, || {
        // Fixtures live to the end of the process.
        let scene: &'static BenchScene = Box::leak(Box::new(load(scene)?));
        let oracle: &'static Oracle<'_> = Box::leak(Box::new(Oracle::new(&scene.scene)));
        let view = view_of(scene)?;
        let targets = Targets::new(gpu, view.width(), view.height(), false, false)?;
        let rays = Vec::leak(Canvas::on_adapter(gpu, &targets).rays(&view)?);
        Ok(Fixture { scene, view, judge: Judge::new(&scene.scene, oracle, rays) })
    })
}

/// A method's picture of a known scene.
pub(super) fn picture(
    gpu: &Gpu,
    scene: &'static str,
    configuration: &Configuration,
) -> Result<Arc<Vec<Hit>>, Failed> {
    static PICTURES: Cache<(&'static str, String), Vec<Hit>> = Cache::new();
    let fixture = fixture(gpu, scene)?;
    PICTURES.get((scene, configuration.name.clone()), || {
        let mut renderer = configuration.renderer(false);
        let picture = draw(gpu, &mut renderer, &fixture.scene.scene, &fixture.view)?;
        if picture.rays != fixture.judge.rays() {
            return Err("two frames of one view have different rays".into());
        }
        Ok(picture.hits)
    })
}

/// Values by key, each made when it is first needed. A failure is kept as well.
struct Cache<K, V> {
    slots: OnceLock<Mutex<HashMap<K, Arc<Slot<V>>>>>,
}

type Slot<V> = OnceLock<Result<Arc<V>, String>>;

impl<K: Eq + Hash, V> Cache<K, V> {
    const fn new() -> Self {
        Self { slots: OnceLock::new() }
    }

    fn get(&self, key: K, make: impl FnOnce() -> Result<V, Failed>) -> Result<Arc<V>, Failed> {
        let slots = self.slots.get_or_init(Mutex::default);
        // The lock is not held while a value is made: others can be made meanwhile.
        let slot = {
            let mut slots = slots.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(slots.entry(key).or_default())
        };
        let made = slot.get_or_init(|| {
            let text = |failed: Failed| failed.message().unwrap_or("failed").to_owned();
            make().map(Arc::new).map_err(text)
        });
        made.clone().map_err(Failed::from)
    }
}
