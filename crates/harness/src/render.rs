//! The command `render`: one picture by one method.

use std::path::PathBuf;

use bench_scenes::{Overrides, load};
use metaball_core::View;
use metaball_core::gpu::{self, AdapterChoice, Gpu, Picture, Shading, Targets};

use crate::console;
use crate::hits_exr::write_hits;
use crate::measure::milliseconds;
use crate::methods::Method;
use crate::numbers::{decimal, grouped};
use crate::output::write_atomically;
use crate::picture::encode_png;

/// What to draw, how, and where to.
#[derive(Debug, Clone)]
pub struct Order {
    /// Name, generator or file.
    pub scene: String,
    /// What to change about the scene.
    pub overrides: Overrides,
    /// Who draws.
    pub method: &'static Method,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// What the picture shows.
    pub picture: Picture,
    /// What to draw with.
    pub adapter: AdapterChoice,
    /// Where the PNG goes.
    pub out: PathBuf,
    /// Where the hits go, if anywhere.
    pub hits: Option<PathBuf>,
}

/// Draws, writes the files, and says what it used. The time is that of a second frame, since shaders
/// are compiled with the first.
///
/// # Errors
/// When the scene does not load, the method cannot draw it, or a file cannot be written.
pub fn render(order: &Order) -> anyhow::Result<()> {
    let bench = load(&order.scene, &order.overrides)?;
    let scene = &bench.scene;
    let gpu = Gpu::new(&order.adapter)?;
    let (width, height) = order.size;
    let view = View::new(bench.camera, width, height)?;
    let colors = scene.colors().is_some();
    let counting = matches!(order.picture, Picture::Work(_));
    let targets = Targets::new(&gpu, width, height, colors, counting)?;

    let mut renderer = (order.method.make)(counting);
    let build = renderer.build(&gpu, scene)?;
    gpu::render(&gpu, renderer.as_mut(), &targets, &view)?;
    let frame = gpu::render(&gpu, renderer.as_mut(), &targets, &view)?;
    let hits = targets.read_hits(&gpu)?;
    let shaded = Shading::new(&gpu).draw(&targets, &view, scene, order.picture)?;
    write_atomically(&order.out, &encode_png(&shaded.image)?)?;
    if let Some(path) = &order.hits {
        write_hits(path, width, height, &hits)?;
    }

    let balls = format!("{} of kernel {}", grouped(scene.len()), scene.kernel());
    let hit_count = hits.iter().filter(|hit| hit.is_hit()).count();
    let facts = [
        ("scene", bench.name.clone()),
        ("balls", balls),
        ("threshold", scene.threshold().to_string()),
        ("method", format!("{} ({})", order.method.name, order.method.paper)),
        ("adapter", format!("{} ({})", gpu.report().name, gpu.report().driver)),
        ("build", format!("{} ms", decimal(milliseconds(build.structure + build.pipelines)))),
        ("frame", format!("{} ms", decimal(milliseconds(frame.wall)))),
        ("hits", format!("{} of {} rays", grouped(hit_count), grouped(hits.len()))),
        ("picture", order.out.display().to_string()),
    ];
    for (name, value) in facts {
        console::line(&format!("{name:<10} {value}"));
    }
    if let Some(range) = shaded.range {
        console::line(&format!("{:<10} {} to {}", "scale", range.low, range.high));
    }
    if let Some(path) = &order.hits {
        console::line(&format!("{:<10} {}", "hits file", path.display()));
    }
    Ok(())
}
