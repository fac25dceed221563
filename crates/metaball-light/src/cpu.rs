//! The path tracer on the CPU: no graphics API.
//!
//! Each effect is a file of its own, but for `opacity` the twin of the one of that name in
//! `shaders/wgsl/light`: line by line the same formulas, in f32 without fused operations and with the
//! functions of libm, so that a picture is the same on every machine.

mod environment;
mod floor;
mod fluid;
mod follow;
mod lamps;
mod lighting;
mod mirror;
mod occlusion;
mod opacity;
mod path_tracer;
mod phong;
mod power;
pub(crate) mod sampling;
mod scatter;
mod secondary;
mod start;
mod surface;
mod wave;

pub use self::follow::Rays;
pub use self::path_tracer::{PathTracer, Rows};
