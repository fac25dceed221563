//! Ray tracing of metaballs on bounding volume hierarchies: a certified tree, for which no ray's answer
//! is wrong, and the two structures of Gourmel, Pajot, Paulin, Barthe and Poulin 2010, *Fitted BVH for
//! Fast Raytracing of Metaballs*.
//!
//! Metaballs add up to a field, from which negative ones take away; the surface is where it equals a threshold T. Build a [`Tree`] of the
//! balls once, then trace rays through it with a [`Tracer`], or upload its arrays and use the shaders.
//!
//! ```
//! use fbvh::{Options, Tracer, Tree};
//! use metaball_core::{Kernel, Metaball, Ray, Scene};
//!
//! let balls = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]].map(|center| Metaball::new(center.into(), 1.0));
//! let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
//! let tree = Tree::build(&scene, &Options::certified())?;
//! let tracer = Tracer::new(&tree, &scene);
//!
//! let hit = tracer.first_hit(&Ray::new([0.0, 0.0, -3.0].into(), [0.0, 0.0, 1.0].into()));
//! println!("{:?} at t = {}", hit.verdict, hit.t); // Hit at t = 2.37036
//!
//! // Midway both balls add (¾ − z²)²: the surface is where that is an eighth.
//! let z = (0.75f32 - 0.125f32.sqrt()).sqrt();
//! assert!((hit.t - (3.0 - z)).abs() < 1e-6);
//! # assert_eq!(format!("{:?} at t = {}", hit.verdict, hit.t), "Hit at t = 2.37036");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Choosing a tree
//! - [`Options::certified`] is the one to take for pictures: answers are right, or
//!   [`Undecided`](metaball_core::Verdict::Undecided) where arithmetic cannot decide, and its lists do
//!   not grow with density. It alone knows where rays leave the solid.
//! - [`Options::fitted`] and [`Options::modified_bvh`] are the published structures, for comparison.
//!   Nearly tangent rays may miss the surface, lists grow with density, and negative balls are refused.
//!
//! A tree is for one kernel and one threshold, since boxes and lists depend on them. Building is
//! parallel, divides its lists in place, and makes the same tree bit for bit whatever the number of
//! threads. [`Tree::stats`] reports how large a tree is, [`Tree::validate`] checks it against its field.
//!
//! # Tracing rays
//! A ray is queried for its entry into the solid ([`Tracer::first_hit`]), for any solid on it
//! ([`Tracer::any_hit`], for shadow and occlusion rays), and for its exit from the solid
//! ([`Tracer::first_exit`]); each for a slice of rays in parallel, too. Positions are in world space and
//! scene units; t counts in the ray's direction, which is a unit vector.
//!
//! A [`ClippedTracer`] answers the same about the solid cut to a [`Clip`](metaball_core::Clip), with
//! filled faces.
//!
//! Particles of another type need not be copied: implement [`Field`] for them. Balls that cannot be
//! traced (radii of 0, NaN) are refused by index; everything else is legal, an empty scene too.
//!
//! # Theory
//! *The certified tree* ([`Kind::Certified`], not in the paper). Boxes are classified by exact ranges
//! of the field: below T throughout and dropped, above T throughout and solid, or else a leaf with a
//! list. A leaf is searched with bounds that no root escapes, with all rounding accounted for: in f32
//! by polynomials nowhere below the field, eight balls or eight rays at a time, and in f64 by ranges
//! where f32 cannot decide.
//!
//! *The published structures* ([`Structure`]). In both, a leaf lists every ball that its part of the
//! surface depends on: *own* balls, which belong to it, and *split* balls, which reach into it.
//! The modified BVH (section 4) puts boxes around the supports of own balls. Such boxes overlap, so
//! a ray must continue after a hit until no nearer box is left. The Fitted BVH (section 5) cuts space:
//! a node's box is divided at the plane and each part is *fitted*, shrunk to the balls that reach
//! into it. Its leaves do not overlap, the first hit ends the ray, and dense scenes profit most.
//!
//! *The heuristic* ([`Cost`]). Planes are chosen by the surface area heuristic over bins. Searching
//! a leaf of n balls evaluates n balls at n projections, so it is estimated to cost n² + λn (section
//! 5.1.1). A node becomes a leaf where no cut is expected to pay.
//!
//! *Tighter boxes and shorter lists* ([`Fitting`], section 5.3). Where the field is T, some ball's
//! kernel is T/Σq or more, so the surface is within Rᵢ·k⁻¹(T/Σq) of some centre. That
//! shrinks boxes, empties nodes whose balls cannot reach T together, and shows which split balls cannot
//! take part in any surface inside the box.
//!
//! *The intersection test* ([`SecantSearch`], section 3). Centres are projected on the ray; the
//! first projection where the field is T or more ends a bracket, and false position closes in on the
//! surface. This assumes that every ray that hits has such a projection. Of random rays that hit, two
//! in a thousand do not, nearly tangent ones, and are missed: that is the published method.
//!
//! # Changes versus the paper
//! - T/Σq stands for the printed T/n, which is wrong for strengths above 1. Σ and n run over own and
//!   split balls. [`Boxes::PerBall`] applies the bound to each radius.
//! - A part without surface is dropped and its sibling replaces the node.
//! - An own ball whose support does not reach its node's fitted box is dropped from the node: it can
//!   be a split ball elsewhere.
//! - The leaf test of section 5.2 can be read in two ways, see [`Reading`]. By default it is confined
//!   to the leaf's box.
//! - The secant search keeps its bracket, with halved weights (Illinois), and so converges when the
//!   bracket holds more than one root; it may then return a later one.
//! - A traversal step has a cost of its own, [`Options::traversal_cost`].
//! - Depth is bounded ([`MAX_DEPTH`]), so that no stack can overflow. Coincident balls, which no plane
//!   separates, are one leaf.
//! - Any-hit rays end at the paper's bracket, whose end is a point inside. The paper has no test for
//!   exits.
//!
//! # Among other methods
//! [`host::Method`] is all of this behind [`metaball_core::HostMethod`], to be compared.
//!
//! # Features
//! `gpu` adds the module `gpu`: all three structures as [`metaball_core`] renderers on wgpu. Without it
//! nothing here depends on a GPU, except that [`Node`] and [`Leaf`] are laid out for one.

mod builder;
mod field;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod host;
mod node;
mod options;
mod stats;
mod trace;
mod tree;
mod validate;

pub use builder::BuildError;
pub use field::Field;
pub use node::{EMPTY, LEAF, Leaf, MAX_DEPTH, Node};
pub use options::{Boxes, Classes, Cost, Fitting, Kind, Options, Structure};
pub use stats::{Spread, Stats};
pub use trace::{
    ClippedScratch, ClippedTracer, Counter, Reading, SecantSearch, TraceError, TraceScratch,
    Tracer, Work,
};
pub use tree::Tree;
pub use validate::Flaw;
