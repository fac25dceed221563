//! The shared pictures, made on the CPU where there is no adapter: the formulas of
//! `shaders/wgsl/shade`, line by line.

use glam::Vec3;
use rayon::prelude::*;

use crate::{
    Camera, Color, Hit, Image, Picture, Ray, Scene, Shaded, SurfaceColors, ValueRange, Verdict,
    View,
};

/// A picture that needs no adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CpuPicture {
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
    pub const CHOICE: &str = "the CPU shades phong, normal, depth and color";

    /// That picture; `None` where only an adapter draws it.
    pub fn of(picture: Picture) -> Option<Self> {
        match picture {
            Picture::Phong => Some(Self::Phong),
            Picture::Normal => Some(Self::Normal),
            Picture::Depth => Some(Self::Depth),
            Picture::Color => Some(Self::Color),
            Picture::Spheres | Picture::Work(_) => None,
        }
    }
}

/// The picture of hits, each found along its ray of the view; both row by row from the top left.
pub fn draw(scene: &Scene, view: &View, rays: &[Ray], hits: &[Hit], picture: CpuPicture) -> Shaded {
    let shader = Shader::new(scene, view, picture);
    let range = shader.needs_range().then(|| ValueRange::of_distances(hits));
    let pixels = shader.pixels(0, rays, hits, range.unwrap_or_default());
    Shaded { image: Image::new(view.width(), view.height(), &pixels), range }
}

/// Shades a scene's hits, all of a picture's or some rows of them.
#[derive(Debug)]
pub struct Shader<'a> {
    view: &'a View,
    picture: CpuPicture,
    colors: SurfaceColors<'a>,
}

impl<'a> Shader<'a> {
    /// For a picture of the scene in the view.
    pub fn new(scene: &'a Scene, view: &'a View, picture: CpuPicture) -> Self {
        Self { view, picture, colors: SurfaceColors::new(scene) }
    }

    /// Whether pixels depend on the hits of the whole picture.
    pub fn needs_range(&self) -> bool {
        self.picture == CpuPicture::Depth
    }

    /// The pixels of hits from the first pixel of a row on, each found along its ray of the view; `range`
    /// is that of the picture's distances, which [`CpuPicture::Depth`] alone needs.
    pub fn pixels(&self, row: u32, rays: &[Ray], hits: &[Hit], range: ValueRange) -> Vec<Color> {
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
    use super::*;
    use crate::WorkKind;

    #[test]
    fn what_only_an_adapter_draws_is_none_of_these() {
        for picture in [Picture::Spheres, Picture::Work(WorkKind::Balls)] {
            assert_eq!(CpuPicture::of(picture), None);
        }
        assert_eq!(CpuPicture::of(Picture::Depth), Some(CpuPicture::Depth));
    }
}
