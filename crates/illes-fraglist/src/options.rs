//! What can be chosen.

use metaball_core::Kernel;

/// The polynomial between two separators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Piece {
    /// The published cubic, a running sum in powers of t, which loses its digits with the distance from the
    /// eye.
    Running,
    /// The same cubic, made anew from the balls active in each piece. Not published.
    Rebuilt,
    /// The field itself, of degree four or six.
    Exact,
    /// The same; and where a ray has more separators than the local array holds, the rest of the ray is
    /// searched without it, by upper bounds of the field over intervals of the ray. Not published.
    Robust,
}

/// How balls get into the lists of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Gather {
    /// By rasterising a rectangle a ball, as published.
    Raster,
    /// In compute, by tiles of the picture. Not published: for adapters with little raster hardware,
    /// where the published gathering would measure that hardware.
    Tiles,
}

/// Where balls are sorted by effective distance, once a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sort {
    /// On the host, in parallel, as published; the order is sent to the adapter.
    Host,
    /// On the adapter, by radix sort. Not published.
    Adapter,
}

/// How the method works; the default is the published method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// The polynomial between two separators.
    pub piece: Piece,
    /// How the lists are gathered.
    pub gather: Gather,
    /// Where balls are sorted.
    pub sort: Sort,
    /// Separators that a ray's local array holds, from 3 to [`ARRAY_CAPACITY`]; others are taken as the
    /// nearest of these. The array is compiled with 12, 24, 48 or 96, the least of them that holds so many.
    pub array_capacity: u32,
    /// List nodes that the first pool holds, 8 bytes each. With too few, a frame is drawn again.
    pub first_nodes: u32,
}

/// The largest [`Options::array_capacity`], and the default: the longest of the local arrays in
/// `shaders/wgsl/illes_fraglist/array_size`. Section 6 has "surely less than 100"; a ball has three.
pub const ARRAY_CAPACITY: u32 = 96;

/// The most balls that a ray may meet before its core: walks along its list must stay within the
/// iterations of software Vulkan. `LIST_CAPACITY` of `shaders/wgsl/illes_fraglist/budget.wgsl`.
pub const LIST_CAPACITY: u32 = 6_144;

/// The most balls over a tile of the picture with [`Gather::Tiles`], bounded as [`LIST_CAPACITY`] is.
/// `TILE_CAPACITY` of `shaders/wgsl/illes_fraglist/collect.wgsl`.
pub const TILE_CAPACITY: u32 = 120_000;

/// How far behind the root of a piece a hit may be, in parts of the piece between two separators,
/// which is no longer than a radius; rounding aside. The width at which the root finders of
/// `shaders/wgsl/illes_fraglist/cubic_root.wgsl` and `shaders/wgsl/illes_fraglist/polynomial_root.wgsl`
/// end.
pub const ROOT_TOLERANCE: f64 = 4e-7;

impl Options {
    /// The published method; 8 MB of nodes.
    pub const PUBLISHED: Self = Self {
        piece: Piece::Running,
        gather: Gather::Raster,
        sort: Sort::Host,
        array_capacity: ARRAY_CAPACITY,
        first_nodes: 1 << 20,
    };
}

impl Default for Options {
    /// [`Options::PUBLISHED`].
    fn default() -> Self {
        Self::PUBLISHED
    }
}

/// The modules of a piece, with each size of array.
macro_rules! with_arrays {
    ($piece:literal, $overlap:literal) => {
        [
            (12, &[$piece, $overlap, "illes_fraglist/array_size/of_12"]),
            (24, &[$piece, $overlap, "illes_fraglist/array_size/of_24"]),
            (48, &[$piece, $overlap, "illes_fraglist/array_size/of_48"]),
            (ARRAY_CAPACITY, &[$piece, $overlap, "illes_fraglist/array_size/of_96"]),
        ]
    };
}

impl Options {
    /// Separators that a ray's local array holds: [`Options::array_capacity`] within its range.
    pub(crate) fn capacity(&self) -> u32 {
        self.array_capacity.clamp(3, ARRAY_CAPACITY)
    }

    /// Names of the WGSL modules to choose.
    pub(crate) fn modules(&self) -> &'static [&'static str] {
        let by_size: [(u32, &'static [&'static str; 3]); 4] = match self.piece {
            Piece::Running => {
                with_arrays!("illes_fraglist/piece/running_cubic", "illes_fraglist/overlap/printed")
            }
            Piece::Rebuilt => {
                with_arrays!("illes_fraglist/piece/rebuilt_cubic", "illes_fraglist/overlap/printed")
            }
            Piece::Exact => {
                with_arrays!("illes_fraglist/piece/exact", "illes_fraglist/overlap/printed")
            }
            Piece::Robust => {
                with_arrays!("illes_fraglist/piece/exact", "illes_fraglist/overlap/searched")
            }
        };
        let fits = |(size, _): &(u32, _)| *size >= self.capacity();
        by_size.into_iter().find(fits).map_or(&[], |(_, modules)| modules)
    }
}

impl Piece {
    /// Whether the piece is the field's own polynomial.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Exact | Self::Robust)
    }

    /// Why this piece cannot represent the kernel; `None` where it can.
    pub(crate) fn refusal(self, kernel: Kernel) -> Option<String> {
        if !self.is_exact() || exact_degree(kernel).is_some() {
            return None;
        }
        let needed = "needed a kernel that is a polynomial of degree six or less along a ray";
        Some(match kernel.degree_along_ray() {
            Some(degree) => format!("{needed}, found {kernel} of degree {degree}"),
            None => format!("{needed}, found {kernel}, which is none"),
        })
    }
}

/// The degree in which the exact piece is written, 4 or 6; `None` where neither is enough.
pub(crate) fn exact_degree(kernel: Kernel) -> Option<u32> {
    match kernel.degree_along_ray()? {
        0..=4 => Some(4),
        5..=6 => Some(6),
        _ => None,
    }
}
