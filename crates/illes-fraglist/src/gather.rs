//! The passes before the cast: the nearest core along each ray, then the list of the balls before it.

mod raster;
mod tiles;

use metaball_core::gpu::{Frame, Gpu, RenderError, Specialization};

use self::raster::RasterGather;
use self::tiles::TileGather;
use crate::balls::Balls;
use crate::canvas::Canvas;
use crate::layouts::Layouts;
use crate::options::Gather;

/// The passes of either way.
pub(crate) enum GatherPasses {
    Raster(RasterGather),
    Tiles(TileGather),
}

impl GatherPasses {
    pub(crate) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
        gather: Gather,
    ) -> Result<Self, RenderError> {
        Ok(match gather {
            Gather::Raster => Self::Raster(RasterGather::new(gpu, spec, layouts)?),
            Gather::Tiles => Self::Tiles(TileGather::new(gpu, spec, layouts)?),
        })
    }

    /// Records the passes, for a canvas without lists.
    pub(crate) fn record(&self, frame: &mut Frame<'_>, balls: &Balls, canvas: &Canvas) {
        match (self, &canvas.tiles) {
            (Self::Raster(passes), _) => passes.record(frame, balls, canvas),
            (Self::Tiles(passes), Some(tiles)) => passes.record(frame, balls, tiles),
            (Self::Tiles(_), None) => unreachable!("a canvas for tiles has tiles"),
        }
    }
}
