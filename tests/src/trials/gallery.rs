//! Scenes with their truth, and pictures of them: made once, shared by all trials.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use bench_scenes::BenchScene;
use harness::configuration::Configuration;
use harness::judge::Judge;
use libtest_mimic::Failed;
use metaball_core::gpu::{Frame, Gpu, Targets};
use metaball_core::reference::Oracle;
use metaball_core::{Hit, View};

use super::{draw, load, view_of};

/// A scene in its view, with the truth about every ray.
pub(super) struct Room {
    pub(super) scene: &'static BenchScene,
    pub(super) view: View,
    pub(super) judge: Judge<'static>,
}

/// The room of a known scene.
pub(super) fn room(gpu: &Gpu, scene: &'static str) -> Result<Arc<Room>, Failed> {
    static ROOMS: Shelf<&'static str, Room> = Shelf::new();
    ROOMS.get(scene, || {
        // Rooms stand to the end of the process.
        let scene: &'static BenchScene = Box::leak(Box::new(load(scene)?));
        let oracle: &'static Oracle<'_> = Box::leak(Box::new(Oracle::new(&scene.scene)));
        let view = view_of(scene)?;
        // A frame without a method makes the rays.
        let targets = Targets::new(gpu, view.width(), view.height(), false, false)?;
        Frame::begin(gpu, &targets, &view)?.finish()?;
        let rays = Vec::leak(targets.read_rays(gpu, &view)?);
        Ok(Room { scene, view, judge: Judge::new(&scene.scene, oracle, rays) })
    })
}

/// A method's picture of a known scene.
pub(super) fn picture(
    gpu: &Gpu,
    scene: &'static str,
    configuration: &Configuration,
) -> Result<Arc<Vec<Hit>>, Failed> {
    static PICTURES: Shelf<(&'static str, String), Vec<Hit>> = Shelf::new();
    let room = room(gpu, scene)?;
    PICTURES.get((scene, configuration.name.clone()), || {
        let mut renderer = configuration.renderer(false);
        let picture = draw(gpu, renderer.as_mut(), &room.scene.scene, &room.view)?;
        if picture.rays != room.judge.rays() {
            return Err("two frames of one view have different rays".into());
        }
        Ok(picture.hits)
    })
}

/// Things by name, each made by whoever asks first. What could not be made stays so.
struct Shelf<K, V> {
    places: OnceLock<Mutex<HashMap<K, Arc<Place<V>>>>>,
}

type Place<V> = OnceLock<Result<Arc<V>, String>>;

impl<K: Eq + Hash, V> Shelf<K, V> {
    const fn new() -> Self {
        Self { places: OnceLock::new() }
    }

    fn get(&self, name: K, make: impl FnOnce() -> Result<V, Failed>) -> Result<Arc<V>, Failed> {
        let places = self.places.get_or_init(Mutex::default);
        // The lock is not held while a thing is made: other things can be made meanwhile.
        let place = {
            let mut places = places.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(places.entry(name).or_default())
        };
        let made = place.get_or_init(|| {
            let text = |failed: Failed| failed.message().unwrap_or("failed").to_owned();
            make().map(Arc::new).map_err(text)
        });
        made.clone().map_err(Failed::from)
    }
}
