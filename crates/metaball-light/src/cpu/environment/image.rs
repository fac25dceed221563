//! The environment as an equirectangular image: columns go around the second axis, from −z over +x; rows
//! from the zenith to the nadir.

use std::f32::consts::TAU;

use glam::Vec3;

use crate::Panorama;

pub(super) fn light(panorama: &Panorama, direction: Vec3) -> Vec3 {
    let (columns, rows) = panorama.size();
    let around = libm::atan2f(direction.x, -direction.z) / TAU + 0.5;
    let down = libm::acosf(direction.y.clamp(-1.0, 1.0)) / (0.5 * TAU);
    let x = around * columns as f32 - 0.5;
    let y = (down * rows as f32 - 0.5).clamp(0.0, rows as f32 - 1.0);
    let (left, top) = (x.floor(), y.floor());
    let texel = |right: i64, below: u32| {
        let column = (left as i64 + right).rem_euclid(i64::from(columns)) as u32;
        let row = (top as u32 + below).min(rows - 1);
        panorama.light()[(row * columns + column) as usize].truncate()
    };
    let upper = texel(0, 0).lerp(texel(1, 0), x - left);
    let lower = texel(0, 1).lerp(texel(1, 1), x - left);
    upper.lerp(lower, y - top)
}

/// Six directions stand for all.
pub(super) fn ambient(panorama: &Panorama, normal: Vec3) -> Vec3 {
    let mut sum = Vec3::ZERO;
    let mut weights = 0.0;
    for axis in Vec3::AXES {
        for direction in [-axis, axis] {
            let weight = 0.2 + direction.dot(normal).max(0.0);
            sum += weight * light(panorama, direction);
            weights += weight;
        }
    }
    sum / weights
}
