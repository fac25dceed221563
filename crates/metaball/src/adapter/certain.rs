//! What an adapter cannot tell in f32, asked again on the CPU in f64.

use std::cell::OnceCell;

use fbvh::{Options, Tracer, Tree};
use metaball_core::gpu::{Gpu, Targets};
use metaball_core::{Color, Hit, Scene, SurfaceColors, Verdict, View};
use metaball_light::Film;

use crate::Error;
use crate::light::Lighting;

/// A scene with its certified tree, which is built when something is asked.
pub(crate) struct Certain<'a> {
    pub(crate) scene: &'a Scene,
    tree: OnceCell<Tree>,
}

impl<'a> Certain<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        Self { scene, tree: OnceCell::new() }
    }

    /// Decides the hits that a frame left undecided, with the very rays that the adapter made, in the
    /// frame's targets too. How many were asked again.
    pub(crate) fn decide(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        view: &View,
        hits: &mut [Hit],
    ) -> Result<u64, Error> {
        let is_undecided = |(_, hit): &(usize, &Hit)| hit.verdict == Verdict::Undecided;
        let open: Vec<_> =
            hits.iter().enumerate().filter(is_undecided).map(|(pixel, _)| pixel).collect();
        if open.is_empty() {
            return Ok(0);
        }
        let rays = targets.read_rays(gpu, view)?;
        let rays: Vec<_> = open.iter().map(|&pixel| rays[pixel]).collect();
        let answers = self.tracer()?.first_hits(&rays);
        let colors = SurfaceColors::new(self.scene);
        for ((&pixel, ray), answer) in open.iter().zip(&rays).zip(answers) {
            hits[pixel] = answer;
            if answer.is_hit() {
                let light = colors.at(ray.origin + answer.t * ray.direction, &[]);
                targets.write_color(gpu, pixel, Color::from_linear(light))?;
            }
        }
        targets.write_hits(gpu, hits)?;
        Ok(open.len() as u64)
    }

    /// Draws these pixels of a film anew, all of their samples.
    pub(crate) fn relight(
        &self,
        lighting: &Lighting,
        view: &View,
        pixels: &[u32],
        film: &mut Film,
    ) -> Result<(), Error> {
        if pixels.is_empty() {
            return Ok(());
        }
        let tracer = self.tracer()?;
        // The certified tree follows any ray.
        let paths = lighting.on_cpu(&tracer, self.scene, view);
        let lights = paths.map(|paths| paths.pixels(pixels)).unwrap_or_default();
        for (&pixel, light) in pixels.iter().zip(lights) {
            film.light[pixel as usize] = light;
        }
        Ok(())
    }

    fn tracer(&self) -> Result<Tracer<'_, Scene>, Error> {
        let tree = match self.tree.get() {
            Some(tree) => tree,
            None => {
                let tree = Tree::build(self.scene, &Options::certified()).map_err(|source| {
                    Error::Build { method: fbvh::Kind::Certified.name().to_owned(), source }
                })?;
                self.tree.get_or_init(|| tree)
            }
        };
        Ok(Tracer::new(tree, self.scene))
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use glam::Vec3;
    use metaball_core::gpu::{self, IsoRenderer};

    use super::*;
    use crate::{DrawOptions, LightOptions};

    const SIZE: (u32, u32) = (48, 36);

    /// A frame's hits, of which every seventh is made undecided.
    #[test]
    fn what_is_undecided_is_decided_as_the_adapter_would_have() {
        let Some(gpu) = Gpu::for_test() else { return };
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let scene = &bench.scene;
        let view = View::new(bench.camera, SIZE.0, SIZE.1).expect("a size");
        let targets = Targets::new(&gpu, SIZE.0, SIZE.1, true, false).expect("memory");
        let mut renderer = fbvh::gpu::Renderer::new("fbvh", Options::certified(), false);
        renderer.build(&gpu, scene).expect("built");
        gpu::render(&gpu, &mut renderer, &targets, &view).expect("drawn");
        let wanted = targets.read_hits(&gpu).expect("read");
        let colors = targets.read_colors(&gpu).expect("read").expect("colours");

        let mut hits = wanted.clone();
        let undecided = Hit { verdict: Verdict::Undecided, ..Hit::MISS };
        hits.iter_mut().step_by(7).for_each(|hit| *hit = undecided);
        for pixel in 0..hits.len() {
            targets.write_color(&gpu, pixel, Color::srgb(9, 9, 9)).expect("written");
        }
        let certain = Certain::new(scene);
        let asked = certain.decide(&gpu, &targets, &view, &mut hits).expect("decided");
        assert_eq!(asked as usize, hits.len().div_ceil(7));
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b;
        for (found, wanted) in hits.iter().zip(&wanted) {
            assert_eq!(found.verdict, wanted.verdict);
            assert!(!found.is_hit() || near(found.t, wanted.t), "{found:?} {wanted:?}");
        }
        let back = targets.read_hits(&gpu).expect("read");
        assert!(back.iter().all(|hit| hit.verdict != Verdict::Undecided));
        let repainted = targets.read_colors(&gpu).expect("read").expect("colours");
        for pixel in (0..hits.len()).step_by(7).filter(|&pixel| hits[pixel].is_hit()) {
            let [found, wanted] = [repainted[pixel], colors[pixel]].map(Color::to_srgb);
            let steps =
                found.iter().zip(wanted).map(|(found, wanted)| found.abs_diff(wanted)).max();
            assert!(steps <= Some(1), "{found:?} {wanted:?}");
        }
        assert_eq!(certain.decide(&gpu, &targets, &view, &mut hits).expect("nothing"), 0);
    }

    #[test]
    fn pixels_are_lit_anew_as_they_were() {
        let bench = load("random-200", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, SIZE.0, SIZE.1).expect("a size");
        let light = LightOptions {
            ambient_occlusion: Some(2),
            reflections: Some(1),
            samples: Some(2),
            ..LightOptions::default()
        };
        let options = DrawOptions { light, size: SIZE, ..DrawOptions::default() };
        let lighting = options.lighting(&view, &bench.scene).expect("legal").expect("asked for");
        let certain = Certain::new(&bench.scene);
        let light = vec![Vec3::ZERO; view.pixels()];
        let mut film = Film { width: SIZE.0, height: SIZE.1, light };
        let all: Vec<u32> = (0..view.pixels() as u32).collect();
        certain.relight(&lighting, &view, &all, &mut film).expect("lit");
        let wanted = film.clone();
        assert!(film.light.iter().all(|light| *light != Vec3::ZERO));
        let some: Vec<u32> = all.into_iter().step_by(5).collect();
        some.iter().for_each(|&pixel| film.light[pixel as usize] = Vec3::ZERO);
        certain.relight(&lighting, &view, &some, &mut film).expect("lit");
        assert_eq!(film.light, wanted.light);
    }
}
