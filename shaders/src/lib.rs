//! The WGSL modules of the metaball ray casters, and their composition into naga modules. No GPU API.
//!
//! The files under `wgsl/` are WGSL with one directive of naga_oil: `#import` takes a module, or items of
//! it. A module's import path is its file's path, so `core/view.wgsl` is imported as `core::view`. There
//! is no `#ifdef` and no template. Numbers vary by `override` constants with an `@id`, since composition
//! changes names; ids below 16 belong to the shared modules. Code varies by *interfaces*: a folder of
//! modules that all declare the same ([`INTERFACES`]) and are imported by the folder's path. A [`Variant`]
//! chooses one of them.
//!
//! What no entry point reaches is left out: a binding that a variant does not use does not exist.
//!
//! naga_oil requires that names in imported modules neither end in a digit nor be keywords of another
//! shading language.
//!
//! ```
//! use metaball_shaders::{KernelModule, Variant, compose};
//!
//! let variant = Variant {
//!     kernel: KernelModule::Power,
//!     radii: false,
//!     strengths: false,
//!     colors: false,
//!     counting: false,
//!     chosen: &["opaque/none"],
//! };
//! let rays = compose("core/rays", &variant)?;
//! assert_eq!(rays.entry_points[0].name, "make_rays");
//! # Ok::<(), metaball_shaders::ComposeError>(())
//! ```

mod compose;
mod interfaces;
mod layout;
mod modules;
mod size;
mod variant;

pub use compose::{ComposeError, compose, compose_module};
pub use interfaces::{INTERFACES, Interface};
pub use layout::{StructLayout, struct_layout};
pub use modules::{MODULES, Module};
pub use naga;
pub use size::code_size;
pub use variant::{KernelModule, Variant};
