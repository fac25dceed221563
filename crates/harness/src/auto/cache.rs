//! Choices made earlier: one file for each scene, view, error and adapter, in the user's cache folder.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;

use metaball_core::gpu::Gpu;
use metaball_core::{Scene, View};
use serde::{Deserialize, Serialize};

use super::choice::Choice;
use crate::machine;
use crate::output::write_json;
use crate::record::Adapter;

/// Name and version of the files' format.
const SCHEMA: &str = "metaball-choice/2";

/// A folder of choices, or none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cache(Option<PathBuf>);

/// What a choice depends on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Key {
    /// Hash of balls, kernel, threshold, camera and the names of the candidates. It may change with
    /// the compiler; then scenes are calibrated anew.
    content: String,
    balls: usize,
    width: u32,
    height: u32,
    max_error: String,
    /// The adapter; the CPU where there is none.
    adapter: Adapter,
    /// What draws for candidates that need no adapter.
    cpu: Adapter,
    commit: String,
}

#[derive(Serialize, Deserialize)]
struct File {
    schema: String,
    key: Key,
    choice: Choice,
}

impl Key {
    /// For a scene in a view. Of a view's opaque distances, where it has any, nothing is in the key:
    /// choices are made without them.
    pub fn new<'a>(
        gpu: Option<&Gpu>,
        scene: &Scene,
        view: &View,
        max_error: f64,
        candidates: impl Iterator<Item = &'a str>,
    ) -> Self {
        let mut hasher = DefaultHasher::new();
        for ball in scene.balls() {
            let numbers = [ball.center.x, ball.center.y, ball.center.z, ball.radius, ball.strength];
            numbers.map(f32::to_bits).hash(&mut hasher);
        }
        scene.kernel().hash(&mut hasher);
        scene.threshold().to_bits().hash(&mut hasher);
        scene.colors().is_some().hash(&mut hasher);
        let camera = view.camera();
        for axis in [camera.eye(), camera.right(), camera.up(), camera.forward()] {
            axis.to_array().map(f32::to_bits).hash(&mut hasher);
        }
        camera.half_height().to_bits().hash(&mut hasher);
        candidates.for_each(|name| name.hash(&mut hasher));
        Self {
            content: format!("{:016x}", hasher.finish()),
            balls: scene.len(),
            width: view.width(),
            height: view.height(),
            max_error: format!("{max_error:e}"),
            adapter: Adapter::of(gpu),
            cpu: Adapter::cpu(),
            commit: machine::commit(),
        }
    }

    fn file_name(&self) -> anyhow::Result<String> {
        let mut hasher = DefaultHasher::new();
        serde_json::to_string(self)?.hash(&mut hasher);
        Ok(format!("{:016x}.json", hasher.finish()))
    }
}

impl Cache {
    /// `metaball/auto` in `$XDG_CACHE_HOME`, or in `.cache` of the home folder; none where neither is
    /// set.
    pub fn of_user() -> Self {
        let folder = |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let caches = folder("XDG_CACHE_HOME").or_else(|| Some(folder("HOME")?.join(".cache")));
        Self(caches.map(|caches| caches.join("metaball/auto")))
    }

    /// In a folder, which need not be there.
    pub fn at(folder: PathBuf) -> Self {
        Self(Some(folder))
    }

    /// Knows nothing and keeps nothing.
    pub fn none() -> Self {
        Self(None)
    }

    /// The choice made for that key. A file that cannot be read, or is about something else, is no
    /// choice.
    pub fn find(&self, key: &Key) -> Option<Choice> {
        let path = self.0.as_ref()?.join(key.file_name().ok()?);
        let file: File = serde_json::from_str(&fs::read_to_string(path).ok()?).ok()?;
        (file.schema == SCHEMA && file.key == *key).then_some(file.choice)
    }

    /// Keeps a choice.
    ///
    /// # Errors
    /// When the file cannot be written; names it.
    pub fn keep(&self, key: &Key, choice: &Choice) -> anyhow::Result<()> {
        let Some(folder) = &self.0 else { return Ok(()) };
        let (key, choice) = (key.clone(), choice.clone());
        let path = folder.join(key.file_name()?);
        let file = File { schema: SCHEMA.to_owned(), key, choice };
        write_json(&path, &file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::auto::choice::Errors;

    fn key(content: &str) -> Key {
        Key {
            content: content.to_owned(),
            balls: 2,
            width: 4,
            height: 3,
            max_error: "1e-3".to_owned(),
            adapter: Adapter::none(),
            cpu: Adapter::none(),
            commit: "c".to_owned(),
        }
    }

    #[test]
    fn only_the_same_question_has_an_answer_and_broken_files_have_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::at(folder.path().to_owned());
        let choice = Choice {
            configuration: "fbvh".to_owned(),
            max_error: 0.5,
            errors: Errors { rays: 8, wrong: 0, p99: 0.25 },
            frame_ms: 2.0,
            runner_up: Some(("bvh".to_owned(), 4.0)),
            left_out: Vec::new(),
        };
        assert_eq!(cache.find(&key("one")), None);
        cache.keep(&key("one"), &choice).expect("kept");
        assert_eq!(cache.find(&key("one")).as_ref(), Some(&choice));
        assert_eq!(cache.find(&key("other")), None);
        assert_eq!(cache.find(&Key { commit: "d".to_owned(), ..key("one") }), None);

        // A file under this name that is about something else, and half a file.
        let path = |key: &Key| folder.path().join(key.file_name().expect("a name"));
        fs::copy(path(&key("one")), path(&key("other"))).expect("copied");
        assert_eq!(cache.find(&key("other")), None);
        let text = fs::read_to_string(path(&key("one"))).expect("written");
        fs::write(path(&key("one")), &text[..text.len() / 2]).expect("written");
        assert_eq!(cache.find(&key("one")), None);
        Cache::none().keep(&key("one"), &choice).expect("nothing to do");
        assert_eq!(Cache::none().find(&key("one")), None);
    }
}
