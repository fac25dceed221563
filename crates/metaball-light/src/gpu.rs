//! The path tracer on wgpu.

mod buffers;
mod passes;
mod path_tracer;
mod waves;

pub use self::path_tracer::PathTracer;
