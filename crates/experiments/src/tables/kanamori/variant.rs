//! The variants that the tables compare.

use kanamori_peel::{Clipping, Options, Outline, Registration, robust};
use metaball_core::gpu::IsoRenderer;

/// A variant of the method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variant {
    /// As published, with the paper's grid of tiles for the picture's size.
    Published,
    /// Polyhedra instead of rectangles: section 5.1.
    Tessellated,
    /// Every ball drawn, hidden or not: section 5.2.
    Unculled,
    /// So many tiles on a side: section 5.3.
    Tiles(u32),
    /// Balls registered with tiles on the adapter, not on the host: section 5.3.
    RegisteredOnAdapter,
    /// Clipping with the short memory that the paper compares with: section 5.4.
    Iterative,
    /// Clipping by the original recursion: section 5.4.
    Original,
    /// A threshold of clipping.
    Threshold(f32),
    /// Not published: no peeling.
    Robust,
}

impl Variant {
    /// Its name in files and tables.
    pub fn name(self) -> String {
        match self {
            Self::Published => "published".to_owned(),
            Self::Tessellated => "5.1: tessellated spheres".to_owned(),
            Self::Unculled => "5.2: all balls drawn".to_owned(),
            Self::Tiles(1) => "5.3: one tile".to_owned(),
            Self::Tiles(tiles) => format!("5.3: {tiles} × {tiles} tiles"),
            Self::RegisteredOnAdapter => "5.3: registered on the adapter".to_owned(),
            Self::Iterative => "5.4: iterative clipping".to_owned(),
            Self::Original => "5.4: original clipping".to_owned(),
            Self::Threshold(threshold) => format!("threshold {threshold:e}"),
            Self::Robust => "robust (not published)".to_owned(),
        }
    }

    /// A renderer for pictures of this size.
    pub fn renderer(self, size: (u32, u32), counting: bool) -> Box<dyn IsoRenderer> {
        if self == Self::Robust {
            return Box::new(robust::Renderer::new("kanamori-robust", counting));
        }
        let options = self.options(size);
        Box::new(kanamori_peel::Renderer::new("kanamori", options, counting))
    }

    fn options(self, (width, _): (u32, u32)) -> Options {
        // Section 5.3: 8 × 8 for 640 × 480, 16 × 16 for 1024 × 768.
        let tiles = if width >= 1024 { 16 } else { 8 };
        let published = Options { tiles, ..Options::default() };
        match self {
            Self::Published | Self::Robust => published,
            Self::Tessellated => Options { outline: Outline::Tessellation, ..published },
            Self::Unculled => Options { culling: false, ..published },
            Self::Tiles(tiles) => Options { tiles, ..published },
            Self::RegisteredOnAdapter => {
                Options { registration: Registration::Adapter, ..published }
            }
            Self::Iterative => Options { clipping: Clipping::Iterative, ..published },
            Self::Original => Options { clipping: Clipping::Original, ..published },
            Self::Threshold(threshold) => Options { threshold, ..published },
        }
    }
}
