//! Methods on the CPU: the traits that they implement.

use thiserror::Error;

use crate::{Hit, Ray, Scene};

/// A method that finds, for every primary ray, the first point where the field reaches the threshold,
/// on the CPU and without any graphics API: rays in, hits out.
///
/// It neither makes rays nor measures time: whoever draws with it does both, the same for all.
pub trait HostMethod: Send + Sync {
    /// Stable name in file names, tables and tests: lower-case letters, digits, dashes.
    fn name(&self) -> &'static str;

    /// Makes everything that depends on the scene alone.
    ///
    /// # Errors
    /// When the method cannot do the scene.
    fn build<'s>(&self, scene: &'s Scene) -> Result<Box<dyn HostRenderer + 's>, HostError>;
}

/// A method with its scene, ready for rays. Borrows the scene.
pub trait HostRenderer: Send + Sync {
    /// First hits of a picture's rays, in their order, on rayon's current pool. Rays lie row by row from
    /// the top left, `width` to a row, the last of which may be shorter.
    fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit>;

    /// Bytes of main memory held for the scene, the scene itself left out.
    fn bytes(&self) -> u64;
}

/// Why a method on the CPU cannot do a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HostError {
    /// The method cannot draw this scene at all.
    #[error("method {method}: {reason}")]
    Unsupported {
        /// Name of the method.
        method: &'static str,
        /// What it needs, and what the scene has.
        reason: String,
    },
    /// The method's structure could not be built.
    #[error("method {method}: {source}")]
    Structure {
        /// Name of the method.
        method: &'static str,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
