//! The shared part on an adapter, with a renderer that needs no structure: one sphere.

mod evaluate;
mod frames;
mod layouts;
mod pictures;
mod rays;
mod scene_buffers;
mod sphere;
