//! Shadows, ambient occlusion, reflection and refraction for metaballs, by a path tracer on wgpu.
//!
//! The effects of Gourmel et al. 2010, figures 1 and 8, written once for all methods: the path tracer makes
//! batches of rays, and whatever implements [`RayTracer`](metaball_core::gpu::RayTracer) answers them. Neither
//! knows more of the other. [`Effects`] say how a picture is lit, a [`PathTracer`] adds samples of it, and the
//! result is a [`Film`] of linear light.
//!
//! ```no_run
//! use metaball_core::gpu::{Gpu, IsoRenderer, RenderError};
//! use metaball_core::{Image, NO_LIMIT, Scene, View};
//! use metaball_light::{Effects, Occlusion, PathTracer};
//!
//! /// A picture with soft occlusion. `renderer` has built `scene`.
//! fn picture(
//!     gpu: &Gpu,
//!     renderer: &mut dyn IsoRenderer,
//!     scene: &Scene,
//!     view: &View,
//! ) -> Result<Image, RenderError> {
//!     let mut effects = Effects::phong(view.camera());
//!     effects.occlusion = Some(Occlusion { rays: 4, reach: NO_LIMIT });
//!
//!     let (samples, seed) = (16, 0);
//!     let mut tracer = PathTracer::new(gpu, scene, view, effects, samples, seed)?;
//!     for _ in 0..samples {
//!         tracer.add_sample(renderer)?;
//!     }
//!     Ok(tracer.film()?.develop(0.0))
//! }
//! ```
//!
//! # Theory
//! *One path a pixel.* A sample of the picture follows one path of light backwards from the eye. All pixels
//! take a step together, as a wave: the method answers a batch of one ray a pixel, and a pass takes the answers
//! and makes the next batch. Both run along a list of the pixels whose rays have a query, so that pixels whose
//! paths have ended cost nothing. At each surface point a path sends a shadow ray to each lamp that casts
//! shadows, and its occlusion rays, one after another. They query any hit, and bring their light if there is
//! none.
//!
//! *Surfaces* ([`Surface`]). An opaque surface has Phong's model, lit by lamps and by the environment, and may
//! mirror by Schlick's approximation. A clear fluid reflects and refracts by Fresnel's equations and absorbs
//! light along the way (Beer and Lambert). A path does not branch: it takes one of the two at random, with
//! that one's share of the light as probability.
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
//! Effects that [end at the first surface](Effects::end_at_first_surface) take the hits of a method's own
//! frame, so every method can be lit that far. All others need a method with a
//! [`RayTracer`](metaball_core::gpu::RayTracer) that answers their queries, and are an error without.
//!
//! `path_tracer` holds the state of a picture, `waves` the sequence of batches and passes, `passes` the
//! pipelines, `buffers` what they bind, and `twins` the structs that they share with `shaders/wgsl/light`. There
//! each effect is a file of its own: `phong`, `lamps`, `occlusion`, `mirror`, `fluid`, `floor` and `environment`.

mod buffers;
mod depth_cue;
mod effects;
mod film;
mod panorama;
mod passes;
mod path_tracer;
mod sampling;
mod twins;
mod waves;

pub use effects::{Effects, Environment, Floor, Lamp, Occlusion, Surface};
pub use film::Film;
pub use panorama::{Panorama, PanoramaError};
pub use path_tracer::PathTracer;
