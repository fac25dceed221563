//! The cubic's own error, kernel by kernel: the published cubic and the exact polynomial against the
//! reference.

use bench_scenes::{Overrides, load};
use illes_fraglist::{Options, Piece, Renderer, cubic_deviation};
use metaball_core::gpu::{Gpu, Targets};
use metaball_core::reference::Oracle;
use metaball_core::{Kernel, View};
use serde::{Deserialize, Serialize};

use harness::canvas::Canvas;
use harness::measure::PreparedRenderer;
use harness::reference::Reference;
use harness::renderer;
use harness::score::{Accuracy, score};

/// A kernel's row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KernelRow {
    /// Name of the kernel.
    pub kernel: String,
    /// Bounds on kernel minus cubic along any chord, in parts of the ball's value at its midpoint.
    pub deviation: (f64, f64),
    /// The published cubic, made anew for each piece, against the reference.
    pub cubic: Picture,
    /// The exact polynomial against it.
    pub exact: Picture,
}

/// A picture, compared; or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Picture {
    /// Drawn and compared.
    Compared(Accuracy),
    /// Not drawn, and why.
    Refused(String),
}

/// The paper's two kernels, and powers from the linear one to one whose polynomial is of degree eight.
pub fn kernels() -> Vec<Kernel> {
    let powers = (1..=4).filter_map(|exponent| Kernel::power(exponent).ok());
    [Kernel::Wyvill, Kernel::Perlin].into_iter().chain(powers).collect()
}

/// Draws a scene with a kernel instead of its own, and compares every pixel.
///
/// # Errors
/// When the scene does not load, or the adapter fails.
pub fn compare(
    gpu: &Gpu,
    spec: &str,
    kernel: Kernel,
    size: (u32, u32),
) -> anyhow::Result<KernelRow> {
    let bench = load(spec, &Overrides { kernel: Some(kernel), ..Overrides::default() })?;
    let view = View::new(bench.camera, size.0, size.1)?;
    let targets = Targets::new(gpu, size.0, size.1, false, false)?;
    let canvas = Canvas::on_adapter(gpu, &targets);
    let rays = canvas.rays(&view)?;
    let reference = Reference::of_every_pixel(size, Oracle::new(&bench.scene).first_hits(&rays));
    let picture = |name, piece| -> anyhow::Result<Picture> {
        let options = Options { piece, ..Options::default() };
        let renderer = renderer::Renderer::Adapter(Box::new(Renderer::new(name, options, false)));
        Ok(match PreparedRenderer::prepare(canvas, renderer, &bench.scene, &view) {
            Ok(renderer) => Picture::Compared(score(&reference, &renderer.hits)?),
            Err(error) => Picture::Refused(error.to_string()),
        })
    };
    let bounds = cubic_deviation(kernel);
    Ok(KernelRow {
        kernel: kernel.to_string(),
        deviation: (bounds.least, bounds.greatest),
        cubic: picture("illes-rebuilt", Piece::Rebuilt)?,
        exact: picture("illes-exact", Piece::Exact)?,
    })
}
