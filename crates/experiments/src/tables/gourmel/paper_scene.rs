//! The scenes of Gourmel et al. 2010, and ours instead of them.

use crate::extent::Extent;

/// A scene of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PaperScene {
    /// 30,000 scattered balls.
    Scattered30k,
    /// 100,000 scattered balls.
    Scattered100k,
    /// The tornado of 4,000 balls.
    Tornado4k,
    /// The tornado of 128,000 balls.
    Tornado128k,
    /// The molecule of 5,440 balls; ours has 5,547.
    Molecule,
    /// The pool of 10,000 balls.
    Pool,
}

impl PaperScene {
    /// What to load for it.
    pub fn spec(self, extent: Extent) -> &'static str {
        match (extent, self) {
            (Extent::Whole, Self::Scattered30k) => "scattered-30k",
            (Extent::Whole, Self::Scattered100k) => "scattered-100k",
            (Extent::Whole, Self::Tornado4k) => "tornado-4k",
            (Extent::Whole, Self::Tornado128k) => "tornado-128k",
            (Extent::Whole, Self::Pool) => "pool-10k",
            (_, Self::Molecule) => "molecule",
            (Extent::Quick, Self::Scattered30k) => "scattered:300",
            (Extent::Quick, Self::Scattered100k) => "scattered:1000",
            (Extent::Quick, Self::Tornado4k) => "tornado:150",
            (Extent::Quick, Self::Tornado128k) => "tornado:300",
            (Extent::Quick, Self::Pool) => "pool:200",
        }
    }
}
