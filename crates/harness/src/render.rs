//! The command `render`: one picture by one method.

use std::path::PathBuf;

use anyhow::ensure;
use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::gpu::{self, AdapterChoice, Gpu, GpuError, Picture, Shaded, Shading, Targets};
use metaball_core::{Hit, View};

use crate::hits_exr::write_hits;
use crate::light::{self, LightOptions};
use crate::measure::milliseconds;
use crate::methods::Method;
use crate::numbers::{decimal, grouped};
use crate::output::write_atomically;
use crate::picture::encode_png;
use crate::shade::{self, Look};
use crate::{console, cpu};

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
    /// Effects, in the place of the shared Phong picture.
    pub light: LightOptions,
    /// What to draw with.
    pub device: Device,
    /// Where the PNG goes.
    pub out: PathBuf,
    /// Where the hits go, if anywhere.
    pub hits: Option<PathBuf>,
}

/// What draws.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Device {
    /// A graphics adapter. Where the machine has none at all, and none was asked for by name, the
    /// CPU.
    Adapter(AdapterChoice),
    /// The CPU, without any graphics API.
    Cpu,
}

/// What was drawn.
struct Drawn {
    hits: Vec<Hit>,
    shaded: Shaded,
    build_ms: f64,
    frame_ms: f64,
    /// What the light took, where there are effects.
    light: Option<String>,
    device: String,
}

/// Draws, writes the files, and says what it used.
///
/// # Errors
/// When the scene does not load, the method cannot draw it, or a file cannot be written.
pub fn render(order: &Order) -> anyhow::Result<()> {
    let bench = load(&order.scene, &order.overrides)?;
    let scene = &bench.scene;
    let (width, height) = order.size;
    let view = View::new(bench.camera, width, height)?;
    let drawn = match open(&order.device)? {
        Some(gpu) => on_adapter(&gpu, order, &bench, &view)?,
        None => on_cpu(order, &bench, &view)?,
    };
    write_atomically(&order.out, &encode_png(&drawn.shaded.image)?)?;
    if let Some(path) = &order.hits {
        write_hits(path, width, height, &drawn.hits)?;
    }

    let balls = format!("{} of kernel {}", grouped(scene.len()), scene.kernel());
    let hit_count = drawn.hits.iter().filter(|hit| hit.is_hit()).count();
    let facts = [
        ("scene", bench.name.clone()),
        ("balls", balls),
        ("threshold", scene.threshold().to_string()),
        ("method", format!("{} ({})", order.method.name, order.method.paper)),
        ("adapter", drawn.device),
        ("build", format!("{} ms", decimal(drawn.build_ms))),
        ("frame", format!("{} ms", decimal(drawn.frame_ms))),
        ("hits", format!("{} of {} rays", grouped(hit_count), grouped(drawn.hits.len()))),
        ("picture", order.out.display().to_string()),
    ];
    for (name, value) in facts {
        console::line(&format!("{name:<10} {value}"));
    }
    if let Some(light) = &drawn.light {
        console::line(&format!("{:<10} {light}", "light"));
    }
    if let Some(range) = drawn.shaded.range {
        console::line(&format!("{:<10} {} to {}", "scale", range.low, range.high));
    }
    if let Some(path) = &order.hits {
        console::line(&format!("{:<10} {}", "hits file", path.display()));
    }
    Ok(())
}

/// The adapter; `None` when it is the CPU that draws.
fn open(device: &Device) -> anyhow::Result<Option<Gpu>> {
    let Device::Adapter(choice) = device else { return Ok(None) };
    match Gpu::new(choice) {
        Ok(gpu) => Ok(Some(gpu)),
        Err(GpuError::NoAdapter { choice, found })
            if found.is_empty() && !matches!(choice, AdapterChoice::Named(_)) =>
        {
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

/// The time is that of a second frame, since shaders are compiled with the first.
fn on_adapter(gpu: &Gpu, order: &Order, bench: &BenchScene, view: &View) -> anyhow::Result<Drawn> {
    let scene = &bench.scene;
    let colors = scene.colors().is_some();
    let counting = matches!(order.picture, Picture::Work(_));
    let targets = Targets::new(gpu, view.width(), view.height(), colors, counting)?;
    let mut renderer = (order.method.make)(counting);
    let build = renderer.build(gpu, scene)?;
    gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let frame = gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let hits = targets.read_hits(gpu)?;
    let (shaded, light) = if order.light.is_asked() {
        let lit = order.light.expose(gpu, renderer.as_mut(), bench, view, &hits)?;
        order.light.write_light(&lit.film)?;
        let image = lit.film.develop(order.light.stops());
        (Shaded { image, range: None }, Some(light::facts(&lit)))
    } else {
        (Shading::new(gpu).draw(&targets, view, scene, order.picture)?, None)
    };
    Ok(Drawn {
        hits,
        shaded,
        light,
        build_ms: milliseconds(build.structure),
        frame_ms: milliseconds(frame.wall),
        device: format!("{} ({})", gpu.report().name, gpu.report().driver),
    })
}

fn on_cpu(order: &Order, bench: &BenchScene, view: &View) -> anyhow::Result<Drawn> {
    ensure!(
        !order.light.is_asked(),
        "light needs a graphics adapter; the CPU shades phong, normal, depth and color"
    );
    let look = Look::of(order.picture)?;
    let traced = cpu::trace(order.method, &bench.scene, view)?;
    let device = match order.device {
        Device::Cpu => "none asked for: traced on the CPU",
        Device::Adapter(_) => "no graphics adapter: traced on the CPU",
    };
    Ok(Drawn {
        shaded: shade::draw(&bench.scene, view, &traced.rays, &traced.hits, look),
        hits: traced.hits,
        light: None,
        build_ms: milliseconds(traced.build),
        frame_ms: milliseconds(traced.frame),
        device: device.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::find;
    use crate::output::tests::scratch;

    #[test]
    fn the_cpu_writes_picture_and_hits() {
        let folder = scratch("render-cpu");
        let mut order = Order {
            scene: "colors-100".to_owned(),
            overrides: Overrides::default(),
            method: find("fbvh").expect("listed"),
            size: (16, 12),
            picture: Picture::Phong,
            light: LightOptions::default(),
            device: Device::Cpu,
            out: folder.join("image.png"),
            hits: Some(folder.join("hits.exr")),
        };
        render(&order).expect("drawn");
        assert!(order.out.is_file() && folder.join("hits.exr").is_file());
        order.picture = Picture::Spheres;
        assert!(render(&order).expect_err("refused").to_string().contains("graphics adapter"));
        std::fs::remove_dir_all(folder).expect("removable");
    }

    #[test]
    fn an_adapter_asked_for_by_name_is_not_replaced() {
        let device = Device::Adapter(AdapterChoice::Named("Voodoo".to_owned()));
        assert!(open(&device).expect_err("refused").to_string().contains("Voodoo"));
        assert!(open(&Device::Cpu).expect("nothing to open").is_none());
    }
}
