//! What is looked at, and who opens it.

use std::error::Error;
use std::fmt;
use std::path::PathBuf;

use metaball::{AnimatedScene, BoxError, Camera, Legend, Notes, ReadOptions, Scene};

/// A scene, or one for each frame, with what its loader says of it.
pub struct Subject {
    /// What a user types to have it: a file, or a name that the [`Opener`] knows.
    pub spec: String,
    /// Its name, for people.
    pub name: String,
    /// The camera of its own.
    pub camera: Camera,
    /// What was read of its file, guessed, left out and changed; none where it is of no file.
    pub notes: Option<Notes>,
    /// What the colours of its balls say, if anything.
    pub legend: Option<Legend>,
    /// The files that it is read from: nothing is written over them.
    pub inputs: Vec<PathBuf>,
    /// How it was read.
    pub reading: ReadOptions,
    /// The balls.
    pub content: Content,
}

/// The balls of a [`Subject`].
pub enum Content {
    /// The same at all times.
    Still(Scene),
    /// A scene for each frame.
    Moving(Box<dyn AnimatedScene + Send>),
}

/// Opens what a user names. It may take long: it is asked on a thread of its own.
pub trait Opener: Send + Sync {
    /// The subject of that name.
    ///
    /// # Errors
    /// When there is none, or it cannot be read so.
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError>;
}

impl Subject {
    /// The scene of a frame; a still one has the same for all.
    ///
    /// # Errors
    /// When there is no such frame.
    pub fn frame(&self, number: u32) -> Result<Scene, BoxError> {
        match &self.content {
            Content::Still(scene) => Ok(scene.clone()),
            Content::Moving(moving) => moving.frame(number),
        }
    }

    /// Whether it is read from a file, so that it can be read otherwise.
    pub fn is_of_file(&self) -> bool {
        !self.inputs.is_empty()
    }
}

impl fmt::Debug for Subject {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Subject").field("spec", &self.spec).finish_non_exhaustive()
    }
}

/// An error with what caused it, in a line.
pub(crate) fn told(error: &(dyn Error + 'static)) -> String {
    let mut words = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        words += &format!(": {error}");
        cause = error.source();
    }
    words
}
