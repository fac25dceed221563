//! Light on cut solids against closed forms: half a ball, seen on its face.

use fbvh::{ClippedScratch, ClippedTracer, Options, TraceScratch, Tracer, Tree};
use glam::Vec3;
use metaball_core::{
    Camera, Clip, Color, HostTracer, Kernel, Metaball, Ray, RayQuery, Scene, SurfaceHit, View,
};
use metaball_light::cpu::PathTracer;
use metaball_light::{Effects, Environment, Lamp, Panorama, Surface};

/// Where a ball of support radius 2 ends.
const RADIUS: f32 = std::f32::consts::SQRT_2;

/// The height of the face, below which the ball is kept; not one that f32 has.
const HEIGHT: f32 = 0.123;

/// The light of the surroundings, the same from everywhere.
const AROUND: Vec3 = Vec3::new(0.3, 0.2, 0.5);

const SIZE: (u32, u32) = (60, 45);

/// What a tracer may do wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    None,
    /// Shadow rays see the ball whole.
    WholeShadow,
    /// Rays start where the face was hit.
    NoClearance,
}

struct Faulty<'a> {
    cut: ClippedTracer<'a, Scene>,
    whole: Tracer<'a, Scene>,
    fault: Fault,
}

impl HostTracer for Faulty<'_> {
    type Scratch = (ClippedScratch, TraceScratch);

    fn scratch(&self) -> Self::Scratch {
        (self.cut.scratch(), self.whole.scratch())
    }

    fn answers(&self, query: RayQuery) -> bool {
        self.cut.answers(query)
    }

    fn answer(
        &self,
        query: RayQuery,
        rays: &[Ray],
        (cut, whole): &mut Self::Scratch,
        answers: &mut [SurfaceHit],
    ) {
        if self.fault == Fault::WholeShadow && query == RayQuery::AnyHit {
            self.whole.answer(query, rays, whole, answers);
        } else {
            self.cut.answer(query, rays, cut, answers);
        }
    }

    fn clearance(&self, ray: &Ray, found: &SurfaceHit) -> f32 {
        if self.fault == Fault::NoClearance { 0.0 } else { self.cut.clearance(ray, found) }
    }

    fn balls_near(&self, found: &SurfaceHit) -> &[u32] {
        self.cut.balls_near(found)
    }
}

fn view() -> View {
    let eye = Vec3::new(1.0, 7.0, 2.0);
    let camera = Camera::look_at(eye, Vec3::Y * HEIGHT, Vec3::Z, 20.0).expect("a camera");
    View::new(camera, SIZE.0, SIZE.1).expect("a size")
}

fn effects() -> Effects {
    let around = Panorama::new(1, 1, [AROUND]).expect("light");
    let lamp = Lamp { toward: LAMP, diameter: 0.0, color: Vec3::new(0.7, 0.6, 0.1) };
    Effects {
        lamps: vec![lamp],
        shadows: true,
        environment: Environment::Panorama(around),
        ..Effects::phong(view().camera())
    }
}

/// Towards the lamp: a unit vector.
const LAMP: Vec3 = Vec3::new(0.48, 0.8, 0.36);

/// Pixels of half a ball whose light is not the wanted one, and how many have been looked at: `wanted` is
/// given the pixel's ray and looks away where it returns none.
fn wrong_pixels(
    fault: Fault,
    effects: &Effects,
    wanted: impl Fn(&Ray) -> Option<Vec3>,
) -> (usize, usize) {
    let ball = Metaball::new(Vec3::ZERO, 2.0);
    let scene = Scene::new([ball], Kernel::QUARTIC, 0.25).expect("legal");
    let scene = scene.with_colors(vec![Color::srgb(200, 100, 50)]).expect("a colour a ball");
    let tree = Tree::build(&scene, &Options::certified()).expect("legal");
    let clip = Clip::default().and_plane(Vec3::Y, HEIGHT.into()).expect("a plane");
    let tracer = Faulty {
        cut: ClippedTracer::new(Tracer::new(&tree, &scene), clip).expect("certified"),
        whole: Tracer::new(&tree, &scene),
        fault,
    };
    let picture = PathTracer::new(&tracer, &scene, &view(), effects, 1, 0).expect("answered");
    let light = picture.rows(0..SIZE.1).light;
    let rays = view().rays();
    let seen = rays.iter().zip(light).filter_map(|(ray, light)| Some((wanted(ray)?, light)));
    seen.fold((0, 0), |(wrong, all), (wanted, light)| {
        let is_wrong = (wanted - light).abs().max_element() > 1e-4;
        (wrong + usize::from(is_wrong), all + 1)
    })
}

/// The light of the face where a ray meets it, away from its rim, by Phong's model in full light.
fn light_on_the_face(ray: &Ray) -> Option<Vec3> {
    let t = (HEIGHT - ray.origin.y) / ray.direction.y;
    let point = ray.origin + t * ray.direction;
    if point.length() > 0.99 * RADIUS {
        return None;
    }
    let lamp = effects().lamps[0];
    let base = Color::srgb(200, 100, 50).to_linear();
    let highlight = ray.direction.reflect(Vec3::Y).dot(LAMP).max(0.0).powi(48);
    Some(base * AROUND + lamp.color * (base * LAMP.y + 0.22 * highlight))
}

#[test]
fn nothing_that_was_cut_away_shadows_the_face_nor_does_it_itself() {
    let wrong = |fault| wrong_pixels(fault, &effects(), light_on_the_face);
    let (none, all) = wrong(Fault::None);
    assert!(none == 0 && all > 600, "{none} of {all}");
    assert!(wrong(Fault::WholeShadow).0 > all / 2);
    assert!(wrong(Fault::NoClearance).0 > all / 10);
}

/// What is left of light that has gone straight through the half below a height.
fn left_behind(ray: &Ray, height: f32) -> Option<Vec3> {
    let along = -ray.origin.dot(ray.direction);
    let off_axis = (ray.origin + along * ray.direction).length_squared();
    let half = (RADIUS * RADIUS - off_axis).sqrt();
    let face = (height - ray.origin.y) / ray.direction.y;
    let (enter, leave) = (f32::max(along - half, face), along + half);
    // Away from the rims, where roundings are most of the way.
    (half > 0.2 && leave > enter + 0.1).then(|| AROUND * (-(leave - enter) * ABSORPTION).exp())
}

const ABSORPTION: Vec3 = Vec3::new(0.5, 0.2, 0.1);

/// A fluid that does not bend light: it is in the face and out of the surface.
#[test]
fn light_goes_through_the_half_that_is_left() {
    let surface = Surface::Fluid { refraction: 1.0, absorption: ABSORPTION };
    let clear = Effects { surface, shadows: false, bounces: 8, ..effects() };
    let (wrong, all) = wrong_pixels(Fault::None, &clear, |ray| left_behind(ray, HEIGHT));
    assert!(wrong == 0 && all > 600, "{wrong} of {all}");
    let (wrong, all) = wrong_pixels(Fault::None, &clear, |ray| left_behind(ray, 2.0));
    assert!(wrong > all / 2, "{wrong} of {all}");
}
