//! What replaces a scene's own kernel, threshold and colours.

use metaball_core::{Color, Kernel, KernelNameError, Scene};

use crate::error::LoadError;
use crate::options::parameter;

/// What replaces a scene's own choices; `None` keeps them. Support radii stay as they are.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overrides {
    /// Another kernel.
    pub kernel: Option<Kernel>,
    /// Another exponent, 1 to 8, for a scene (or a `kernel` above) of a power kernel.
    pub exponent: Option<i64>,
    /// Another threshold T.
    pub threshold: Option<f32>,
    /// One colour for all balls.
    pub color: Option<Color>,
}

impl Overrides {
    /// The kernel that replaces a scene's own, which is the same where nothing does.
    ///
    /// # Errors
    /// When kernel and exponent do not go together.
    pub(crate) fn kernel_for(&self, own: Kernel) -> Result<Kernel, LoadError> {
        match (self.kernel.unwrap_or(own), self.exponent) {
            (kernel, None) => Ok(kernel),
            (Kernel::Power(_), Some(exponent)) => kernel_named("power", Some(exponent)),
            (kernel, exponent) => kernel_named(&kernel.to_string(), exponent),
        }
    }

    /// The scene with its own choices replaced.
    ///
    /// # Errors
    /// When kernel and exponent do not go together, or the threshold is not a finite number above 0.
    pub fn apply(&self, scene: Scene) -> Result<Scene, LoadError> {
        let kernel = self.kernel_for(scene.kernel())?;
        let threshold = self.threshold.unwrap_or(scene.threshold());
        let count = scene.len();
        let scene = scene.with_kernel(kernel).with_threshold(threshold)?;
        match self.color {
            Some(color) => Ok(scene.with_colors(vec![color; count])?),
            None => Ok(scene),
        }
    }
}

/// The kernel of a name in scene files and commands, one of [`Kernel::NAMES`]; `power` and `quartic` may
/// have an exponent beside them.
///
/// # Errors
/// When there is no such kernel, or it does not go with the exponent.
pub fn kernel_named(name: &str, exponent: Option<i64>) -> Result<Kernel, LoadError> {
    let kernel: Kernel = name.parse().map_err(|error: KernelNameError| {
        parameter("kernel", Kernel::NAMES, format_args!("{:?}", error.found))
    })?;
    let is_open = matches!(name, "power" | "quartic");
    match (kernel, exponent) {
        (kernel, None) => Ok(kernel),
        (Kernel::Power(own), Some(exponent)) if is_open || i64::from(own.get()) == exponent => {
            Kernel::power(exponent).map_err(|error| {
                parameter("kernel exponent", "an integer from 1 to 8", error.found)
            })
        }
        _ => Err(parameter("kernel exponent", "the kernel power", format_args!("{name:?}"))),
    }
}
