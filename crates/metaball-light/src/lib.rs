//! Shadows, ambient occlusion, reflection and refraction for metaballs, by a path tracer: on the CPU, and on
//! wgpu.
//!
//! The effects of Gourmel et al. 2010, figures 1 and 8, written once for all methods: the path tracer makes
//! rays, and whatever implements [`HostTracer`](metaball_core::HostTracer) answers them, or on wgpu
//! `metaball_core::gpu::RayTracer`. Neither knows more of the other. [`Effects`] say how a picture is lit,
//! and [`cpu::PathTracer`] draws rows of it in linear light.
//!
//! ```
//! use fbvh::{Options, Tracer, Tree};
//! use metaball_core::{Camera, Kernel, Metaball, NO_LIMIT, Scene, View};
//! use metaball_light::{Effects, Film, Occlusion, cpu::PathTracer};
//!
//! let balls = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]].map(|center| Metaball::new(center.into(), 1.0));
//! let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
//! let tree = Tree::build(&scene, &Options::certified())?;
//! let tracer = Tracer::new(&tree, &scene);
//!
//! let view = View::new(Camera::framing(&scene.bounds(), [0.0, 1.0, 2.0].into()), 64, 48)?;
//! let mut effects = Effects::phong(view.camera());
//! effects.occlusion = Some(Occlusion { rays: 4, reach: NO_LIMIT });
//!
//! let (samples, seed) = (16, 0);
//! let picture = PathTracer::new(&tracer, &scene, &view, &effects, samples, seed)?;
//! let rows = picture.rows(0..48);
//! println!("{} rays to the surroundings", rows.rays.shadows);
//! let image = Film { width: 64, height: 48, light: rows.light }.develop(0.0);
//! # assert!(rows.rays.shadows > 1000 && image.rgba.len() == 4 * 64 * 48);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Theory
//! *One path a pixel.* A sample of the picture follows one path of light backwards from the eye. Paths
//! take their steps together, as a wave: the method answers a batch of rays, and what they find makes the
//! next batch. At each surface point a path sends a shadow ray to each lamp that casts shadows, and its
//! occlusion rays. They query any hit, and bring their light if there is none.
//!
//! *Surfaces* ([`Surface`]). An opaque surface has Phong's model, lit by lamps and by the environment, and may
//! mirror by Schlick's approximation. A clear fluid reflects and refracts by Fresnel's equations and absorbs
//! light along the way (Beer and Lambert). A path does not branch: it takes one of the two at random, with
//! that one's share of the light as probability. A see-through surface is lit as an opaque one, by its share,
//! and the path goes straight on with the rest, layer by layer.
//!
//! *Sampling.* Points in the pixel, on a lamp and in the sky are those of Roberts' low-discrepancy sequence R2,
//! shifted by a hash of pixel, purpose and seed. The same seed gives the same picture.
//!
//! *The floor* ([`Floor`]) is the path tracer's own: a path meets it where it is nearer than the method's hit.
//! No method knows of it.
//!
//! *Secondary rays* start off the surface by the clearance that the method reports with its answer
//! ([`PackedHit::clearance`](metaball_core::PackedHit::clearance)): a bound of its error, valid at any scale, in
//! place of a tuned epsilon.
//!
//! # Practice
//! *On the CPU* a wave holds the paths of a tile of pixels; shadow and occlusion rays of all its surfaces go
//! together, in the order of their directions, so that a tracer can take neighbours in packets. A picture is
//! the same byte for byte whatever the machine, its threads and its vectors.
//!
//! *On wgpu* (feature `gpu`) a wave holds the paths of all pixels, and a surface's shadow and occlusion rays
//! follow one after another; passes run along a list of the pixels whose rays have a query, so that pixels
//! whose paths have ended cost nothing. Effects that [end at the first
//! surface](Effects::end_at_first_surface) take the hits of a method's own frame, so every method can be lit
//! that far. All others need a method whose tracer answers their queries, and are an error without.
//!
//! See-through surfaces are on the CPU alone.
//!
//! Each effect is a file of its own below `cpu`, and its twin in `shaders/wgsl/light`: `phong`, `lamps`,
//! `occlusion`, `mirror`, `fluid`, `floor` and `environment`. Tests hold the two together: the answers to the
//! rays that the passes made, and whole pictures.

pub mod cpu;
mod depth_cue;
mod effects;
mod error;
mod film;
#[cfg(feature = "gpu")]
pub mod gpu;
mod panorama;
mod path;

pub use depth_cue::DepthCue;
pub use effects::{Effects, Environment, Floor, Lamp, Occlusion, Surface};
pub use error::UnansweredError;
pub use film::{Film, develop};
pub use panorama::{Panorama, PanoramaError};
