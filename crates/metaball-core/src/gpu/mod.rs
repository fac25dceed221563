//! Methods on the GPU: the trait that each implements, and what all of them share.
//!
//! A method is an [`IsoRenderer`]: it turns primary rays into hits and does nothing else. Rays, clocks,
//! counters, read-back and pictures are made here, the same for all, so that methods differ in nothing
//! but what their papers say.
//!
//! # Lifetimes
//! Each type says how often what it holds is made:
//!
//! | made once a | held by | cost |
//! | --- | --- | --- |
//! | process | [`Gpu`] | tens of milliseconds |
//! | scene and [`Specialization`] | the method, its pipelines and [`SceneBuffers`] | composing and compiling shaders, tens of milliseconds a pipeline, and the upload: 16 to 24 bytes a ball |
//! | image size | [`Targets`] | 32 bytes a pixel; 4 more with colours, 32 more with work counters |
//! | view | [`Frame`] | the pass `rays`, and what the method records |
//!
//! The rays of a view are made once a frame and read by every method, so that methods and reference
//! see the same rays bit for bit.
//!
//! # Bindings
//! Shaders are specialised: radii, strengths, colours and counters that a scene or a measurement does
//! not need are neither bound nor compiled in.
//!
//! | group | binding | holds | WGSL module |
//! | --- | --- | --- | --- |
//! | 0, the frame's ([`frame_layout`]) | 0 | view, uniform | `core::view` |
//! | | 1 | a ray a pixel, read | `core::view` |
//! | | 2 | a hit a pixel, written | `core::hit` |
//! | | 3 | status of the frame, written | `core::status` |
//! | | 4 | a blended colour a pixel, written; in scenes with colours | `color` |
//! | | 5 | work counters, written; while counting | `work` |
//! | 1, the scene's ([`scene_layout`]) | 0 | support spheres, read | `support` |
//! | | 1 | strengths, read; where they vary | `strength` |
//! | | 2 | the balls' colours, read; where there are any | `color` |
//! | | 3 | threshold and number of balls, uniform | `core::scene` |
//! | | 4 | the kernel, uniform; where it is not compiled in | `kernel` |
//! | from 2 on | | the method's own | |
//!
//! # Writing a method
//! A method can live in any crate that depends on this one. Its shader is a [`ShaderModule`] that imports
//! the modules of the table above; `crates/metaball-core/src/gpu/tests/sphere.rs` and
//! `crates/metaball-core/src/gpu/tests/sphere.wgsl` are a small one that reads balls, counts work and
//! grows. The method below reads nothing but rays: all its hits are at t = 1 and face the eye.
//!
//! ```
//! use metaball_core::gpu::*;
//! use metaball_core::Scene;
//!
//! const SHADER: ShaderModule = ShaderModule {
//!     name: "backdrop",
//!     source: "
//! #import core::hit::{write_hit, HIT}
//! #import core::view::{in_picture, pixel_at, rays}
//!
//! @compute @workgroup_size(8, 8)
//! fn trace(@builtin(global_invocation_id) invocation: vec3<u32>) {
//!     if in_picture(invocation.xy) {
//!         let pixel = pixel_at(invocation.xy);
//!         write_hit(pixel, 1.0, -rays[pixel].direction, HIT);
//!     }
//! }",
//!     is_entry: true,
//! };
//!
//! #[derive(Default)]
//! struct Backdrop {
//!     counting: bool,
//!     pipeline: Option<wgpu::ComputePipeline>,
//! }
//!
//! impl IsoRenderer for Backdrop {
//!     fn name(&self) -> &'static str {
//!         "backdrop"
//!     }
//!
//!     fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
//!         let spec = Specialization::of(scene, self.counting);
//!         let shader = Shader::of_module(gpu, &SHADER, &spec)?;
//!         let groups = [&frame_layout(gpu, &spec)];
//!         self.pipeline = Some(shader.compute(gpu, "trace", "trace", &spec, &groups, &[])?);
//!         Ok(BuildReport::default())
//!     }
//!
//!     fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
//!         let pipeline = self.pipeline.as_ref().ok_or(RenderError::NotBuilt { method: self.name() })?;
//!         let targets = frame.targets();
//!         let (across, down) = targets.workgroups();
//!         frame.compute("trace", |pass| {
//!             pass.set_pipeline(pipeline);
//!             pass.set_bind_group(0, targets.bind_group(), &[]);
//!             pass.dispatch_workgroups(across, down, 1);
//!         });
//!         Ok(())
//!     }
//! }
//! # let Some(gpu) = Gpu::for_test() else { return Ok(()) };
//! # let scene = Scene::new([], metaball_core::Kernel::QUARTIC, 0.5)?;
//! # let camera = metaball_core::Camera::framing(&scene.bounds(), glam::Vec3::Z);
//! # let view = metaball_core::View::new(camera, 16, 16)?;
//! # let targets = Targets::new(&gpu, 16, 16, false, false)?;
//! # let mut method = Backdrop::default();
//! # method.build(&gpu, &scene)?;
//! # render(&gpu, &mut method, &targets, &view)?;
//! # assert!(targets.read_hits(&gpu)?.iter().all(|hit| hit.t == 1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`name`](IsoRenderer::name) stands in tables and file names, and stays as it is.
//! - [`build`](IsoRenderer::build) makes all that depends on the scene: [`Specialization::of`] says what
//!   shaders are made for, [`Shader`] composes and compiles them, [`SceneBuffers`] is group 1 of whoever
//!   reads balls, [`Gpu::upload`] and [`Gpu::storage`] make buffers of the method's own, bound by
//!   [`bind_group_layout`] and [`bind_group`]. The same specialisation needs no new pipelines. Override
//!   constants of the method have ids from 16 on.
//! - [`encode`](IsoRenderer::encode) records passes, each under a label, by [`Frame::compute`] and
//!   [`Frame::render`]; work on the host belongs in [`Frame::cpu`]. Every pixel gets a hit
//!   (`write_miss`; `write_hit` with the status HIT, INSIDE or UNDECIDED, plus FALLBACK where a published rule
//!   for trouble made it) or `report_unfinished`. A pixel that nothing writes reads as undecided. In scenes
//!   with colours `blend_start`, `blend_add` and `blend_write` write the hit's colour.
//! - A pool, list or limit that was too small for a frame is reported by `report_needed(slot, capacity)`;
//!   [`grow`](IsoRenderer::grow) enlarges it, and [`render`] draws the frame again.
//! - `count_balls`, `count_evaluations` and their like count [`Work`](crate::Work), and `write_work(pixel)`
//!   stores it. Without [`Specialization::counting`] they compile to nothing, so that they stand in every shader.
//! - What tables print of a scene are the facts of [`BuildReport`], of a frame
//!   [`frame_facts`](IsoRenderer::frame_facts); memory is in [`BuildReport::device_bytes`] and
//!   [`frame_bytes`](IsoRenderer::frame_bytes).
//!
//! A method never makes or changes rays, shades, or measures time; it never submits, waits or reads back
//! in `encode`; and it writes the buffers of groups 0 and 1 through these functions alone.
//!
//! # Free rays
//! A method that traces any ray returns a [`RayTracer`] from [`IsoRenderer::ray_tracer`]. It answers the
//! queries of a [`RayBatch`]: one ray a pixel, each with a start of its own. Its shaders differ only in the
//! module that provides rays, `ray/primary` or `ray/free` (as [`Specialization::choosing`] has it), so that
//! primary rays pay nothing for it. Free rays are traced along a list of those that have the query
//! ([`RayBatch::encode_list`]), as after a few bounces few do.
//!
//! # Incomplete frames and fallbacks
//! *Incomplete*: a capacity was too small for this frame. Shaders count the rays without a final answer
//! and report the capacity that they needed ([`FrameStatus`]). An incomplete frame is never shown,
//! compared or timed: [`render`] returns a complete one or [`RenderError::Incomplete`].
//!
//! *Fallback*: at some pixels the method applied a rule that its paper publishes for trouble. That is
//! part of the method: such a hit is marked ([`Hit::fallback`](crate::Hit)), counted, shown and timed
//! with the rest.
//!
//! # Errors
//! What wgpu refuses, a lack of memory and a lost device are returned as a [`RenderError`] by the
//! function that submitted the work; wgpu's own handler, which panics, is replaced. A frame's passes
//! are checked when it is submitted.

