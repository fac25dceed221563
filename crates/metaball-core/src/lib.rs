//! Metaball fields, an exact reference, and the contract of the methods that draw them.
//!
//! Metaball i adds qᵢ·k(|x − pᵢ|²/Rᵢ²) to a field; its kernel k is zero outside the support radius
//! Rᵢ. The surface of a [`Scene`] is where the field equals the threshold T, the solid where it is
//! T or more.
//!
//! # Conventions
//! The world is right-handed; lengths are in the units of the scene's file. A [`Ray`] has a
//! direction that is unit to rounding, and t counts along it. The first hit is the smallest t > 0
//! where the field along the ray rises from below T to T; a ray that starts at T or above is
//! [`Verdict::Inside`] at t = 0. Normals point out of the solid. Images are stored row by row from
//! the top left.
//!
//! # Features
//! Without features this crate knows nothing of GPUs. Feature `gpu` adds the module `gpu`: the
//! adapter, frames with timed passes, hit buffers, shared shading, and the trait `IsoRenderer` that
//! methods implement.

mod aabb;
mod ball;
mod camera;
mod color;
#[cfg(feature = "gpu")]
pub mod gpu;
mod kernel;
mod picture;
mod ray;
pub mod reference;
mod scene;
mod work;

pub use aabb::Aabb;
pub use ball::{Metaball, Support};
pub use camera::{Camera, CameraError, View, ViewError};
pub use color::Color;
pub use kernel::{Exponent, ExponentError, Kernel};
pub use picture::{Image, Picture, Shaded, ValueRange};
pub use ray::{Hit, NO_LIMIT, PackedHit, Ray, Verdict};
pub use scene::{
    Generality, KernelForm, RADIUS_LIMITS, Scene, SceneError, check_ball, check_field,
};
pub use work::{Work, WorkKind};
