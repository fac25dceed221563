//! Metaball scenes and their exact first hits, and what methods that draw them on a GPU share.
//!
//! Metaball i has a centre pᵢ, a support radius Rᵢ and a strength qᵢ > 0. It adds qᵢ·k(|x − pᵢ|²/Rᵢ²) to
//! a field F at x. The [`Kernel`] k falls from 1 at the centre to 0 at distance Rᵢ and stays 0 outside. The
//! solid of a [`Scene`] is where F ≥ T, its threshold; the surface is where F = T.
//!
//! ```
//! use metaball_core::glam::Vec3;
//! use metaball_core::reference::Oracle;
//! use metaball_core::{Camera, Kernel, Metaball, Scene, View};
//!
//! let balls = [Metaball::new(Vec3::ZERO, 1.0), Metaball::new(Vec3::X, 0.8)];
//! let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
//!
//! let camera = Camera::framing(&scene.bounds(), Vec3::Z);
//! let view = View::new(camera, 64, 48)?;
//! let truths = Oracle::new(&scene).first_hits(&view.rays());
//! let hits = truths.iter().filter(|truth| truth.t.is_finite()).count();
//! println!("{hits} of {} rays hit", truths.len());
//! # assert_eq!(hits, 320);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Conventions
//! - *Space*: the world is right-handed. Lengths are scene units, whatever the scene's author measured in;
//!   strengths, the field and T have no unit.
//! - *Rays*: the points `origin + t * direction` with `t_min` ≤ t ≤ `t_max`. Directions are unit to rounding
//!   and never normalised again, so that t means the same, in scene units, to every method and to the
//!   reference ([`Ray`]).
//! - *Verdicts*: a ray is a [`Hit`](Verdict::Hit) at the smallest t where F rises from below T to T, a
//!   [`Miss`](Verdict::Miss) where F stays below T, and [`Inside`](Verdict::Inside) at t = `t_min` where it
//!   starts with F ≥ T. A method whose arithmetic cannot decide says [`Undecided`](Verdict::Undecided).
//! - *Normals* are unit vectors out of the solid, against the gradient of F.
//! - *Images* are stored row by row from the top left. Colours are sRGB-encoded where they are stored and
//!   linear where they are blended or lit.
//! - *Precision*: scenes and rays are stored in f32. [`mod@reference`] takes these numbers as exact and answers
//!   in f64; a method that computes in f32 is compared with it.
//!
//! # Contents
//! - [`Scene`] of [`Metaball`]s, a [`Kernel`] and a threshold; [`Aabb`], [`Color`].
//! - [`Camera`] and [`View`], which make primary [`Ray`]s; [`Hit`], what is found along one.
//! - [`Clip`], a region that a solid is cut to.
//! - [`mod@reference`]: exact first hits on the CPU, for comparison.
//! - [`HostMethod`]: what finds primary hits on the CPU, to be compared; [`HostTracer`]: what follows rays
//!   from anywhere there, for light.
//! - [`Picture`], [`Image`]: what pictures show, and their pixels; [`mod@shade`] makes them on the CPU;
//!   [`Work`]: what a pixel cost.
//! - With feature `gpu`, module `gpu`: adapter, frames with timed passes, buffers of hits, shading, and the
//!   trait `IsoRenderer` that methods implement. Without it the crate depends on no graphics API.

mod aabb;
mod ball;
mod camera;
mod clip;
mod color;
#[cfg(feature = "gpu")]
pub mod gpu;
mod host_method;
mod host_tracer;
pub mod kernel;
mod picture;
mod ray;
pub mod reference;
mod scene;
pub mod shade;
mod surface_color;
mod work;

pub use aabb::Aabb;
pub use ball::{Metaball, Support};
pub use camera::{Camera, CameraError, PixelDirections, View, ViewError};
pub use clip::{Clip, ClipError, Section};
pub use color::Color;
pub use host_method::{HostError, HostMethod, HostRenderer};
pub use host_tracer::{HostTracer, RayQuery, SurfaceHit};
pub use kernel::{Cut, CutError, Exponent, ExponentError, Kernel, KernelNameError};
pub use picture::{Image, Picture, Shaded, ValueRange};
pub use ray::{Hit, NO_LIMIT, PackedHit, Ray, Verdict};
pub use scene::{
    Generality, KernelForm, NegativeBall, RADIUS_LIMITS, Scene, SceneError, check_ball, check_field,
};
pub use surface_color::SurfaceColors;
pub use work::{Work, WorkKind};

/// The version of glam that this crate is built on.
pub use glam;
