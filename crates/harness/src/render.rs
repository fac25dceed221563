//! The command `render`: one picture by one method.

use std::path::PathBuf;

use anyhow::{bail, ensure};
use bench_scenes::{BenchScene, Overrides, load};
use metaball_core::gpu::{
    self, AdapterChoice, BuildReport, Gpu, GpuError, IsoRenderer, Picture, RenderError, Shaded,
    Shading, Targets,
};
use metaball_core::{Hit, Scene, View};

use crate::auto::Auto;
use crate::auto::cache::Cache;
use crate::camera::CameraOptions;
use crate::console::Progress;
use crate::hits_exr::write_hits;
use crate::light::{self, LightOptions, Lit, write_light};
use crate::measure::milliseconds;
use crate::methods::Method;
use crate::numbers::{decimal, grouped};
use crate::output::write_atomically;
use crate::picture::encode_png;
use crate::settings::sweeps::candidates;
use crate::shade::{self, Look};
use crate::{console, cpu};

/// What to draw, how, and where to.
#[derive(Debug, Clone)]
pub struct Order {
    /// What to draw and how.
    pub drawing: Drawing,
    /// How to choose who draws, in the place of the drawing's method.
    pub auto: Option<Choosing>,
    /// Where the PNG goes.
    pub out: PathBuf,
    /// Where the hits go, if anywhere.
    pub hits: Option<PathBuf>,
    /// Where the linear light goes, if anywhere; only with effects.
    pub light_out: Option<PathBuf>,
}

/// Whatever is quickest on the scene and right enough; light needs a tree.
#[derive(Debug, Clone)]
pub struct Choosing {
    /// The largest error, mean support radii.
    pub max_error: f64,
    /// Where choices are kept.
    pub cache: Cache,
}

