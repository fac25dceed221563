//! The shared pictures, made on the CPU where there is no adapter: the formulas of
//! `shaders/wgsl/shade`, line by line.

use glam::Vec3;
use metaball_core::{
    Camera, Color, Hit, Picture, Ray, Scene, SurfaceColors, ValueRange, Verdict, View,
};
use rayon::prelude::*;

use crate::Error;

/// A picture that needs no adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CpuPicture {
    /// [`Picture::Phong`].
    Phong,
    /// [`Picture::Normal`].
    Normal,
    /// [`Picture::Depth`].
    Depth,
    /// [`Picture::Color`].
    Color,
}

impl CpuPicture {
    /// What there is, for those who asked for something else.
    pub(crate) const CHOICE: &str = "the CPU shades phong, normal, depth and color";

    /// That picture, unless only an adapter draws it.
    pub(crate) fn of(picture: Picture) -> Result<Self, Error> {
        Ok(match picture {
            Picture::Phong => Self::Phong,
            Picture::Normal => Self::Normal,
            Picture::Depth => Self::Depth,
            Picture::Color => Self::Color,
            Picture::Spheres | Picture::Work(_) => {
                return Err(Error::NeedsAdapter {
                    what: format!("picture {picture:?}"),
                    instead: Self::CHOICE.to_owned(),
                });
            }
        })
    }
}

/// Shades a scene's hits, all of a picture's or some rows of them.
pub(crate) struct Shader<'a> {
    view: &'a View,
    picture: CpuPicture,
    colors: SurfaceColors<'a>,
}

impl<'a> Shader<'a> {
    pub(crate) fn new(scene: &'a Scene, view: &'a View, picture: CpuPicture) -> Self {
        Self { view, picture, colors: SurfaceColors::new(scene) }
    }

    /// Whether pixels depend on the hits of the whole picture.
    pub(crate) fn needs_range(&self) -> bool {
        self.picture == CpuPicture::Depth
    }

    /// The pixels of hits from the first pixel of a row on, each found along its ray of the view; `range`
    /// is that of the picture's distances, which [`CpuPicture::Depth`] alone needs.
    pub(crate) fn pixels(
        &self,
        row: u32,
        rays: &[Ray],
        hits: &[Hit],
        range: ValueRange,
    ) -> Vec<Color> {
        let (width, height) = (self.view.width() as usize, self.view.height());
        let camera = self.view.camera();
        let shade = |index: usize, ray: &Ray, hit: &Hit| match self.picture {
            CpuPicture::Phong | CpuPicture::Color => {
                let row = row + (index / width) as u32;
                Color::from_linear(self.light(background(row, height), ray, hit))
            }
            CpuPicture::Normal => stored(normal(camera, hit)),
            CpuPicture::Depth => stored(grey(hit, range)),
        };
        let hits = hits.par_iter().map(Hit::most_likely);
        rays.par_iter()
            .zip(hits)
            .enumerate()
            .map(|(index, (ray, hit))| shade(index, ray, &hit))
            .collect()
    }

    fn light(&self, background: Vec3, ray: &Ray, hit: &Hit) -> Vec3 {
        let color = || self.colors.at(ray.origin + hit.t * ray.direction, &[]);
        match (self.picture, hit.verdict) {
            (_, Verdict::Miss | Verdict::Undecided) => background,
            (CpuPicture::Color, _) => color(),
            (_, Verdict::Inside) => 0.25 * color(),
            _ => phong(self.view.camera(), color(), hit.normal, -ray.direction),
        }
    }
}

/// Phong's model with a warm key light over the left shoulder, a cool fill light from the right, and
/// ambient light that is brighter from above.
fn phong(camera: &Camera, base: Vec3, normal: Vec3, toward_eye: Vec3) -> Vec3 {
    let (right, up, forward) = (camera.right(), camera.up(), camera.forward());
    let key = (0.8 * up - 0.6 * right - 0.9 * forward).normalize();
    let fill = (0.9 * right - 0.1 * up - 0.5 * forward).normalize();
    let key_light = 0.85 * Vec3::new(1.0, 0.97, 0.92) * normal.dot(key).max(0.0);
    let fill_light = 0.18 * Vec3::new(0.75, 0.85, 1.0) * normal.dot(fill).max(0.0);
    let ambient =
        Vec3::new(0.035, 0.033, 0.03).lerp(Vec3::new(0.11, 0.12, 0.14), 0.5 + 0.5 * normal.dot(up));
    let mirrored = (-key).reflect(normal).dot(toward_eye).max(0.0);
    base * (key_light + fill_light + ambient) + 0.22 * libm::powf(mirrored, 48.0)
}

