//! Bounding volume hierarchies for ray tracing metaballs, after
//! Gourmel, Pajot, Paulin, Barthe, Poulin 2010, *Fitted BVH for Fast Raytracing of Metaballs*.
//!
//! Metaballs add up to a field; the surface is where it equals a threshold. Where many balls
//! overlap, what a ray costs is the number of balls it must look at. This crate sorts them so that
//! it looks at few: build a [`Tree`] once, then send rays through it with a [`Tracer`], or upload
//! its arrays and use the shaders.
//!
//! ```
//! use fbvh::{Options, TraceOptions, Tracer, Tree};
//! use metaball_core::{Kernel, Metaball, Ray, Scene};
//!
//! let balls = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]].map(|center| Metaball::new(center.into(), 1.0));
//! let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
//!
//! let tree = Tree::build(&scene, &Options::fitted())?;
//! let tracer = Tracer::new(&tree, &scene, TraceOptions::DEFAULT);
//! let hit = tracer.first_hit(&Ray::new([0.0, 0.0, -3.0].into(), [0.0, 0.0, 1.0].into()));
//!
//! // Midway both add (¾ − z²)²: the surface is where that is an eighth.
//! let z = (0.75f32 - 0.125f32.sqrt()).sqrt();
//! assert!(hit.is_hit() && (hit.t - (3.0 - z)).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Theory
//! *The two structures* ([`Structure`]). In both, a leaf lists every ball that its part of the
//! surface depends on: *own* balls, which belong to it, and *split* balls, which reach into it.
//! The modified BVH (section 4) puts boxes around the supports of own balls. Such boxes overlap, so
//! a ray must go on after a hit until no nearer box is left. The Fitted BVH (section 5) cuts space:
//! a node's box is divided at the plane and each part is *fitted*, shrunk to the balls that reach
//! into it. Its leaves do not overlap, the first hit ends the ray, and dense scenes profit most.
//!
//! *The heuristic* ([`Cost`]). Planes are chosen by the surface area heuristic over bins. Searching
//! a leaf of n balls evaluates n balls at n projections, so it is taken to cost n² + λn (section
//! 5.1.1). A node becomes a leaf where no cut is expected to pay.
//!
//! *Tighter boxes and shorter lists* ([`Fitting`], section 5.3). Where the field is T, some ball
//! adds T/Σq or more, so the surface keeps within Rᵢ·k⁻¹(T/Σq) of some centre. That shrinks boxes,
//! empties nodes whose balls cannot reach T together, and shows which split balls cannot take part
//! in any surface inside the box.
//!
//! *The intersection test* ([`TraceOptions`], section 3). Centres are projected on the ray; the
//! first projection where the field is T or more ends a bracket, and false position closes in on the
//! surface. This assumes that every ray that hits has such a projection. Of random rays that hit, two
//! in a thousand do not, nearly tangent ones, and are missed: that is the published method.
//!
//! *The certified tree* ([`Kind::Certified`], not in the paper). Boxes are classified by exact ranges
//! of the field: below T throughout and dropped, above T throughout and solid, or else a leaf with a
//! list. A leaf is searched with bounds that no root escapes, and all rounding accounted for: in f32
//! by polynomials nowhere below the field, eight balls at a time, and in f64 by ranges where f32 cannot
//! tell. So an answer is right or says that it is undecided.
//!
//! # Changes versus the paper
//! - T/Σq stands for the printed T/n, which is wrong for strengths above 1. Σ and n run over own and
//!   split balls. [`Boxes::PerBall`] applies the bound to each radius.
//! - A part without surface is dropped and its sibling takes the node's place.
//! - An own ball whose support does not reach its node's fitted box is dropped from the node: it can
//!   be a split ball elsewhere.
//! - The leaf test of section 5.2 is read in two ways, see [`Reading`]. By default it is confined to
//!   the leaf's box.
//! - The secant search keeps its bracket, with halved weights (Illinois), and so converges when the
//!   bracket holds more than one root; it may then return a later one.
//! - A traversal step has a cost of its own, [`Options::traversal_cost`].
//! - Depth is bounded ([`MAX_DEPTH`]), so that no stack can overflow. Balls at one place, which no plane
//!   tells apart, are one leaf.
//! - Any-hit rays end at the paper's bracket, whose end is a point inside. Where a ray leaves the solid
//!   the paper does not say; certified trees do.
//!
//! # Practice
//! [`Options::certified`] is what to take for pictures: its answers are right, and its lists do not grow
//! with density. [`Options::fitted`] and [`Options::modified_bvh`] are the published structures. A
//! tree is for one kernel and one threshold, since boxes and lists depend on them. Building is parallel,
//! divides its lists in place, and makes the same tree bit for bit whatever the number of threads. A
//! tree's memory is that of its lists, which in the published ones grow with density; [`Tree::stats`]
//! says how large they are, and [`Tree::validate`] lets a tree prove itself.
//!
//! Rays ask three things: where they enter the solid ([`Tracer::first_hit`]), whether there is any
//! ([`Tracer::any_hit`], for shadows), and where they leave it ([`Tracer::first_exit`], from inside, in
//! certified trees). Each can be asked of a slice of rays at once, in parallel.
//!
//! Particles of another type need not be copied: implement [`Field`] for them. Balls that could
//! never be traced (radii of 0, NaN) are refused by index; everything else is legal, an empty scene
//! too.
//!
//! # Features
//! `gpu` adds the module `gpu`: all three structures as [`metaball_core`] renderers on wgpu. Without it
//! nothing here knows of graphics cards, except that [`Node`] and [`Leaf`] are laid out for them.

mod builder;
mod field;
#[cfg(feature = "gpu")]
pub mod gpu;
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
pub use trace::{Counter, Reading, TraceOptions, Tracer, Work};
pub use tree::Tree;
pub use validate::Flaw;
