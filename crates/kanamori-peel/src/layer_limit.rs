//! How many layers a frame is recorded with: a few more than the last one took.

use metaball_core::gpu::{Gpu, RenderError};

use crate::balls::MOST_BALLS;
use crate::tiles::{Tile, TileBuffers, most_layers};

/// Layers that a renderer's first frame has.
const FIRST_LAYERS: u32 = 64;

/// The most layers, of a tile with the most balls.
const MOST_LAYERS: u32 = most_layers(MOST_BALLS as u32);

/// Layers of the next frame. It follows the scene up and down: what a frame took is read when the next
/// one is recorded, at no wait, since the adapter is done with it.
pub(crate) struct LayerLimit {
    layers: u32,
    /// The tiles as the last frame left them.
    tiles: Option<wgpu::Buffer>,
    /// Whether they are still to be read.
    is_due: bool,
}

impl LayerLimit {
    pub(crate) fn new() -> Self {
        Self { layers: FIRST_LAYERS, tiles: None, is_due: false }
    }

    /// Layers of the last frame, wherever its tiles could take so many.
    #[cfg(test)]
    pub(crate) fn layers(&self) -> u32 {
        self.layers
    }

    /// Layers of a frame in which no tile can take more than `most`.
    pub(crate) fn next(&mut self, gpu: &Gpu, most: u32) -> Result<u32, RenderError> {
        if let Some(tiles) = self.tiles.as_ref().filter(|_| self.is_due) {
            let taken = gpu.read_mapped(tiles, |bytes| {
                let tiles: Vec<Tile> = bytemuck::pod_collect_to_vec(bytes);
                tiles.iter().map(|tile| tile.layers).max()
            })?;
            self.is_due = false;
            self.layers = with_reserve(taken.unwrap_or_default());
        }
        Ok(self.layers.min(most))
    }

    /// Notes at the end of a frame what it took.
    pub(crate) fn note(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        tiles: &TileBuffers,
    ) -> Result<(), RenderError> {
        let noted = match self.tiles.take() {
            Some(noted) => noted,
            None => gpu.checked(|| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("tiles of the last frame"),
                    size: tiles.tiles().size(),
                    usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                    mapped_at_creation: false,
                })
            })?,
        };
        encoder.copy_buffer_to_buffer(tiles.tiles(), 0, &noted, 0, noted.size());
        self.tiles = Some(noted);
        self.is_due = true;
        Ok(())
    }

    /// Keeps the limit for the next frame, whatever the last one took.
    pub(crate) fn keep(&mut self) {
        self.is_due = false;
    }

    /// Doubles it for the next frame, to no less than a first one has. False where it is the greatest
    /// already.
    pub(crate) fn grow(&mut self) -> bool {
        self.keep();
        let can_grow = self.layers < MOST_LAYERS;
        self.layers = self.layers.saturating_mul(2).clamp(FIRST_LAYERS, MOST_LAYERS);
        can_grow
    }
}

/// A quarter more than a frame took, so that one a little deeper is not drawn twice.
fn with_reserve(taken: u32) -> u32 {
    taken.saturating_add(taken.div_ceil(4)).min(MOST_LAYERS)
}
