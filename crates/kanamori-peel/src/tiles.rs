//! The grid of tiles that the picture is divided into, and their balls (section 5.3).

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DVec2;
use metaball_core::gpu::{Gpu, RenderError, bind_group};

use crate::balls::Balls;
use crate::layouts::Layouts;
use crate::options::{MOST_TILES, Registration};

/// A tile's balls: WGSL's `Tile` of `shaders/wgsl/kanamori_peel/tiles.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub(crate) struct Tile {
    /// Index of the first among the balls registered.
    pub(crate) first: u32,
    /// Their number.
    pub(crate) balls: u32,
    /// Not 0 where a ray of the tile has no answer before the current layer.
    pub(crate) is_live: u32,
    /// Layers that the tile was given, with the current one.
    pub(crate) layers: u32,
}

/// Bytes of an indirect draw: WGSL's `Draw` of `shaders/wgsl/kanamori_peel/turn.wgsl`.
const DRAW_BYTES: u64 = 16;

/// The most layers that a tile with so many balls takes: each ball has two points on a ray, and the
/// last layer finds none. Without balls there is none.
pub(crate) const fn most_layers(balls: u32) -> u32 {
    if balls == 0 { 0 } else { 2 * balls + 1 }
}

/// Elements of buffers with one a tile.
pub(crate) const ALL_TILES: u64 = MOST_TILES as u64 * MOST_TILES as u64;

/// A tile as peeling draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PeeledTile {
    /// Offset of its indirect draw, bytes.
    pub(crate) draw: u64,
    /// First column, first row, columns and rows, pixels.
    pub(crate) scissor: [u32; 4],
    /// It takes no more layers.
    pub(crate) most_layers: u32,
}

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

    /// The tiles that have pixels, where each of all tiles has at most so many balls.
    pub(crate) fn peeled(&self, most_balls: &[u32]) -> Vec<PeeledTile> {
        let Self { on_side, picture, tile } = *self;
        let columns = picture[0].div_ceil(tile[0]);
        let rows = picture[1].div_ceil(tile[1]);
        let peeled = |row, column| {
            let first = [column * tile[0], row * tile[1]];
            let size = [0, 1].map(|axis| tile[axis].min(picture[axis] - first[axis]));
            let index = row * on_side + column;
            PeeledTile {
                draw: DRAW_BYTES * u64::from(index),
                scissor: [first[0], first[1], size[0], size[1]],
                most_layers: most_layers(most_balls[index as usize]),
            }
        };
        (0..rows).flat_map(|row| (0..columns).map(move |column| peeled(row, column))).collect()
    }

    /// Columns and rows of tiles that a rectangle in clip space meets.
    pub(crate) fn tiles_in(&self, [low, high]: [DVec2; 2]) -> [Range<u32>; 2] {
        let tile_at = |clip: f64, axis: usize| {
            // The picture's edge belongs to the last tile, though its pixel would be the next one.
            let pixel = (0.5 * (1.0 + clip) * f64::from(self.picture[axis])) as u32;
            pixel.min(self.picture[axis] - 1) / self.tile[axis]
        };
        // Rows count from the top.
        [tile_at(low.x, 0)..tile_at(high.x, 0) + 1, tile_at(-high.y, 1)..tile_at(-low.y, 1) + 1]
    }

    /// Indices of the tiles of such columns and rows.
    pub(crate) fn indices(&self, [columns, rows]: &[Range<u32>; 2]) -> impl Iterator<Item = usize> {
        let on_side = self.on_side;
        let columns = columns.clone();
        rows.clone().flat_map(move |row| {
            columns.clone().map(move |column| (row * on_side + column) as usize)
        })
    }
}

/// The tiles on the adapter, with a capacity of registrations; and the groups 2 that bind them.
pub(crate) struct TileBuffers {
    pub(crate) registering: wgpu::BindGroup,
    pub(crate) turning: wgpu::BindGroup,
    pub(crate) drawing: wgpu::BindGroup,
    /// What indirect draws read.
    pub(crate) draws: wgpu::Buffer,
    /// Registrations that the buffers hold.
    pub(crate) capacity: u32,
    tiles: wgpu::Buffer,
    registered: wgpu::Buffer,
    bytes: u64,
}

impl TileBuffers {
    pub(crate) fn new(
        gpu: &Gpu,
        balls: &Balls,
        layouts: &Layouts,
        registration: Registration,
        capacity: u32,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let tiles = gpu.storage("tiles", ALL_TILES * size_of::<Tile>() as u64, none)?;
        let registered = gpu.storage("balls of tiles", 4 * u64::from(capacity), none)?;
        let rows = match registration {
            Registration::Host => 1,
            Registration::Adapter => balls.workgroups().max(1),
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
            capacity,
            tiles,
            registered,
        })
    }

    /// Bytes on the adapter.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Sends what the host registered, no more than the capacity.
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

    /// The tiles on the adapter, an element each.
    pub(crate) fn tiles(&self) -> &wgpu::Buffer {
        &self.tiles
    }
}
