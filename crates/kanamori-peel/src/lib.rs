//! Metaballs by rasterised depth peeling and Bézier clipping: Kanamori, Szego and Nishita 2008,
//! "GPU-based Fast Ray Casting for a Large Number of Metaballs".
//!
//! # Theory
//! Along a ray the set of balls that can contribute changes only where the ray enters or leaves a
//! support ("effective sphere"). Depth peeling finds these points one by one from front to back,
//! for all rays at once (section 4.1). Each ray keeps the list of balls that hold its point, toggled by
//! the index that each layer brings (section 4.2). In the interval between two points the field is
//! one polynomial: of a single ball, whose surface is a sphere ("kernel sphere"), or a sum of
//! several, which in Bernstein form is searched by Bézier clipping (section 3, appendix A). The
//! first interval with a surface ends the ray.
//!
//! A frame is one encoder; what it took is read when the next one is recorded:
//!
//! | pass | what | section |
//! | --- | --- | --- |
//! | `place` | a rectangle around each ball on the picture | 5.1, appendix B |
//! | `kernel spheres`, `seen` | depth of the kernel spheres; a flag for each ball seen before them | 5.2 |
//! | `arrange` | which balls are drawn, and the list of those around the eye | 5.2 |
//! | `register` | the balls of each tile, unless the host has sent them (`cpu:register`) | 5.3 |
//! | `turn` | per layer: tiles without an unanswered ray draw nothing any more | 5.3 |
//! | `peel` | per layer: the nearest point behind the last one, tile by tile in one pass | 4.1, 5.1 |
//! | `test` | per layer: search of the interval, and the list toggled | 4.2, 4.3, 5.4 |
//! | `account` | misses of tiles without balls; count of the rays without an answer | |
//!
//! # Changes versus the paper
//! *Coefficients* of appendix A hold with a = Q²/R², Q half the chord; the text has D/R. Every power
//! kernel has the same form: v^α has one coefficient, (4a)^α over 2α choose α. A kernel that is no
//! polynomial along a ray, as Perlin's or a spline of SPH, is refused.
//!
//! *Rectangles* of appendix B hold for spheres wholly in front of the eye's plane. Here tangents are
//! turned directions, with cases for spheres that cross the plane, lie behind it or hold the eye
//! (`shaders/wgsl/core/cover.wgsl`).
//!
//! *The eye may be inside supports*: the paper's is outside. Rays begin at t = 0 with the balls
//! around the eye on their lists, decided once per ball and frame.
//!
//! *Occlusion queries* become flags: fragments mark which balls are seen and which tiles have an
//! unanswered ray. Culled balls lose their rectangle. A tile is a scissored indirect draw of the layer's
//! one pass; once all its rays are answered it draws no instances, so that layers are recorded in
//! advance: a quarter more than the last frame took, and no more than a tile's balls can have points.
//! The kernel sphere's depth is the hit of the single case and ends every ray: balls behind it are
//! culled, and no point behind it would be right.
//!
//! *An answered ray* in a tile that goes on leaves both passes of a layer at once, by the hit that it
//! has, and writes nothing. Nothing is cleared from layer to layer either: the test sets the depth back
//! for the rays that go on, and a point that is not beyond the last one is the last one.
//!
//! *Registration on the host,* as published, has the rectangles and not what is seen: culled balls
//! are registered and drop out in the vertex stage. [`Registration::Adapter`] leaves them out.
//!
//! *A full stack* drops its furthest range, which is cut from the whole curve again when it is next,
//! so no stack size loses a root. Ranges with several sign changes are split down to the square of
//! the threshold before they count as a root, since a hull may cross the axis where the curve does
//! not.
//!
//! *What each optimisation replaces* can be chosen in [`Options`], to measure what it brings:
//! polyhedra, all balls, one tile, and two other ways of clipping. [`Clipping::Iterative`] is our
//! reading of a form that the paper describes in a clause; the paper has 16.4 iterations for it.
//!
//! *A ball whose exit is lost* to a coincident point (section 7, figure 9a) stays on the list, as
//! printed, but adds nothing outside its own chord: a lost point can make a surface late, never
//! early.
//!
//! *Not in the paper:* [`robust`] is a renderer that is right where section 7 gives up, and
//! [`baseline`] the CPU version that section 6 compares with.
//!
//! # Practice
//! Right wherever no two points along the ray before the surface coincide in f32 and no more than K
//! supports overlap there. With more than K ([`Options::list_capacity`]) the support itself is drawn, as
//! section 7 says, and the hit is marked as a fallback. Nothing marks a coincident point: of those with
//! one t a single one is peeled, and section 7 leaves out the check that would notice, for its cost.
//! Coincident equal balls are peeled as one. t errs by at most half the threshold
//! ([`Options::threshold`]) times the interval's length.
//!
//! A frame that runs out of layers is incomplete and is drawn again with twice as many; one whose tiles
//! have more balls than their buffers hold, with buffers that hold them. [`Renderer`]'s `frame_facts`
//! are the balls drawn, the share that was culled, and the layers taken; its counters ([`metaball_core::Work`]) have the
//! iterations of clipping, in all and in the longest search. 144 bytes a pixel with K = 14. At most
//! [`MOST_BALLS`] balls: indices are kept as f32. A kernel that is no polynomial along a ray is refused
//! with [`metaball_core::gpu::RenderError::Unsupported`].

pub mod baseline;
pub mod robust;

mod balls;
mod layer_limit;
mod layers;
mod layouts;
mod options;
mod passes;
mod pipelines;
mod registration;
mod renderer;
#[cfg(test)]
mod tests;
mod tiles;

pub use balls::MOST_BALLS;
pub use options::{
    CLIPPING_THRESHOLD, Clipping, LIST_CAPACITY, MOST_LIST_CAPACITY, Options, Outline,
    Registration, STACK_SIZE,
};
pub use renderer::Renderer;
