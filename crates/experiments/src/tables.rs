//! Tables that papers print, measured anew and set beside the printed numbers; one of programs that a
//! user would take instead, one of what `auto` chooses, and one of what it saves that shaders are made
//! for a scene.

pub mod auto;
pub mod gourmel;
pub mod heading;
pub mod illes;
pub mod kanamori;
pub mod peers;
mod report;
pub mod scene_result;
pub mod specialisation;

use std::path::PathBuf;
use std::time::Duration;

use metaball_core::gpu::AdapterChoice;

use crate::extent::Extent;

/// What to measure, and where the numbers go.
#[derive(Debug, Clone)]
pub struct Options {
    /// How much.
    pub extent: Extent,
    /// Pixels across and down; the tables' own where left open.
    pub size: Option<(u32, u32)>,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Folder for the page and the numbers.
    pub out: PathBuf,
}

/// The scenes named by the user, or the tables' own where there are none.
fn named_or(scenes: &[String], own: &[&str]) -> Vec<String> {
    if scenes.is_empty() {
        own.iter().map(|&spec| spec.to_owned()).collect()
    } else {
        scenes.to_vec()
    }
}

/// What tables take that measure as much as fits.
pub const TEN_MINUTES: Duration = Duration::from_secs(600);
