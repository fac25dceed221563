//! Pictures, hits and animations of the smooth surface that particles imply, traced on whatever the
//! machine has: with the feature `gpu` a graphics adapter, or else the CPU.
//!
//! ```
//! use metaball::{Backend, DrawOptions, Overrides, ReadOptions, draw, load};
//!
//! # let folder = tempfile::tempdir()?;
//! # let file = folder.path().join("water.xyz");
//! # std::fs::write(&file, "3\nwater\nO 0 0 0.12\nH 0 0.76 -0.48\nH 0 -0.76 -0.48\n")?;
//! let water = load(file, &ReadOptions::default(), &Overrides::default())?;
//! let options = DrawOptions { size: (160, 120), backend: Backend::Cpu, ..DrawOptions::default() };
//! let drawing = draw(&water.scene, &water.camera, &options)?;
//! println!("{} of {} rays hit", drawing.hit_count(), drawing.hits.len());
//! # assert!(drawing.hit_count() > 1000);
//! # let (image, hits) = (folder.path().join("water.png"), folder.path().join("water.exr"));
//! drawing.save_image(&image)?;
//! drawing.save_hits(&hits)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`load`] reads a particle file; any [`Scene`] and [`Camera`] will do instead.
//! - [`draw()`] draws one picture, as [`DrawOptions`] say: [size](DrawOptions::size), another
//!   [`Viewpoint`], [what it shows](DrawOptions::picture), [what is cut away](Clip), [`LightOptions`],
//!   [which method](Method) and [what computes](Backend). All of them have defaults. The result is a
//!   [`Drawing`]: the image, and distance, normal and verdict of every ray.
//! - [`draw_to_files`] draws it to files band by band, so that it may be of any size, and goes on with one
//!   that was interrupted. It writes over none of its own [inputs](Outputs::inputs), which [`inputs()`] finds.
//! - A [`Model`] is a scene that is built once, and drawn and traced again and again, as a window does.
//! - `animate` draws the frames of an [`AnimatedScene`], such as a [`Sequence`] of numbered files,
//!   while the structure of the next one is built (feature `gpu`).
//!
//! The methods are the trees of the crate [`fbvh`]; the certified one, which is the default, answers no ray
//! wrongly.
//!
//! # Features
//! Without features the CPU draws, and nothing needs a graphics library. `gpu` adds graphics adapters and
//! animations; `harness` adds every other method, and a choice among all of them by measurement.

#[cfg(feature = "gpu")]
mod adapter;
#[cfg(feature = "gpu")]
mod animate;
mod backend;
mod band;
mod convert;
mod cpu;
mod cpu_alone;
mod draw;
mod emptiness;
mod error;
mod files;
mod inputs;
mod interruptible;
mod legend;
mod light;
mod method;
mod model;
mod spool;
mod summary;
mod trouble;
mod viewpoint;

#[cfg(feature = "gpu")]
pub use animate::{
    AnimateOptions, AnimationEvent, AnimationReport, FrameOutcome, FrameReport, FrameTimes, Keep,
    animate,
};
pub use backend::Backend;
pub use convert::convert_file;
pub use draw::{DrawOptions, Drawing, draw};
pub use emptiness::Emptiness;
pub use error::Error;
pub use files::{Outputs, draw_to_files};
pub use legend::{legend_svg, save_legend};
pub use light::{FloorKind, LightOptions};
#[cfg(feature = "gpu")]
pub use metaball_core::gpu::AdapterChoice;
pub use metaball_core::{
    Aabb, Camera, Clip, ClipError, Hit, Image, Picture, Scene, Verdict, View, WorkKind,
};
#[cfg(feature = "harness")]
pub use method::Choosing;
pub use method::Method;
pub use model::{Model, Shown, Solid};
pub use particle_files::{
    AnimatedScene, BoxError, Cell, ColorBy, Formula, FormulaOptions, Legend, Loaded, Note,
    NoteKind, Notes, NumberedPath, Overrides, Preset, ReadOptions, Rule, Scale, Selection,
    Sequence, Substance, Unit, inputs, load, load_bytes,
};
pub use summary::{Progress, Stage, Summary, Tally};
pub use trouble::is_trouble;
pub use viewpoint::Viewpoint;
