//! Light: what only ray tracing gives a picture of metaballs.
//!
//! Gourmel et al. 2010 built a structure that answers arbitrary rays for the sake of the effects of
//! their figures 1 and 8: hard and soft shadows, ambient occlusion, mirrors to any depth, refraction.
//! Here the effects exist once, outside the methods. They ask whatever implements
//! [`RayTracer`](metaball_core::gpu::RayTracer), and know nothing else of it.
//!
//! # Theory
//! *One path a pixel.* A sample of the picture follows one path of light backwards from the eye. All
//! pixels take a step together: a batch of one ray a pixel is answered, a pass takes up the answers
//! and makes the next batch, both along a list of those that ask anything. So a method's shader never holds an effect, and an effect's never a tree.
//! A surface point sends *feelers*, which ask for any hit: one for each light that casts shadows, and
//! one for each occlusion ray. What a feeler would bring arrives if it meets nothing.
//!
//! *Surfaces* ([`Surface`]). An opaque one has Phong's model, lit by lamps and by the surroundings, and
//! may mirror: Schlick's approximation gives the share. A clear fluid reflects and refracts by Fresnel's
//! equations and takes up light along the way (Beer and Lambert). Which of the two a sample follows is
//! chosen as often as it has of the light, so that a path does not branch.
//!
//! *Sampling.* Points in the pixel, on a lamp and in the sky are those of Roberts' low-discrepancy
//! sequence R2, shifted by a hash of pixel, purpose and seed: deterministic, and even at any number of
//! samples.
//!
//! *The floor* ([`Floor`]) is the effects' own: paths meet it where it is nearer than the method's hit, and
//! rays that ask a method never do.
//!
//! *Leaving a surface.* A ray starts beside the point that the last one found, off by the clearance that
//! the method gives with its answer ([`PackedHit::clearance`](metaball_core::PackedHit::clearance)): an
//! error bound, not a tuned epsilon, at any scale.
//!
//! # Practice
//! [`PathTracer::new`] prepares a view with its [`Effects`], [`PathTracer::add_sample`] adds a sample, and
//! [`PathTracer::film`] is the picture so far in linear light.

mod buffers;
mod depth_cue;
mod effects;
mod film;
mod passes;
mod path_tracer;
mod sampling;
mod twins;
mod waves;

pub use effects::{Effects, Environment, Floor, Lamp, Occlusion, Panorama, PanoramaError, Surface};
pub use film::Film;
pub use path_tracer::PathTracer;
