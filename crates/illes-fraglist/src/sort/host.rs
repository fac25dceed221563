//! The order of the balls, once a frame.

use metaball_core::{Camera, Support};
use rayon::prelude::*;

/// Indices of the balls by rising effective distance |p − e| − R, equal ones by index (section 5,
/// sorting; in parallel on the host, as published).
pub(crate) fn by_effective_distance(supports: &[Support], camera: &Camera) -> Vec<u32> {
    let eye = camera.eye();
    let mut keys: Vec<u64> = supports
        .par_iter()
        .enumerate()
        .map(|(index, support)| {
            let distance = support.center.distance(eye) - support.radius;
            u64::from(ordered(distance)) << 32 | index as u64
        })
        .collect();
    keys.par_sort_unstable();
    keys.into_par_iter().map(|key| key as u32).collect()
}

/// A number whose order as an integer is the float's.
fn ordered(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}
