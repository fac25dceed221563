//! A scene with what was measured on it.

use serde::{Deserialize, Serialize};

/// What was measured on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneResult<M> {
    /// What was loaded.
    pub scene: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// What was measured, or why nothing was.
    pub result: Result<M, String>,
}

impl<M> SceneResult<M> {
    /// Of a scene by its name; an error with all its causes is the reason.
    pub(super) fn new(scene: &str, size: (u32, u32), result: anyhow::Result<M>) -> Self {
        let result = result.map_err(|error| format!("{error:#}"));
        Self { scene: scene.to_owned(), size, result }
    }
}
