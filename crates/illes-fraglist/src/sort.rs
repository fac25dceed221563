//! The order of the balls, once a frame: by rising effective distance |p − e| − R (section 5, sorting).

mod adapter;
mod host;

pub(crate) use adapter::{RadixSort, SortBuffers};
pub(crate) use host::by_effective_distance;
