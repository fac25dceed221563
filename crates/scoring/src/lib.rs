//! How far hits are from the truth: the one set of definitions for all methods and for everyone else's hits.
//!
//! ```
//! use metaball_core::reference::Oracle;
//! use metaball_core::{Hit, Kernel, Metaball, Ray, Scene, glam::Vec3};
//!
//! let scene = Scene::new([Metaball::new(Vec3::ZERO, 2.0)], Kernel::QUARTIC, 0.25)?;
//! let truth = Oracle::new(&scene).first_hit(&Ray::new(Vec3::new(0.0, 0.0, -5.0), Vec3::Z));
//! let accuracy = scoring::score([(&truth, &Hit::MISS)].into_iter(), "one ray");
//! assert_eq!((accuracy.rays, accuracy.false_negative), (1, 1));
//! # Ok::<(), metaball_core::SceneError>(())
//! ```

pub mod fronts;
mod score;
pub mod stats;

pub use score::{
    Accuracy, Finding, Judgement, NormalDegrees, RadiusError, is_hit, many_are_ambiguous, score,
};
