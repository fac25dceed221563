//! What a picture is of.

use std::hash::{DefaultHasher, Hash, Hasher};

use metaball_core::{Color, Scene, View};
use serde::{Deserialize, Serialize};

use crate::DrawOptions;
use crate::band::Planes;

/// All that a picture on the CPU depends on but the user's image of the surroundings, as names and
/// texts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Description(Vec<(String, String)>);

impl Description {
    /// Of a view's picture.
    pub(crate) fn new(scene: &Scene, view: &View, options: &DrawOptions, planes: Planes) -> Self {
        let DrawOptions { method, picture, clip, light, .. } = options;
        let facts = [
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("size", format!("{} × {}", view.width(), view.height())),
            ("scene", scene_text(scene)),
            ("camera", format!("{:?}", view.camera())),
            ("method", format!("{} {:?}", method.name(), method.tree())),
            ("picture", format!("{picture:?}")),
            ("clip", format!("{clip:?}")),
            ("light", format!("{light:?}")),
            ("planes", format!("{planes:?}")),
        ];
        Self(facts.map(|(name, text)| (name.to_owned(), text)).into())
    }

    /// The first fact that another description has otherwise: its name, what it is here, and there.
    pub(crate) fn difference(&self, other: &Self) -> Option<[String; 3]> {
        let pairs = self.0.iter().zip(&other.0);
        let different = pairs.into_iter().find(|(here, there)| here != there);
        let ((name, here), (_, there)) = different?;
        Some([name.clone(), here.clone(), there.clone()])
    }

    pub(super) fn to_json(&self) -> Vec<u8> {
        // Strings in lists are all valid JSON.
        serde_json::to_vec(self).unwrap_or_default()
    }

    /// `None` where it is none.
    pub(super) fn from_json(text: &[u8]) -> Option<Self> {
        serde_json::from_slice(text).ok()
    }
}

/// A scene by its numbers. The hash may change with the compiler that built this.
fn scene_text(scene: &Scene) -> String {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytemuck::cast_slice(scene.supports()));
    scene.strengths().map(bytemuck::cast_slice::<f32, u8>).hash(&mut hasher);
    scene.colors().map(bytemuck::cast_slice::<Color, u8>).hash(&mut hasher);
    format!(
        "{} balls {:016x}, kernel {}, threshold {}",
        scene.len(),
        hasher.finish(),
        scene.kernel(),
        scene.threshold()
    )
}
