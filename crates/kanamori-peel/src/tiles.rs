//! The grid of tiles that the picture is divided into, and their balls (section 5.3).

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, Vec3};
use metaball_core::gpu::{Gpu, RenderError, bind_group};
use metaball_core::{Scene, View};

use crate::Registration;
use crate::balls::Balls;
use crate::options::MOST_TILES;
use crate::pipelines::Layouts;

/// A tile's balls: WGSL's `Tile` of `tiles.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub(crate) struct Tile {
    /// Place of the first among those registered.
    pub(crate) first: u32,
    /// Their number.
    pub(crate) balls: u32,
    /// Not 0 where a ray of the tile has no answer before the layer at hand.
    pub(crate) is_live: u32,
}

/// Bytes of an indirect draw: WGSL's `Draw` of `turn.wgsl`.
const DRAW_BYTES: u64 = 16;

/// Elements of the buffers with one a tile.
const ALL_TILES: u64 = MOST_TILES as u64 * MOST_TILES as u64;

/// The tiles of a picture, row by row from the top left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    /// Tiles on a side.
    on_side: u32,
    /// Pixels across and down.
    picture: [u32; 2],
    /// Pixels of a tile across and down; the last ones may have fewer, or none.
    tile: [u32; 2],
}

impl Grid {
    pub(crate) fn new(on_side: u32, picture: [u32; 2]) -> Self {
        Self { on_side, picture, tile: picture.map(|side| side.div_ceil(on_side)) }
    }

    /// The tiles that have pixels: the place of each among indirect draws in bytes; then its first
    /// column, first row, columns and rows.
    pub(crate) fn scissors(&self) -> impl Iterator<Item = (u64, [u32; 4])> {
        let Self { on_side, picture, tile } = *self;
        let columns = picture[0].div_ceil(tile[0]);
        let rows = picture[1].div_ceil(tile[1]);
        (0..rows).flat_map(move |row| {
            (0..columns).map(move |column| {
                let first = [column * tile[0], row * tile[1]];
                let size = [0, 1].map(|axis| tile[axis].min(picture[axis] - first[axis]));
                let draw = DRAW_BYTES * u64::from(row * on_side + column);
                (draw, [first[0], first[1], size[0], size[1]])
            })
        })
    }

    /// Columns and rows of tiles that a rectangle in clip space meets.
    fn tiles_in(&self, [low, high]: [DVec2; 2]) -> [std::ops::Range<u32>; 2] {
        let place = |clip: f64, axis: usize| {
            // The picture's edge belongs to the last tile, though its pixel would be the next one.
            let pixel = (0.5 * (1.0 + clip) * f64::from(self.picture[axis])) as u32;
            pixel.min(self.picture[axis] - 1) / self.tile[axis]
        };
        // Rows count from the top.
        [place(low.x, 0)..place(high.x, 0) + 1, place(-high.y, 1)..place(-low.y, 1) + 1]
    }
}

/// Sorts the balls that are in the picture into tiles, by rising index in each.
pub(crate) fn register(
    supports: &[(Vec3, f32)],
    view: &View,
    grid: &Grid,
) -> (Vec<Tile>, Vec<u32>) {
    let mut tiles = vec![Tile::default(); ALL_TILES as usize];
    let placed: Vec<_> = (0u32..)
        .zip(supports)
        .filter_map(|(ball, &(center, radius))| {
            Some((ball, grid.tiles_in(cover(view, center, radius)?)))
        })
        .collect();
    let on_side = grid.on_side;
    let tiles_of = |[columns, rows]: &[std::ops::Range<u32>; 2]| {
        let columns = columns.clone();
        rows.clone().flat_map(move |row| {
            columns.clone().map(move |column| (row * on_side + column) as usize)
        })
    };
    for (_, range) in &placed {
        tiles_of(range).for_each(|tile| tiles[tile].balls += 1);
    }
    let mut total = 0;
    for tile in &mut tiles {
        tile.first = total;
        total += tile.balls;
        tile.balls = 0;
    }
    let mut registered = vec![0; total as usize];
    for (ball, range) in &placed {
        for tile in tiles_of(range) {
            let tile = &mut tiles[tile];
            registered[(tile.first + tile.balls) as usize] = *ball;
            tile.balls += 1;
        }
    }
    (tiles, registered)
}

