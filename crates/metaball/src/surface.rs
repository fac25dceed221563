//! A scene with its tree.

use std::ops::ControlFlow;
use std::time::Duration;

use fbvh::{Kind, Tracer};
use metaball_core::{Camera, Scene};

use crate::backend::Opened;
use crate::cpu::Built;
use crate::draw::draw_built;
use crate::summary::Progress;
use crate::{DrawOptions, Drawing, Error, Method};

/// A scene with its certified tree, to be drawn and traced on the CPU any number of times.
///
/// ```
/// use metaball::{Camera, DrawOptions, Surface};
/// # use metaball_core::{Kernel, Metaball, Ray, Scene, glam::Vec3};
/// # use std::ops::ControlFlow;
///
/// # let balls = [Metaball::new(Vec3::ZERO, 2.0)];
/// # let scene = Scene::new(balls, Kernel::QUARTIC, 0.25)?;
/// let surface = Surface::build(scene)?;
/// let hit = surface.tracer().first_hit(&Ray::new(Vec3::new(0.0, 0.0, -5.0), Vec3::Z));
/// assert_eq!(hit.t, 5.0 - 2f32.sqrt());
/// let camera = Camera::framing(&surface.scene().bounds(), Vec3::Z);
/// let options = DrawOptions { size: (40, 30), ..DrawOptions::default() };
/// let drawing = surface.draw(&camera, &options, |_| ControlFlow::Continue(()))?;
/// assert!(drawing.hit_count() > 100);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Surface {
    scene: Scene,
    built: Built,
}

impl Surface {
    /// Builds the tree.
    ///
    /// # Errors
    /// When the builder refuses the scene.
    pub fn build(scene: Scene) -> Result<Self, Error> {
        let built = Built::new(&Method::default(), &scene)?;
        Ok(Self { scene, built })
    }

    /// What it is the surface of.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The time that its tree took.
    pub fn build_time(&self) -> Duration {
        self.built.time
    }

    /// Bytes of its tree.
    pub fn tree_bytes(&self) -> usize {
        self.built.tree_bytes()
    }

    /// What traces it.
    pub fn tracer(&self) -> Tracer<'_, Scene> {
        self.built.whole_tracer(&self.scene)
    }

    /// Draws it on the CPU, byte for byte as [`draw`](crate::draw()) does. `camera` is the scene's own. After
    /// each part that is done the callback hears of it, and it may break off.
    ///
    /// # Errors
    /// When an option cannot be used, another method or an adapter is asked for, or the callback breaks
    /// off.
    pub fn draw(
        &self,
        camera: &Camera,
        options: &DrawOptions,
        progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Drawing, Error> {
        let refused = |option, needed: &str, found| {
            Err(Error::Option { option, needed: needed.to_owned(), found })
        };
        let is_certified =
            options.method.tree().is_some_and(|options| options.kind() == Kind::Certified);
        if !is_certified {
            let found = options.method.name().to_owned();
            return refused("method", "fbvh-certified, whose tree a surface has", found);
        }
        if let Some(adapter) = options.backend.adapter_asked() {
            return refused("backend", "the CPU, which draws surfaces", adapter);
        }
        let view = options.view(&self.scene, camera)?;
        let lighting = options.lighting(&view, &self.scene)?;
        let computed_by = Opened::cpu("it has the tree").describe();
        let of = (&self.scene, &view);
        draw_built(&self.built, of, options, lighting.as_ref(), computed_by, progress)
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};

    use super::*;
    use crate::{Backend, LightOptions, draw};

    #[test]
    fn it_is_drawn_as_its_scene_is() {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let surface = Surface::build(bench.scene.clone()).expect("built");
        let plain = DrawOptions { size: (61, 83), backend: Backend::Cpu, ..DrawOptions::default() };
        let light = LightOptions { shadows: true, depth_cue: Some(1.0), ..LightOptions::default() };
        let lit = DrawOptions { light, ..plain.clone() };
        for options in [plain, lit] {
            let wanted = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            let mut rows = Vec::new();
            let watch = |progress: Progress| {
                rows.push(progress.done);
                ControlFlow::Continue(())
            };
            let found = surface.draw(&bench.camera, &options, watch).expect("drawn");
            assert!(found.image == wanted.image && found.hits == wanted.hits);
            assert_eq!((rows.first(), rows.last()), (Some(&0), Some(&83)));
            let stopped = surface.draw(&bench.camera, &options, |_| ControlFlow::Break(()));
            assert!(matches!(stopped, Err(Error::Interrupted)));
        }
        let fitted =
            DrawOptions { method: Method::Tree(fbvh::Options::fitted()), ..DrawOptions::default() };
        let refused = surface.draw(&bench.camera, &fitted, |_| ControlFlow::Continue(()));
        let refused = refused.expect_err("another method").to_string();
        assert!(refused.starts_with("method: needed fbvh-certified"), "{refused}");
    }
}