/// Behind everything: a gradient down the picture.
fn background(row: u32, height: u32) -> Vec3 {
    let down = (row as f32 + 0.5) / height as f32;
    Vec3::new(0.035, 0.045, 0.065).lerp(Vec3::new(0.17, 0.19, 0.22), down)
}

/// Red to the right, green upwards, blue towards the eye; black for none.
fn normal(camera: &Camera, hit: &Hit) -> Vec3 {
    if !hit.is_hit() {
        return Vec3::ZERO;
    }
    let axes = [camera.right(), camera.up(), -camera.forward()];
    0.5 + 0.5 * Vec3::from(axes.map(|axis| hit.normal.dot(axis)))
}

/// White at the near end of the scale, dark at the far end, black for none.
fn grey(hit: &Hit, scale: ValueRange) -> Vec3 {
    if !hit.is_hit() {
        return Vec3::ZERO;
    }
    let share = (hit.t - scale.low) / (scale.high - scale.low).max(1e-30);
    Vec3::splat(1.0 - 0.85 * share.clamp(0.0, 1.0))
}

/// A pixel of channels that are not light, clamped to \[0, 1\] and rounded as WGSL's `pack4x8unorm`.
fn stored(channels: Vec3) -> Color {
    let [red, green, blue] =
        channels.to_array().map(|channel| (0.5 + 255.0 * channel.clamp(0.0, 1.0)) as u8);
    Color::srgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use fbvh::Options;
    use metaball_core::gpu::{self, Gpu, IsoRenderer, Shading, Targets};
    use metaball_core::{Image, WorkKind};

    use super::*;

    /// Hits of the same frame under both shadings. WGSL lets `pow` err by 16 units in the last place
    /// of the logarithm it goes through, 1e-5 of a channel here, which moves a value by at most one
    /// step where it lies next to a rounding boundary. Blended colours go through two roundings.
    #[test]
    fn both_shadings_agree() {
        let Some(gpu) = Gpu::for_test() else { return };
        for (name, steps) in [("strengths-100", 1), ("colors-100", 2), ("eye-inside-surface", 1)] {
            let bench = load(name, &Overrides::default()).expect("known");
            let scene = &bench.scene;
            let view = View::new(bench.camera, 64, 48).expect("a size");
            let targets =
                Targets::new(&gpu, 64, 48, scene.colors().is_some(), false).expect("memory");
            let mut renderer = fbvh::gpu::Renderer::new("fbvh", Options::fitted(), false);
            renderer.build(&gpu, scene).expect("built");
            gpu::render(&gpu, &mut renderer, &targets, &view).expect("drawn");
            let rays = targets.read_rays(&gpu, &view).expect("read");
            let hits = targets.read_hits(&gpu).expect("read");
            for picture in [Picture::Phong, Picture::Normal, Picture::Depth, Picture::Color] {
                let wanted =
                    Shading::new(&gpu).draw(&targets, &view, scene, picture).expect("shaded");
                let on_cpu = CpuPicture::of(picture).expect("needs no adapter");
                let shader = Shader::new(scene, &view, on_cpu);
                let range = ValueRange::of_distances(&hits);
                assert_eq!(shader.needs_range().then_some(range), wanted.range);
                let found = Image::new(64, 48, &shader.pixels(0, &rays, &hits, range));
                let bytes = found.rgba.iter().zip(&wanted.image.rgba);
                let worst = bytes.map(|(found, wanted)| found.abs_diff(*wanted)).max();
                assert!(worst <= Some(steps), "{name}, {picture:?}: {worst:?}");
            }
        }
    }

    #[test]
    fn what_needs_an_adapter_says_so() {
        for picture in [Picture::Spheres, Picture::Work(WorkKind::Balls)] {
            let error = CpuPicture::of(picture).expect_err("no");
            assert!(error.to_string().contains("needs a graphics adapter"), "{error}");
        }
    }
}
