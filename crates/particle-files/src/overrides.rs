//! What replaces a scene's own kernel, threshold and colours.

use metaball_core::{Color, Kernel, Scene};

use crate::error::LoadError;

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
    /// The scene with its own choices replaced.
    ///
    /// # Errors
    /// When kernel and exponent do not go together, or the threshold is not a finite number above 0.
    pub fn apply(&self, scene: Scene) -> Result<Scene, LoadError> {
        let kernel = self.kernel.unwrap_or(scene.kernel());
        let kernel = match (kernel, self.exponent) {
            (Kernel::Power(_), Some(exponent)) => kernel_named("power", Some(exponent))?,
            (_, exponent) => kernel_named(&kernel.to_string(), exponent)?,
        };
        let threshold = self.threshold.unwrap_or(scene.threshold());
        let count = scene.len();
        let scene = scene.with_kernel(kernel).with_threshold(threshold)?;
        match self.color {
            Some(color) => Ok(scene.with_colors(vec![color; count])?),
            None => Ok(scene),
        }
    }
}

/// The kernel of a name in scene files and commands: `power` (with an exponent, else 2), `power-1` to
/// `power-8`, `wyvill`, `perlin`.
///
/// # Errors
/// When there is no such kernel, or it does not go with the exponent.
pub fn kernel_named(name: &str, exponent: Option<i64>) -> Result<Kernel, LoadError> {
    let parameter = |name: &str, needed: &str, found: String| LoadError::Parameter {
        name: name.to_owned(),
        needed: needed.to_owned(),
        found,
    };
    let named = match name {
        "power" => Some(Kernel::QUARTIC),
        _ => Kernel::all().find(|kernel| kernel.to_string() == name),
    };
    match (named, exponent) {
        (Some(Kernel::Power(own)), Some(exponent))
            if name == "power" || i64::from(own.get()) == exponent =>
        {
            Kernel::power(exponent).map_err(|error| {
                parameter("kernel exponent", "an integer from 1 to 8", error.found.to_string())
            })
        }
        (Some(_), Some(_)) => {
            Err(parameter("kernel exponent", "the kernel power", format!("{name:?}")))
        }
        (Some(kernel), None) => Ok(kernel),
        (None, _) => {
            let needed = "power, power-1 to power-8, wyvill or perlin";
            Err(parameter("kernel", needed, format!("{name:?}")))
        }
    }
}
