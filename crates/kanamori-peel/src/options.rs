//! What of the method can be set.

use metaball_core::gpu::{Gpu, RenderError};

/// What is rasterised for a ball (section 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outline {
    /// The smallest upright rectangle around the ball on the picture (appendix B).
    Rectangle,
    /// A polyhedron around the ball, 128 triangles: what the rectangle replaces.
    Tessellation,
}

/// How the first root of an interval is found (section 5.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Clipping {
    /// The paper's: a curve with several changes of sign is split before it is clipped, and only
    /// halves that reach the axis wait on a short stack.
    ShortStack,
    /// What the paper compares with: no stack. A curve that clipping does not narrow is cut in two, and
    /// the right half is cut from the whole curve again after the left.
    Iterative,
    /// Nishita, Sederberg and Kakimoto 1990: every curve is clipped first and split where that does
    /// not narrow it, with a stack as deep as needed.
    Original,
}

/// Where balls are sorted into the picture's tiles (section 5.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Registration {
    /// On the host, as published. Culled balls are registered, too: which they are is known on the
    /// adapter alone.
    Host,
    /// On the adapter, without the culled balls. Not published.
    Adapter,
}

/// K as published: the balls that a ray's list holds (section 4.2). Four targets of four f32, less the
/// t of the last point and the number of balls. `LONGEST` of
/// `shaders/wgsl/kanamori_peel/longest/four_targets.wgsl`.
pub const LIST_CAPACITY: u32 = 14;

/// The most that [`Options::list_capacity`] can be: eight targets, less two numbers. `MOST_ACTIVE` of
/// `shaders/wgsl/kanamori_peel/arranged.wgsl`.
pub const MOST_LIST_CAPACITY: u32 = 30;

/// The published width at which a range is a root, in parts of an interval: the "10e−4" of section 5.4.
/// An interval is at most two radii long and a root the middle of its range, so t errs by at most this
/// part of a radius, rounding aside.
pub const CLIPPING_THRESHOLD: f32 = 1e-3;

/// The published number of ranges that can wait on the short stack (section 5.4).
pub const STACK_SIZE: u32 = 3;

/// How the method works; the default is the published method with the paper's own numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// K, the balls that a ray's list holds: 1 to [`MOST_LIST_CAPACITY`], as far as the adapter's
    /// targets go. Published: [`LIST_CAPACITY`].
    pub list_capacity: u32,
    /// What is rasterised for a ball. It affects time alone.
    pub outline: Outline,
    /// Whether balls hidden by kernel spheres are left out (section 5.2). It affects time, and t within
    /// the threshold.
    pub culling: bool,
    /// Tiles on a side of the picture's grid, each peeled until it ends, 1 to 16. The paper has 8 for
    /// 640 × 480 and 16 for 1024 × 768 (section 5.3). It affects time alone.
    pub tiles: u32,
    /// Where balls are sorted into tiles. It affects time alone.
    pub registration: Registration,
    /// How an interval is searched.
    pub clipping: Clipping,
    /// Width at which a range is a root, in parts of an interval between two points of a ray: 1e-6
    /// to 0.5. Published: [`CLIPPING_THRESHOLD`].
    pub threshold: f32,
    /// Ranges that can wait on the short stack, 1 to 4. Published: [`STACK_SIZE`]. It affects time
    /// alone.
    pub stack_size: u32,
}

impl Options {
    /// The published method.
    pub const PUBLISHED: Self = Self {
        list_capacity: LIST_CAPACITY,
        outline: Outline::Rectangle,
        culling: true,
        tiles: 8,
        registration: Registration::Host,
        clipping: Clipping::ShortStack,
        threshold: CLIPPING_THRESHOLD,
        stack_size: STACK_SIZE,
    };
}

impl Default for Options {
    /// [`Options::PUBLISHED`].
    fn default() -> Self {
        Self::PUBLISHED
    }
}

/// Bytes of a pixel of one target: four f32.
const TARGET_BYTES: u32 = 16;

/// Numbers of a list before its balls: t of the last point, and the number of balls.
const HEAD: u32 = 2;

/// Tiles on a side of the picture's grid at most: `MOST_TILES` of
/// `shaders/wgsl/kanamori_peel/tiles.wgsl` is its square.
pub(crate) const MOST_TILES: u32 = 16;

impl Options {
    /// Targets of four f32 that hold a full list with its head: N_buf.
    pub(crate) fn targets(&self) -> u32 {
        (self.list_capacity + HEAD).div_ceil(4)
    }

    /// Refuses what is out of range or beyond the adapter.
    pub(crate) fn check(&self, gpu: &Gpu, method: &'static str) -> Result<(), RenderError> {
        let refused = |reason| Err(RenderError::Unsupported { method, reason });
        let limits = gpu.device.limits();
        let targets = limits
            .max_color_attachments
            .min(limits.max_color_attachment_bytes_per_sample / TARGET_BYTES);
        let longest = (4 * targets).saturating_sub(HEAD).min(MOST_LIST_CAPACITY);
        if !(1..=longest).contains(&self.list_capacity) {
            let found = self.list_capacity;
            return refused(format!(
                "list capacity: needed 1 to {longest} on this adapter, found {found}"
            ));
        }
        if !(1..=MOST_TILES).contains(&self.tiles) {
            let found = self.tiles;
            return refused(format!("tiles on a side: needed 1 to {MOST_TILES}, found {found}"));
        }
        if !(1e-6..=0.5).contains(&self.threshold) {
            let found = self.threshold;
            return refused(format!("clipping threshold: needed 1e-6 to 0.5, found {found}"));
        }
        if !(1..=4).contains(&self.stack_size) {
            let found = self.stack_size;
            return refused(format!("clipping stack size: needed 1 to 4, found {found}"));
        }
        Ok(())
    }
}
