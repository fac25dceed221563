//! Lists of the balls over each tile of a picture, made in compute: count, prefix sum, fill.
//!
//! A ball is in the list of every tile that its rectangle on the picture meets, in no order. What an
//! entry says of its ball is the method's own; so are the groups that bind the two buffers.

use super::{Gpu, RenderError, Shader, Specialization, workgroup_grid};

/// Tiles of a picture at most: `MOST_TILES` of `shaders/wgsl/core/tiles.wgsl`. A ball that fills the
/// picture takes so many iterations of an invocation.
const MOST_TILES: u32 = 16_384;

/// Pixels on a tile's side, where the picture has not too many of them.
const SMALLEST_SIDE: u32 = 16;

/// Balls of a workgroup that counts or fills: `@workgroup_size(64)`.
const BALLS_OF_GROUP: u32 = 64;

/// The pipelines that sort balls into tiles.
#[derive(Debug)]
pub struct TileBinning {
    count: wgpu::ComputePipeline,
    scan: wgpu::ComputePipeline,
    fill: wgpu::ComputePipeline,
}

/// The lists of one picture size, with a capacity of entries that all tiles share.
#[derive(Debug)]
pub struct TileBins {
    marks: wgpu::Buffer,
    entries: wgpu::Buffer,
}

impl TileBinning {
    /// Pipelines of the entry points `count_entries`, `scan_tiles` and `fill_entries` of a shader.
    ///
    /// # Errors
    /// When wgpu refuses one.
    pub fn new(
        gpu: &Gpu,
        label: &str,
        shader: &Shader,
        spec: &Specialization,
        layouts: &[&wgpu::BindGroupLayout],
    ) -> Result<Self, RenderError> {
        let step = |entry| shader.compute(gpu, label, entry, spec, layouts, &[]);
        Ok(Self {
            count: step("count_entries")?,
            scan: step("scan_tiles")?,
            fill: step("fill_entries")?,
        })
    }

    /// Records the three steps for so many balls. The pass has its groups bound.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, balls: u32) {
        let (columns, rows) = workgroup_grid(balls.div_ceil(BALLS_OF_GROUP));
        pass.set_pipeline(&self.count);
        pass.dispatch_workgroups(columns, rows, 1);
        pass.set_pipeline(&self.scan);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(&self.fill);
        pass.dispatch_workgroups(columns, rows, 1);
    }
}

impl TileBins {
    /// Buffers for so many entries of all tiles together, of `entry_bytes` each.
    ///
    /// # Errors
    /// When the adapter cannot bind them.
    pub fn new(gpu: &Gpu, capacity: u32, entry_bytes: usize) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        Ok(Self {
            marks: gpu.storage("tile marks", 4 * u64::from(MOST_TILES), none)?,
            entries: gpu.storage("tile entries", u64::from(capacity) * entry_bytes as u64, none)?,
        })
    }

    /// One `u32` a tile. The number of its entries; after the prefix sum, where they begin; after they
    /// are filled in, where they end, which is where the next tile's begin.
    pub fn marks(&self) -> &wgpu::Buffer {
        &self.marks
    }

    /// The entries, tile by tile.
    pub fn entries(&self) -> &wgpu::Buffer {
        &self.entries
    }

    /// Empties all lists, as the first step expects them.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.marks, 0, None);
    }

    /// Bytes on the adapter.
    pub fn bytes(&self) -> u64 {
        self.marks.size() + self.entries.size()
    }

    /// Tiles of a picture of so many pixels across and down, as `shaders/wgsl/core/tiles.wgsl` has them: with
    /// sides of 16 pixels, doubled until there are not too many.
    pub fn tiles_of((width, height): (u32, u32)) -> u32 {
        let tiles = |side: u32| width.div_ceil(side).saturating_mul(height.div_ceil(side));
        let mut side = SMALLEST_SIDE;
        while tiles(side) > MOST_TILES {
            side *= 2;
        }
        tiles(side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_have_larger_tiles_and_never_too_many() {
        assert_eq!(TileBins::tiles_of((1, 1)), 1);
        assert_eq!(TileBins::tiles_of((640, 480)), 40 * 30);
        assert_eq!(TileBins::tiles_of((2048, 2048)), MOST_TILES);
        assert_eq!(TileBins::tiles_of((2049, 2048)), 65 * 64);
        assert_eq!(TileBins::tiles_of((65_535, 65_535)), 128 * 128);
    }
}