mod adapter;
mod batch;
mod clock;
mod device;
mod error;
mod frame;
mod free_ray;
mod layout;
mod pipeline;
mod queried_rays;
mod raster;
mod ray_list;
mod ray_tracer;
mod rays;
mod renderer;
mod scene_buffers;
mod shade;
mod shader_checks;
mod spheres;
mod status;
mod targets;
#[cfg(test)]
mod tests;
mod tile_bins;

pub use adapter::{AdapterChoice, AdapterReport, GpuError};
pub use batch::RayBatch;
pub use device::Gpu;
pub use error::RenderError;
pub use frame::{Frame, FrameReport, RenderAttachments};
pub use free_ray::FreeRay;
pub use layout::{Binding, Resource, bind_group, bind_group_layout};
pub use pipeline::{Shader, Specialization, compute_pipeline, pipeline_layout, workgroup_grid};
pub use raster::{DepthTest, RasterDescriptor, TRIANGLE_STRIP};
pub use ray_list::RayList;
pub use ray_tracer::RayTracer;
pub use rays::PackedRay;
pub use renderer::{BuildReport, IsoRenderer, render, render_with};
pub use scene_buffers::{KernelRead, SceneBuffers, SceneHeader, scene_layout};
pub use shade::Shading;
pub use shader_checks::ShaderChecks;
pub use status::FrameStatus;
pub use targets::{TILE, Targets, ViewUniform, frame_layout, free_ray_layout};
pub use tile_bins::{TileBinning, TileBins};

/// A WGSL file of a method.
pub use metaball_shaders::Module as ShaderModule;
/// The version of wgpu that this crate is built on.
pub use wgpu;