/// Corners in clip space of a rectangle that covers a sphere; `None` where no primary ray can meet
/// it. Twin of `cover_sphere` in `core/cover.wgsl`, with its margin of a twentieth of a pixel for the
/// rounding of the passes that draw.
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

/// The slopes between which a circle can be seen from the origin along the second axis; `None`
/// where it is behind. Those beyond `half` may be anything beyond.
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
    // A circle beside the origin has one tangent that points backwards and bounds nothing ahead.
    let is_ahead = center.y > radius;
    let low = if is_ahead || center.x > 0.0 { slope(-radius) } else { -outside };
    let high = if is_ahead || center.x < 0.0 { slope(radius) } else { outside };
    Some([low, high])
}

/// Centres and radii of the supports, for the host's registration.
pub(crate) fn supports(scene: &Scene) -> Vec<(Vec3, f32)> {
    scene.balls().map(|ball| (ball.center, ball.radius)).collect()
}

/// The tiles on the device, with room for so many registrations; and the groups 2 that bind them.
pub(crate) struct TileRoom {
    pub(crate) registering: wgpu::BindGroup,
    pub(crate) turning: wgpu::BindGroup,
    pub(crate) drawing: wgpu::BindGroup,
    /// What indirect draws read.
    pub(crate) draws: wgpu::Buffer,
    pub(crate) room: u32,
    tiles: wgpu::Buffer,
    registered: wgpu::Buffer,
    rays_left: wgpu::Buffer,
    bytes: u64,
}

impl TileRoom {
    pub(crate) fn new(
        gpu: &Gpu,
        balls: &Balls,
        layouts: &Layouts,
        registration: Registration,
        room: u32,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let tiles = gpu.storage("tiles", ALL_TILES * size_of::<Tile>() as u64, none)?;
        let registered = gpu.storage("balls of tiles", 4 * u64::from(room), none)?;
        let rows = match registration {
            Registration::Host => 1,
            Registration::Device => balls.workgroups().max(1),
        };
        let tallies = gpu.storage("tallies of tiles", 4 * ALL_TILES * u64::from(rows), none)?;
        let rays_left = gpu.storage("rays left", 4 * ALL_TILES, none)?;
        let draws = gpu.storage("draws", DRAW_BYTES * ALL_TILES, wgpu::BufferUsages::INDIRECT)?;
        let all = [&tiles, &registered, &tallies, &rays_left, &draws];
        let bytes = all.iter().map(|buffer| buffer.size()).sum();
        gpu.checked(|| Self {
            bytes,
            registering: bind_group(
                gpu,
                "kanamori registering",
                &layouts.registering,
                &[(0, &balls.placed), (1, &tiles), (2, &registered), (3, &tallies)],
            ),
            turning: bind_group(
                gpu,
                "kanamori turning",
                &layouts.turning,
                &[(0, &tiles), (1, &rays_left), (2, &draws)],
            ),
            drawing: bind_group(
                gpu,
                "kanamori drawing",
                &layouts.drawing,
                &[
                    (0, &balls.peeling),
                    (1, &balls.placed),
                    (2, &balls.arranged),
                    (3, &balls.kernel_radii),
                    (4, &balls.seen),
                    (5, &tiles),
                    (6, &registered),
                    (7, &rays_left),
                ],
            ),
            draws,
            room,
            tiles,
            registered,
            rays_left,
        })
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Sends what the host registered, which there must be room for.
    pub(crate) fn fill(
        &self,
        gpu: &Gpu,
        tiles: &[Tile],
        registered: &[u32],
    ) -> Result<(), RenderError> {
        gpu.checked(|| {
            gpu.queue.write_buffer(&self.tiles, 0, bytemuck::cast_slice(tiles));
            gpu.queue.write_buffer(&self.registered, 0, bytemuck::cast_slice(registered));
        })
    }

    /// Forgets which rays the last frame left.
    pub(crate) fn begin(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.rays_left, 0, None);
    }

    /// Registrations of the last frame: a ball counts in each of its tiles.
    pub(crate) fn registrations(&self, gpu: &Gpu) -> Result<u32, RenderError> {
        Ok(gpu.read::<Tile>(&self.tiles)?.iter().map(|tile| tile.balls).sum())
    }
}
