//! Placeholder documentation.

mod ball;
mod build;
mod field;
mod fit;
#[cfg(feature = "gpu")]
pub mod gpu;
mod node;
mod options;
mod plane;
mod stats;
mod trace;
mod tree;
mod validate;

pub use build::BuildError;
pub use field::Field;
pub use node::{EMPTY, LEAF, Leaf, MAX_DEPTH, Node};
pub use options::{Boxes, Cost, Fitting, Kind, Options, Structure};
pub use stats::{Spread, Stats};
pub use trace::{Counter, Reading, TraceOptions, Tracer, Work};
pub use tree::Tree;
pub use validate::Flaw;
