//! Registration of balls with tiles on the host, as published (section 5.3).
//!
//! `shaders/wgsl/kanamori_peel/register.wgsl` does the same on the adapter. Neither uses the tile bins of
//! `metaball_core::gpu`: a tile's balls must be in rising order of index, as of coincident points the
//! depth test keeps the one drawn first, and the grid is the paper's, of a few tiles on a side.

use glam::{DVec2, Vec3};
use metaball_core::View;

use crate::tiles::{ALL_TILES, Grid, Tile};

/// Sorts the balls that are in the picture into tiles, by rising index in each.
pub(crate) fn register(
    supports: &[(Vec3, f32)],
    view: &View,
    grid: &Grid,
) -> (Vec<Tile>, Vec<u32>) {
    let mut tiles = vec![Tile::default(); ALL_TILES as usize];
    let ranges: Vec<_> = (0u32..)
        .zip(supports)
        .filter_map(|(ball, &(center, radius))| {
            Some((ball, grid.tiles_in(cover(view, center, radius)?)))
        })
        .collect();
    for (_, range) in &ranges {
        grid.indices(range).for_each(|tile| tiles[tile].balls += 1);
    }
    let mut total = 0;
    for tile in &mut tiles {
        tile.first = total;
        total += tile.balls;
        tile.balls = 0;
    }
    let mut registered = vec![0; total as usize];
    for (ball, range) in &ranges {
        for tile in grid.indices(range) {
            let tile = &mut tiles[tile];
            registered[(tile.first + tile.balls) as usize] = *ball;
            tile.balls += 1;
        }
    }
    (tiles, registered)
}

/// Corners in clip space of a rectangle that covers a sphere; `None` where no primary ray can meet
/// it. Twin of `cover_sphere` in `shaders/wgsl/core/cover.wgsl`, with its margin of a twentieth of a
/// pixel for the rounding of the passes that draw.
fn cover(view: &View, center: Vec3, radius: f32) -> Option<[DVec2; 2]> {
    let camera = view.camera();
    let to_center = center.as_dvec3() - camera.eye().as_dvec3();
    let ahead = to_center.dot(camera.forward().as_dvec3());
    let half_height = f64::from(camera.half_height());
    let pixel = 2.0 * half_height / f64::from(view.height());
    let half_width = 0.5 * pixel * f64::from(view.width());
    let widened = 1.00001 * f64::from(radius) + 4e-6 * to_center.length();
    let range = |aside: Vec3, half: f64| {
        let [low, high] =
            tangents(DVec2::new(to_center.dot(aside.as_dvec3()), ahead), widened, half)?;
        let inside = |slope: f64| slope.clamp(-half, half) / half;
        let ends = [inside(low - 0.05 * pixel), inside(high + 0.05 * pixel)];
        (ends[0] < ends[1]).then_some(ends)
    };
    let across = range(camera.right(), half_width)?;
    let upwards = range(camera.up(), half_height)?;
    Some([DVec2::new(across[0], upwards[0]), DVec2::new(across[1], upwards[1])])
}

/// The slopes of the lines from the origin that bound a circle, of all lines that run forward along the
/// second axis; `None` where the circle is behind. Slopes beyond `half` are not exact.
fn tangents(center: DVec2, radius: f64, half: f64) -> Option<[f64; 2]> {
    let outside = 2.0 * half;
    let distance = center.length();
    if distance <= radius {
        return Some([-outside, outside]);
    }
    if center.y <= -radius {
        return None;
    }
    let along = ((distance - radius) * (distance + radius)).sqrt();
    let slope = |turn: f64| {
        let aside = center.x * along + center.y * turn;
        let ahead = center.y * along - center.x * turn;
        if aside.abs() >= outside * ahead { outside.copysign(aside) } else { aside / ahead }
    };
    // Of a circle across the first axis one tangent runs backwards and bounds nothing ahead.
    let is_ahead = center.y > radius;
    let low = if is_ahead || center.x > 0.0 { slope(-radius) } else { -outside };
    let high = if is_ahead || center.x < 0.0 { slope(radius) } else { outside };
    Some([low, high])
}
