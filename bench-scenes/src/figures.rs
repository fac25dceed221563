//! Scenes of Kanamori et al. 2008, section 6, that no generator makes on its own. The paper gives
//! neither positions nor cameras: these have its counts, its kernel (Wyvill's) and its framing.

use glam::Vec3;
use metaball_core::{Aabb, Camera, Kernel, Metaball, Scene};

use crate::cameras::orbit;
use crate::error::LoadError;
use crate::generate;
use crate::small::{Shot, looking};

/// A scene and a path of cameras that show it, at least one.
pub(crate) type ScenePath = (Scene, Vec<Camera>);

/// T of these scenes; the paper prints none.
const THRESHOLD: f32 = 0.5;

/// From the middle of the fluid to the eye.
const SEEN_FROM: Vec3 = Vec3::new(0.4, 0.45, 1.0);

/// The fluid of figure 10, left: 120,000 balls, as dense as a simulation's.
pub(crate) fn fluid() -> Result<ScenePath, LoadError> {
    let scene = fluid_scene()?;
    let path = orbit(&scene.bounds(), SEEN_FROM);
    Ok((scene, path))
}

/// The same close up, right: the crown of the splash.
pub(crate) fn fluid_close_up() -> Result<ScenePath, LoadError> {
    let crown = Aabb::around_sphere(Vec3::new(0.25, 0.45, 0.1), 0.25);
    Ok((fluid_scene()?, orbit(&crown, SEEN_FROM)))
}

fn fluid_scene() -> Result<Scene, LoadError> {
    let Some(recipe) = generate::parse("pool:120000:28")? else {
        unreachable!("pool is a generator");
    };
    Ok(recipe.scene()?.scene.with_kernel(Kernel::Wyvill).with_threshold(THRESHOLD)?)
}

/// Section 6's comparison with Knoll et al. 2007: five balls so near that they fill about 80 % of
/// the picture.
pub(crate) fn five_close_up() -> Result<Shot, LoadError> {
    let centers = [(-0.8, 0.5), (0.8, 0.5), (0.0, 0.0), (-0.8, -0.5), (0.8, -0.5)];
    let balls = centers.map(|(x, y)| Metaball::new(Vec3::new(x, y, 0.25 * x * y), 1.0));
    let scene = Scene::new(balls, Kernel::Wyvill, THRESHOLD)?;
    Ok((scene, looking(Vec3::new(0.1, 0.1, 3.05), Vec3::ZERO)?))
}

#[cfg(test)]
mod tests {
    use metaball_core::reference::Oracle;
    use metaball_core::{Ray, Verdict};

    use super::*;

    /// The share of a picture of 64 × 48 pixels in which the oracle sees a surface.
    #[test]
    fn five_balls_fill_four_fifths_of_the_picture() {
        let (scene, camera) = five_close_up().expect("legal");
        let oracle = Oracle::new(&scene);
        let pixels = (0..48).flat_map(|row| (0..64).map(move |column| (column, row)));
        let hits = pixels
            .filter(|&(column, row)| {
                let direction = camera.exact_direction(column, row, 64, 48).as_vec3();
                oracle.first_hit(&Ray::new(camera.eye(), direction)).verdict == Verdict::Hit
            })
            .count();
        let share = hits as f64 / (64.0 * 48.0);
        assert!((0.77..0.83).contains(&share), "{share}");
    }

    #[test]
    fn the_close_up_is_the_same_fluid_from_nearer() {
        let ((wide, far), (close, near)) =
            (fluid().expect("legal"), fluid_close_up().expect("legal"));
        assert_eq!((wide.len(), wide.kernel()), (120_000, Kernel::Wyvill));
        assert_eq!(wide, close);
        let middle = wide.bounds().center();
        assert!(near[0].eye().distance(middle) < 0.5 * far[0].eye().distance(middle));
    }
}
