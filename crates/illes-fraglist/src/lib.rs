//! Efficient GPU Fluid Visualization, Dávid Illés and László Szécsi: fragment lists of the balls that
//! a pixel's ray meets, and a piecewise polynomial along the ray. Cited by section and equation.
//!
//! # Theory
//! Along a ray, ball j's field is positive in its *effective interval* \[m − Q, m + Q\], m the
//! projection of its centre, Q half its chord. A cubic on either half, with the field's values and
//! slopes at ends and midpoint, approximates it (section 3, figure 5); where the kernel is a
//! polynomial in r² the field itself is a polynomial there. Between two neighbouring ends or
//! midpoints, the *separators*, the sum over all balls is one polynomial (section 4), whose first
//! root is easily found.
//!
//! The passes of a frame (section 5), by label:
//!
//! | label | what |
//! | --- | --- |
//! | `cpu:sort` or `sort` | balls by *effective distance* \|p − e\| − R, in parallel on the host, or by [`Sort::Adapter`] |
//! | `cores` | distance to the nearest *core*: the sphere in which a ball alone reaches the threshold |
//! | `gather` | each ball's rank into the lists of the pixels whose rays meet its support before the core |
//! | `cast` | lists into separators in a short array, of which those in the *safe zone*, nearer than any ball that follows in the list, are passed one by one (section 6) |
//! | `resume` | the same for the rays, on a list, whose search exceeded the budget of one dispatch |
//!
//! # Changes versus the paper
//! *Equation (2)* as printed has the cubic rise from the wrong t: m must be m − Q. The table of Δw in
//! section 4 has γ(s) where γ(m) is meant: γ vanishes at both ends.
//!
//! *The core is a hit.* Some kernels' cubics lie below the kernel, and a ray clipped at the core would
//! have no root: with the quartic every isolated ball would vanish. A ray that reaches a core without a
//! root hits there, since the core lies in the solid; [`ListStats::core_hits`] counts them.
//!
//! *Order is restored, not assumed.* Balls are drawn back to front, but no WebGPU device promises that
//! fragments arrive so. Lists hold ranks, and a natural merge sort of the links orders them: one walk
//! for a list that is in order.
//!
//! *An eye inside supports* starts with the sum of their segments, as section 4 has it; step 1 of
//! section 6 does not.
//!
//! *Pools grow.* A frame that ran out of list nodes reports how many it needed and is drawn again.
//! *Rays can wait* for the next dispatch: see `shaders/wgsl/illes_fraglist/budget.wgsl`.
//!
//! *Rebuilt cubics*, a variant of ours: the running sum of the printed Δw, coefficients of (s³, s², s, 1), is
//! wrong by 4 % of a ball ten radii from the eye, by half a ball at thirty. Shifted from separator to
//! separator it would drift with the path, since a ball's three increments cancel only where its f32
//! separators are exactly Q apart. [`Piece::Rebuilt`] keeps the balls that are active between two separators,
//! and makes each piece from their values and slopes at its ends, in Bernstein form: right to 1.3e-6
//! anywhere.
//!
//! *Other variants of ours*: [`Piece::Robust`] searches a ray without the array once that is full, by upper
//! bounds of the field over intervals of the ray, one walk along the list for each; [`Gather::Tiles`]
//! gathers in compute, balls into tiles of the picture (pass `bin`: count, prefix sum, fill) and tiles
//! into cores and lists of pixels.
//!
//! # Practice
//! The published cubic is not the kernel. In parts of a ball's value at the midpoint of its chord the
//! kernel is above the cubic by 0 to 0.0625 for the quartic, −0.0902 to 0 for α = 3, −0.0128 to
//! 0.0625 for Wyvill's, −0.0902 to 0.0537 for Perlin's, −0.25 to 0 for the cubic spline of SPH, −0.48 to
//! 0 for Wendland's C⁶, and by up to 0.296 where a Gaussian's slope jumps ([`cubic_deviation`]).
//! [`Piece::Exact`] and [`Piece::Robust`] are within rounding, for kernels that are polynomials of degree
//! up to six along a ray; other kernels they refuse.
//!
//! Where more separators are active than the array holds ([`Options::array_capacity`]) the published
//! method passes some that are not safe; such pixels are marked as fallback.
//!
//! A pixel's list may have [`LIST_CAPACITY`] balls before the core, and a tile [`TILE_CAPACITY`]; more is
//! refused with the number, as is a pool that exceeds what the adapter binds: 16.7 million nodes where
//! that is 128 MiB. A picture takes 52 bytes a pixel and 8 a list node; a scene 24 a ball, and 16 more to
//! be sorted on the adapter.
//!
//! ```no_run
//! use illes_fraglist::{Options, Piece, Renderer};
//! use metaball_core::gpu::{AdapterChoice, Gpu, IsoRenderer, Targets, render};
//! use metaball_core::{Camera, Kernel, Metaball, Scene, View};
//!
//! let balls = [Metaball::new([0.0, 0.0, 0.0].into(), 1.0)];
//! let scene = Scene::new(balls, Kernel::Wyvill, 0.5)?;
//! let camera = Camera::framing(&scene.bounds(), [0.0, 0.3, 1.0].into());
//! let view = View::new(camera, 640, 480)?;
//!
//! let gpu = Gpu::new(&AdapterChoice::Environment)?;
//! let options = Options { piece: Piece::Exact, ..Options::default() };
//! let mut renderer = Renderer::new("illes-exact", options, false);
//! renderer.build(&gpu, &scene)?;
//! let targets = Targets::new(&gpu, 640, 480, false, false)?;
//! render(&gpu, &mut renderer, &targets, &view)?;
//! let hits = targets.read_hits(&gpu)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod balls;
mod canvas;
mod cast;
mod deviation;
mod gather;
mod layouts;
mod lists;
mod options;
mod pipelines;
mod renderer;
mod sort;
#[cfg(test)]
mod tests;

pub use deviation::{Deviation, cubic_deviation};
pub use lists::ListStats;
pub use options::{
    ARRAY_CAPACITY, Gather, LIST_CAPACITY, Options, Piece, ROOT_TOLERANCE, Sort, TILE_CAPACITY,
};
pub use renderer::Renderer;