/// What to draw and how: a picture, or each frame of a moving scene.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// Name, generator or file.
    pub scene: String,
    /// What to change about the scene.
    pub overrides: Overrides,
    /// Who draws.
    pub method: &'static Method,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Where it is seen from.
    pub camera: CameraOptions,
    /// What the picture shows.
    pub picture: Picture,
    /// Effects, in the place of the shared Phong picture.
    pub light: LightOptions,
    /// What to draw with.
    pub device: Device,
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
pub(crate) struct Drawn {
    /// The method, or what was chosen and why, as names and texts.
    account: Vec<(&'static str, String)>,
    hits: Vec<Hit>,
    pub(crate) shaded: Shaded,
    pub(crate) build_ms: f64,
    pub(crate) frame_ms: f64,
    /// What the effects made, where there are any.
    lit: Option<Lit>,
    device: String,
}

/// Draws, writes the files, and says what it used.
///
/// # Errors
/// When the scene does not load, the method cannot draw it, or a file cannot be written.
pub fn render(order: &Order) -> anyhow::Result<()> {
    let drawing = &order.drawing;
    let BenchScene { name, scene, camera, .. } = &load(&drawing.scene, &drawing.overrides)?;
    let (width, height) = drawing.size;
    let camera = drawing.camera.camera(camera, scene.bounds().center())?;
    let view = View::new(camera, width, height)?;
    let drawn = match open(&drawing.device)? {
        Some(gpu) => on_adapter(&gpu, order, scene, &view)?,
        None if order.auto.is_some() => {
            bail!("auto needs a graphics adapter to measure methods on; for the CPU name a method")
        }
        None => on_cpu(drawing, scene, &view)?,
    };
    write_atomically(&order.out, &encode_png(&drawn.shaded.image)?)?;
    if let Some(path) = &order.hits {
        write_hits(path, width, height, &drawn.hits)?;
    }
    if let (Some(path), Some(lit)) = (&order.light_out, &drawn.lit) {
        write_light(path, &lit.film)?;
    }

    let balls = format!("{} of kernel {}", grouped(scene.len()), scene.kernel());
    let hit_count = drawn.hits.iter().filter(|hit| hit.is_hit()).count();
    let mut facts = vec![
        ("scene", name.clone()),
        ("balls", balls),
        ("threshold", scene.threshold().to_string()),
    ];
    facts.extend(drawn.account);
    facts.extend([
        ("adapter", drawn.device),
        ("build", format!("{} ms", decimal(drawn.build_ms))),
        ("frame", format!("{} ms", decimal(drawn.frame_ms))),
        ("hits", format!("{} of {} rays", grouped(hit_count), grouped(drawn.hits.len()))),
        ("picture", order.out.display().to_string()),
    ]);
    for (name, value) in facts {
        console::line(&format!("{name:<10} {value}"));
    }
    if let Some(lit) = &drawn.lit {
        console::line(&format!("{:<10} {}", "light", light::facts(lit)));
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
pub(crate) fn open(device: &Device) -> anyhow::Result<Option<Gpu>> {
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
fn on_adapter(gpu: &Gpu, order: &Order, scene: &Scene, view: &View) -> anyhow::Result<Drawn> {
    let drawing = &order.drawing;
    let targets = drawing.targets(gpu, scene)?;
    let Built { mut renderer, build, account } = built(gpu, order, scene, view)?;
    gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let frame = gpu::render(gpu, renderer.as_mut(), &targets, view)?;
    let hits = targets.read_hits(gpu)?;
    let (shaded, lit) = if drawing.light.is_asked() {
        let lighting = drawing.light.lighting(view.camera(), scene)?;
        let progress = Progress::new(lighting.samples().into());
        let after = || progress.advance(1);
        let lit = lighting.expose(gpu, renderer.as_mut(), scene, view, &hits, after)?;
        (Shaded { image: lit.image.clone(), range: None }, Some(lit))
    } else {
        (Shading::new(gpu).draw(&targets, view, scene, drawing.picture)?, None)
    };
    Ok(Drawn {
        account,
        hits,
        shaded,
        lit,
        build_ms: milliseconds(build.structure),
        frame_ms: milliseconds(frame.wall),
        device: drawing.device_name(Some(gpu)),
    })
}

/// A renderer that has its scene.
struct Built {
    renderer: Box<dyn IsoRenderer>,
    build: BuildReport,
    account: Vec<(&'static str, String)>,
}

fn built(gpu: &Gpu, order: &Order, scene: &Scene, view: &View) -> anyhow::Result<Built> {
    let drawing = &order.drawing;
    let Some(Choosing { max_error, cache }) = &order.auto else {
        let mut renderer = drawing.renderer();
        let build = renderer.build(gpu, scene)?;
        return Ok(Built { renderer, build, account: account_of(drawing.method) });
    };
    console::note("auto: drawing with every candidate, and asking the oracle");
    let mut candidates = candidates();
    candidates.retain(|setting| drawing.light.is_given_by(setting.method.name));
    let counting = drawing.counts();
    let mut auto = Auto::new(candidates, view.clone(), *max_error, cache.clone(), counting);
    let build = auto.build(gpu, scene)?;
    let account = auto.account();
    Ok(Built { renderer: Box::new(auto), build, account })
}

fn account_of(method: &Method) -> Vec<(&'static str, String)> {
    vec![("method", format!("{} ({})", method.name, method.paper))]
}

/// Traces and shades without an adapter.
pub(crate) fn on_cpu(drawing: &Drawing, scene: &Scene, view: &View) -> anyhow::Result<Drawn> {
    ensure!(
        !drawing.light.is_asked(),
        "light needs a graphics adapter; the CPU shades phong, normal, depth and color"
    );
    let look = Look::of(drawing.picture)?;
    let traced = cpu::trace(drawing.method, scene, view)?;
    Ok(Drawn {
        account: account_of(drawing.method),
        shaded: shade::draw(scene, view, &traced.rays, &traced.hits, look),
        hits: traced.hits,
        lit: None,
        build_ms: milliseconds(traced.build),
        frame_ms: milliseconds(traced.frame),
        device: drawing.device_name(None),
    })
}

impl Drawing {
    /// What the frames of such a scene are drawn to.
    pub(crate) fn targets(&self, gpu: &Gpu, scene: &Scene) -> Result<Targets, RenderError> {
        let (width, height) = self.size;
        Targets::new(gpu, width, height, scene.colors().is_some(), self.counts())
    }

    /// A renderer of the method, without a scene.
    pub(crate) fn renderer(&self) -> Box<dyn IsoRenderer> {
        (self.method.make)(self.counts())
    }

    /// What draws, in words.
    pub(crate) fn device_name(&self, gpu: Option<&Gpu>) -> String {
        match (gpu, &self.device) {
            (Some(gpu), _) => format!("{} ({})", gpu.report().name, gpu.report().driver),
            (None, Device::Cpu) => "none asked for: traced on the CPU".to_owned(),
            (None, Device::Adapter(_)) => "no graphics adapter: traced on the CPU".to_owned(),
        }
    }

    fn counts(&self) -> bool {
        matches!(self.picture, Picture::Work(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::find;
    use crate::output::tests::scratch;

    #[test]
    fn the_cpu_writes_picture_and_hits() {
        let folder = scratch("render-cpu");
        let drawing = Drawing {
            scene: "colors-100".to_owned(),
            overrides: Overrides::default(),
            method: find("fbvh").expect("listed"),
            size: (16, 12),
            camera: CameraOptions::default(),
            picture: Picture::Phong,
            light: LightOptions::default(),
            device: Device::Cpu,
        };
        let (out, hits) = (folder.join("image.png"), Some(folder.join("hits.exr")));
        let mut order = Order { drawing, auto: None, out, hits, light_out: None };
        render(&order).expect("drawn");
        assert!(order.out.is_file() && folder.join("hits.exr").is_file());
        order.drawing.picture = Picture::Spheres;
        assert!(render(&order).expect_err("refused").to_string().contains("graphics adapter"));
        order.auto = Some(Choosing { max_error: 1e-3, cache: Cache::none() });
        assert!(render(&order).expect_err("refused").to_string().contains("name a method"));
        std::fs::remove_dir_all(folder).expect("removable");
    }

    #[test]
    fn an_adapter_asked_for_by_name_is_not_replaced() {
        let device = Device::Adapter(AdapterChoice::Named("Voodoo".to_owned()));
        assert!(open(&device).expect_err("refused").to_string().contains("Voodoo"));
        assert!(open(&Device::Cpu).expect("nothing to open").is_none());
    }
}
