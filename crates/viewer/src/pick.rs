//! What a point of the picture is made of.

use glam::{DVec3, Vec3};
use metaball::{Clip, Error, Hit, Model, Verdict, View};
use metaball_core::Ray;

/// What the ray through a pixel finds.
#[derive(Debug, Clone, PartialEq)]
pub struct Pick {
    /// The ray.
    pub ray: Ray,
    /// What it finds.
    pub hit: Hit,
    /// The point of the surface, in the coordinates of the scene's file.
    pub point: DVec3,
    /// Whether it is on a face that a region cuts, and not on the surface.
    pub on_face: bool,
    /// Σ qᵢ·k there, in f64.
    pub field: f64,
    /// What each ball adds to it, the most first; negative balls come last.
    pub shares: Vec<Share>,
}

/// A ball's share of the field at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Index of the ball in the scene, from 0.
    pub ball: usize,
    /// What it adds; less than 0 where it takes away.
    pub value: f64,
    /// That in parts of the whole field.
    pub share: f64,
}

impl Pick {
    /// What a pixel of a view shows of a model cut to a region, which is in the coordinates of the scene's
    /// file; `None` where the ray hits nothing.
    ///
    /// # Errors
    /// When the model cannot be cut.
    pub fn at(
        model: &Model,
        clip: &Clip,
        view: &View,
        (column, row): (u32, u32),
    ) -> Result<Option<Self>, Error> {
        let camera = view.camera();
        let direction = camera.exact_direction(column, row, view.width(), view.height());
        let ray = Ray::new(camera.eye(), direction.as_vec3());
        let hit = model.cut(clip)?.first_hit(&ray);
        if !hit.is_hit() {
            return Ok(None);
        }
        let scene = model.scene();
        let in_scene = ray.origin.as_dvec3() + f64::from(hit.t) * ray.direction.as_dvec3();
        let shares = shares(model, in_scene);
        let section = clip.clone().relative_to(scene.origin()).section(&ray);
        Ok(Some(Self {
            on_face: section.has_on_face(&hit),
            field: shares.iter().map(|share| share.value).sum(),
            point: in_scene + scene.origin(),
            ray,
            hit,
            shares,
        }))
    }

    /// The normal out of the solid; zero where the eye is in it.
    pub fn normal(&self) -> Vec3 {
        self.hit.normal
    }

    /// Whether the eye is in the solid.
    pub fn is_inside(&self) -> bool {
        self.hit.verdict == Verdict::Inside
    }
}

/// All balls that add to the field at a point or take away from it, in the scene's coordinates.
fn shares(model: &Model, point: DVec3) -> Vec<Share> {
    let scene = model.scene();
    let mut shares: Vec<_> = (scene.balls().enumerate())
        .filter_map(|(ball, metaball)| {
            let squared = point.distance_squared(metaball.center.as_dvec3());
            let ratio = squared / f64::from(metaball.radius).powi(2);
            let value = f64::from(metaball.strength) * scene.kernel().value(ratio);
            (value != 0.0).then_some(Share { ball, value, share: 0.0 })
        })
        .collect();
    let field: f64 = shares.iter().map(|share| share.value).sum();
    shares.iter_mut().for_each(|share| share.share = share.value / field);
    shares.sort_by(|a, b| b.value.total_cmp(&a.value));
    shares
}

#[cfg(test)]
mod tests {
    use metaball::{Camera, Method, Scene};
    use metaball_core::reference::Oracle;
    use metaball_core::{Kernel, Metaball};

    use super::*;

    const ORIGIN: DVec3 = DVec3::new(1000.0, 0.0, 0.0);

    /// Two balls that overlap, one far off, one twice as strong, and a negative one.
    fn model() -> Model {
        let balls = [(-0.4, 1.0), (0.4, 1.0), (9.0, 1.0), (0.0, 2.0), (0.3, -0.1)]
            .map(|(x, strength)| Metaball { strength, ..Metaball::new(x * Vec3::X, 1.0) });
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal").with_origin(ORIGIN);
        Model::new(scene, &Method::default()).expect("built")
    }

    fn view() -> View {
        let camera = Camera::upright(4.0 * Vec3::Z, Vec3::ZERO, 40.0).expect("legal");
        View::new(camera, 65, 49).expect("a size")
    }

    #[test]
    fn a_point_of_the_surface_is_the_oracles_and_its_shares_add_up() {
        let (model, view) = (model(), view());
        let pick = Pick::at(&model, &Clip::default(), &view, (34, 20)).expect("whole");
        let pick = pick.expect("a hit");
        let truth = Oracle::new(model.scene()).first_hit(&pick.ray);
        assert!((f64::from(pick.hit.t) - truth.t).abs() < 1e-5);
        assert!((pick.field - 0.25).abs() < 1e-5, "{}", pick.field);
        let balls: Vec<_> = pick.shares.iter().map(|share| share.ball).collect();
        assert_eq!(balls, [3, 1, 0, 4], "by what they add; the far one adds nothing");
        assert!(pick.shares[3].value < 0.0);
        let whole: f64 = pick.shares.iter().map(|share| share.share).sum();
        assert!((whole - 1.0).abs() < 1e-12);
        let in_scene = pick.point - ORIGIN;
        assert!((in_scene.distance(DVec3::new(0.0, 0.0, 4.0)) - truth.t).abs() < 1e-5);
        assert!(!pick.on_face && !pick.is_inside() && pick.normal().z > 0.5);
        // The ray of the pixel is that of the view.
        assert_eq!(pick.ray, view.rays()[20 * 65 + 34]);
    }

    #[test]
    fn faces_and_nothing_are_told_apart() {
        let (model, view) = (model(), view());
        let clip = Clip::default().and_plane(Vec3::Z, 0.1).expect("a plane");
        let pick = Pick::at(&model, &clip, &view, (32, 24)).expect("cut").expect("a hit");
        assert!(pick.on_face && pick.normal() == Vec3::Z && pick.field > 1.0);
        assert!((pick.point.z - 0.1).abs() < 1e-6);
        assert_eq!(Pick::at(&model, &Clip::default(), &view, (0, 0)).expect("whole"), None);
    }
}
