//! The WGSL modules of the metaball ray casters, and their composition into naga modules. No GPU API.
//!
//! The files under `wgsl/` are WGSL with two directives of naga_oil: `#define_import_path` names a
//! module for others, `#import` takes it or items of it. There is no `#ifdef` and no template.
//! Numbers vary by `override` constants with an `@id`, since composition changes names; ids below 16
//! belong to the shared modules. Code varies by modules with the same import path and the same
//! functions, one of which a [`Variant`] chooses:
//!
//! | import path | modules | chosen by |
//! | --- | --- | --- |
//! | `metaball::kernel` | `kernel/power`, `kernel/wyvill`, `kernel/perlin`, `kernel/any` | [`Variant::kernel`] |
//! | `metaball::exponent` | `exponent/compiled`, `exponent/read` | [`Variant::kernel`] |
//! | `metaball::support` | `support/uniform`, `support/varied` | [`Variant::radii`] |
//! | `metaball::strength` | `strength/unit`, `strength/varied` | [`Variant::strengths`] |
//! | `metaball::color` | `color/none`, `color/blended` | [`Variant::colors`] |
//! | `metaball::base` | `shade/base_white`, `shade/base_blended` | [`Variant::colors`] |
//! | `metaball::work` | `work/off`, `work/counted` | [`Variant::counting`] |
//! | others | such as `opaque/none`, `opaque/image` | [`Variant::chosen`] |
//!
//! What no entry point reaches is left out: a binding that a variant does not use does not exist.
//!
//! naga_oil asks that names in imported modules neither end in a digit nor be keywords of another
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
mod layout;
mod modules;
mod size;
mod variant;

pub use compose::{ComposeError, compose, compose_module};
pub use layout::{StructLayout, struct_layout};
pub use modules::{MODULES, Module};
pub use naga;
pub use size::code_size;
pub use variant::{KernelModule, Variant};
