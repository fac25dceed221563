//! The same lit picture from an adapter and from the CPU, for every kind of effect.

use fbvh::{Options, Tracer, Tree};
use glam::Vec3;
use harness::methods::find;
use harness::renderer::Renderer;
use metaball_core::gpu::{Gpu, RenderError};
use metaball_core::{Image, NO_LIMIT, Scene, View};
use metaball_light::{Effects, Film, Floor, Lamp, Occlusion, Surface, cpu, gpu};
use serde::Serialize;

/// Samples of a pixel.
const SAMPLES: u32 = 2;

/// How a picture of the adapter's differs from the CPU's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LitDifference {
    /// The effect.
    pub effect: &'static str,
    /// Pixels of the picture.
    pub pixels: usize,
    /// Pixels of which a channel differs by more than one step of 255, among those that both have.
    pub apart: usize,
    /// How many may be.
    pub most_apart: usize,
    /// Pixels that the adapter lacks, having left a ray of theirs undecided.
    pub lacking: usize,
}

impl LitDifference {
    /// Whether the pictures are the same, as far as two ways of rounding make one.
    pub fn is_small(&self) -> bool {
        self.apart <= self.most_apart
    }
}

/// Draws a view with an effect, by the certified tree, on the adapter and on the CPU. Their random numbers are
/// the same where the seeds are.
///
/// Paths of a fluid meet many surfaces, and where one passes an edge on another side it ends elsewhere: 99 of
/// 100 of those pixels must be the same, of all others 999 of 1000.
///
/// # Errors
/// When the scene is too large, or the device fails.
pub fn lit_difference(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    (effect, effects): &(&'static str, Effects),
    (adapter_seed, cpu_seed): (u32, u32),
) -> anyhow::Result<LitDifference> {
    let wanted = gpu_picture(gpu, scene, view, effects, adapter_seed)?;
    let found = cpu_picture(scene, view, effects, cpu_seed)?;
    let share = if matches!(effects.surface, Surface::Fluid { .. }) { 100 } else { 1000 };
    Ok(LitDifference {
        effect,
        pixels: view.pixels(),
        apart: pixels_apart(&wanted, &found),
        most_apart: view.pixels().div_ceil(share),
        lacking: wanted.1.len(),
    })
}

/// Every kind of effect, by name.
pub fn lit_effects(scene: &Scene, view: &View) -> [(&'static str, Effects); 6] {
    let base = Effects::phong(view.camera());
    let soft = Lamp { diameter: 4.0, ..Lamp::studio(view.camera())[0] };
    let radius = 0.5 * scene.bounds().extent().length();
    let water =
        Surface::Fluid { refraction: 1.33, absorption: Vec3::new(0.9, 0.28, 0.12) / radius };
    let mirror = Surface::Opaque { reflectivity: 0.3 };
    let floor = Some(floor_below(scene));
    [
        ("cel", Effects { bands: 4, floor, ..base.clone() }),
        ("hard shadows", Effects { shadows: true, floor, ..base.clone() }),
        ("soft shadows", Effects { shadows: true, lamps: vec![soft], floor, ..base.clone() }),
        (
            "occlusion",
            Effects { occlusion: Some(Occlusion { rays: 8, reach: NO_LIMIT }), ..base.clone() },
        ),
        ("mirrors", Effects { surface: mirror, bounces: 3, shadows: true, ..base.clone() }),
        ("water", Effects { surface: water, bounces: 8, floor, ..base }),
    ]
}

/// Tiles at the lowest point of all supports.
pub fn floor_below(scene: &Scene) -> Floor {
    let bounds = scene.bounds();
    let diagonal = bounds.extent().length();
    Floor {
        middle: bounds.center().with_y(bounds.min.y),
        reach: 3.0 * diagonal,
        color: Vec3::splat(0.5),
        tile: 0.3 * diagonal,
    }
}

/// The adapter's picture, and the pixels that it lacks.
fn gpu_picture(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    effects: &Effects,
    seed: u32,
) -> anyhow::Result<(Image, Vec<u32>)> {
    let method = find("fbvh-certified").map(|method| method.renderer(false));
    let mut renderer = method.and_then(Renderer::on_adapter).ok_or(RenderError::NoAdapter)?;
    renderer.build(gpu, scene)?;
    let mut tracer = gpu::PathTracer::new(gpu, scene, view, effects.clone(), SAMPLES, seed)?;
    for _ in 0..SAMPLES {
        tracer.add_sample(renderer.as_mut())?;
    }
    Ok((tracer.film()?.develop(0.0), tracer.unfinished()?))
}

fn cpu_picture(scene: &Scene, view: &View, effects: &Effects, seed: u32) -> anyhow::Result<Image> {
    let tree = Tree::build(scene, &Options::certified())?;
    let tracer = Tracer::new(&tree, scene);
    let picture = cpu::PathTracer::new(&tracer, scene, view, effects, SAMPLES, seed)?;
    let rows = picture.rows(0..view.height());
    let film = Film { width: view.width(), height: view.height(), light: rows.light };
    Ok(film.develop(0.0))
}

fn pixels_apart((one, lacking): &(Image, Vec<u32>), other: &Image) -> usize {
    let pixels = one.rgba.chunks(4).zip(other.rgba.chunks(4));
    let is_apart = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    let apart = (0..).zip(pixels).filter(|(_, pair)| is_apart(*pair));
    apart.filter(|(pixel, _)| lacking.binary_search(pixel).is_err()).count()
}
