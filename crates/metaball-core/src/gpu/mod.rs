//! Methods on the GPU: what they share, and the one trait they implement.
//!
//! A method is an [`IsoRenderer`]: it turns rays into hits and does nothing else. Rays, clocks,
//! counters, read-back and pictures are here, the same for all, so that methods differ in nothing but
//! what their papers say.
//!
//! # How long things live
//! What is made is held by a type that says how often it is made:
//!
//! | made once a | held by | cost |
//! | --- | --- | --- |
//! | process | [`Gpu`] | tens of milliseconds |
//! | scene and [`Specialization`] | the method, its pipelines and [`SceneBuffers`] | composing and compiling shaders, tens of milliseconds a pipeline, and the upload: 16 to 24 bytes a ball |
//! | image size | [`Targets`] | 32 bytes a pixel; 4 more with colours, 28 more with work counters |
//! | view | [`Frame`] | the pass `rays`, and what the method records |
//!
//! Shaders are specialised: radii, strengths, colours and counters that a scene or a measurement has
//! no use for are neither bound nor compiled in. The rays of a view are made once a frame and read by every
//! method, so methods and reference see the same ray bit for bit.
//!
//! # Groups
//! Group 0 is the frame's ([`frame_layout`]): view, rays, hits, status, and where they exist colours
//! and work. Group 1 is the scene's ([`scene_layout`]). Groups from 2 on are the method's own. The
//! WGSL side of both is in the modules `core`, `kernel`, `support`, `strength`, `color` and `work` of
//! `metaball-shaders`. A pass over the picture has [`Targets::workgroups`] of [`TILE`]² invocations.
//!
//! # Other rays
//! What a method promises is first hits of primary rays. A method that can follow any ray says so with
//! [`IsoRenderer::ray_tracer`]: it answers the questions of a [`RayBatch`], one ray a pixel, each with a
//! start of its own. Its shaders are the same but for the module that hands out rays
//! (`ray/primary.wgsl`, `ray/free.wgsl`), so that primary rays pay nothing for it. Free rays are handed out
//! along a list of those that ask ([`RayBatch::encode_list`]): after a few bounces they are few and far
//! between.
//!
//! # Two kinds of trouble
//! *Incomplete*: a pool, list or pass limit was too small for this frame. Shaders count the rays that
//! have no final answer, and say how much room they would have needed ([`FrameStatus`]);
//! [`IsoRenderer::grow`] makes the room and [`render`] does the frame again. An incomplete frame is
//! never shown, compared or timed: either a whole one comes out, or [`RenderError::Incomplete`].
//!
//! *Fallback*: at some pixels the method applied a rule that its paper publishes for trouble. That is
//! the method, not a failure of it: such a hit is marked ([`Hit::fallback`](crate::Hit)), counted,
//! shown and timed with the rest.
//!
//! # Errors
//! What wgpu refuses, a lack of memory and a lost device come back as a [`RenderError`] from the
//! function that asked for the work; wgpu's own handler, which panics, is replaced. A frame's passes
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
mod ray_list;
mod ray_tracer;
mod rays;
mod renderer;
mod scene_buffers;
mod shade;
mod spheres;
mod targets;
#[cfg(test)]
mod tests;

pub use adapter::{AdapterChoice, AdapterReport, GpuError};
pub use batch::RayBatch;
pub use device::Gpu;
pub use error::RenderError;
pub use frame::{Frame, FrameReport, FrameStatus, RenderAttachments};
pub use free_ray::{FreeRay, RayQuery};
pub use layout::{Binding, Resource, group as bind_group, layout as bind_group_layout};
pub use pipeline::{Shader, Specialization, compute_pipeline, pipeline_layout};
pub use ray_tracer::RayTracer;
pub use rays::PackedRay;
pub use renderer::{BuildReport, IsoRenderer, render, render_with};
pub use scene_buffers::{KernelRead, SceneBuffers, SceneHeader, scene_layout};
pub use shade::Shading;
pub use targets::{TILE, Targets, ViewUniform, frame_layout, free_ray_layout};

pub use crate::{Image, Picture, Shaded, ValueRange, Work, WorkKind};
