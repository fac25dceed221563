//! See-through surfaces against closed forms.

use fbvh::{Options, Tracer, Tree};
use glam::Vec3;
use metaball_core::{Camera, Kernel, Metaball, NO_LIMIT, Scene, SurfaceColors, View};
use metaball_light::cpu::{PathTracer, Rows};
use metaball_light::{Effects, Environment, Lamp, Occlusion, Panorama, Surface};

/// Where a ball of support radius 2 ends.
const RADIUS: f32 = std::f32::consts::SQRT_2;

/// The light of the surroundings, the same from everywhere.
const AROUND: Vec3 = Vec3::new(0.3, 0.2, 0.5);

/// Phong's highlight where it is brightest.
const HIGHLIGHT: f32 = 0.22;

const OPACITY: f32 = 0.375;

fn scene(centers: &[Vec3]) -> Scene {
    let balls = centers.iter().map(|&center| Metaball::new(center, 2.0));
    Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal")
}

fn lamp(toward: Vec3, color: Vec3) -> Lamp {
    Lamp { toward, diameter: 0.0, color }
}

/// A lamp at the eye, and one that shines at the eye from behind.
fn lamps() -> [Lamp; 2] {
    [lamp(Vec3::Z, Vec3::new(0.7, 0.6, 0.1)), lamp(-Vec3::Z, Vec3::new(0.1, 0.9, 0.4))]
}

fn effects(lamps: &[Lamp], bounces: u32) -> Effects {
    let camera = view(1, 1);
    let around = Panorama::new(1, 1, [AROUND]).expect("light");
    Effects {
        surface: Surface::SeeThrough { opacity: OPACITY },
        lamps: lamps.to_vec(),
        shadows: true,
        bounces,
        environment: Environment::Panorama(around),
        ..Effects::phong(camera.camera())
    }
}

/// Down the z axis at the origin.
fn view(width: u32, height: u32) -> View {
    let camera = Camera::look_at(Vec3::Z * 10.0, Vec3::ZERO, Vec3::Y, 20.0).expect("a camera");
    View::new(camera, width, height).expect("a size")
}

fn drawn(scene: &Scene, view: &View, effects: &Effects) -> Rows {
    let tree = Tree::build(scene, &Options::certified()).expect("legal");
    let tracer = Tracer::new(&tree, scene);
    let picture = PathTracer::new(&tracer, scene, view, effects, 1, 0).expect("answered");
    picture.rows(0..view.height())
}

/// The light along the z axis.
fn along_the_axis(scene: &Scene, effects: &Effects) -> Vec3 {
    drawn(scene, &view(1, 1), effects).light[0]
}

/// Light on a surface that one lamp shines on straight, at its highlight or away from it.
fn lit(lamp: &Lamp, highlight: f32) -> Vec3 {
    let base = SurfaceColors::UNCOLORED;
    base * AROUND + lamp.color * (base + highlight)
}

/// Layers over the surroundings, the first one in front.
fn over(layers: &[Vec3]) -> Vec3 {
    let behind = |behind, layer: &Vec3| OPACITY * *layer + (1.0 - OPACITY) * behind;
    layers.iter().rev().fold(AROUND, behind)
}

fn is_near(found: Vec3, wanted: Vec3) -> bool {
    (found - wanted).abs().max_element() < 1e-5
}

#[test]
fn layers_are_composited_front_to_back() {
    let lamps = lamps();
    let [front, back] = [lit(&lamps[0], HIGHLIGHT), lit(&lamps[1], 0.0)];
    let found = along_the_axis(&scene(&[Vec3::ZERO]), &effects(&lamps, 8));
    let share = OPACITY;
    let wanted = share * front + (1.0 - share) * share * back + (1.0 - share).powi(2) * AROUND;
    assert!(is_near(found, wanted) && is_near(over(&[front, back]), wanted), "{found} {wanted}");
    assert!(!is_near(found, over(&[back, front])), "back to front");
}

#[test]
fn behind_the_last_layer_there_are_the_surroundings() {
    let lamps = lamps();
    let [front, back] = [lit(&lamps[0], HIGHLIGHT), lit(&lamps[1], 0.0)];
    let row = scene(&[Vec3::ZERO, Vec3::Z * -5.0]);
    // Neither lamp shines straight on the surfaces between the balls.
    let shaded = [(&lamps[0], HIGHLIGHT), (&lamps[1], 0.0)].map(|(lamp, highlight)| {
        lit(&Lamp { color: (1.0 - OPACITY) * lamp.color, ..*lamp }, highlight)
    });
    let layers = [front, shaded[1], shaded[0], back];
    for bounces in [0, 1, 2, 3, 8] {
        let found = along_the_axis(&row, &effects(&lamps, bounces));
        let seen = (bounces as usize + 1).min(4);
        let wanted = over(&layers[..seen]);
        assert!(is_near(found, wanted), "{bounces}: {found} {wanted}");
        assert!(seen == 4 || !is_near(found, over(&layers)), "{bounces}");
    }
}

#[test]
fn light_behind_a_surface_is_what_it_lets_pass() {
    let toward = Vec3::new(0.6, 0.0, 0.8);
    let lamp = lamp(toward, Vec3::new(0.7, 0.6, 0.1));
    let between = scene(&[Vec3::ZERO, RADIUS * Vec3::Z + 4.0 * toward]);
    let found = along_the_axis(&between, &effects(&[lamp], 0));
    let base = SurfaceColors::UNCOLORED;
    let highlight = HIGHLIGHT * toward.z.powi(48);
    let light =
        |share: f32| over(&[base * AROUND + share * lamp.color * (toward.z * base + highlight)]);
    assert!(is_near(found, light(1.0 - OPACITY)), "{found} {}", light(1.0 - OPACITY));
    assert!(!is_near(found, light(0.0)) && !is_near(found, light(1.0)));
}

#[test]
fn at_opacity_one_it_is_the_opaque_picture() {
    let scene = scene(&[Vec3::ZERO, Vec3::new(0.5, 1.5, 2.0)]);
    let picture = |surface| {
        let occlusion = Some(Occlusion { rays: 3, reach: NO_LIMIT });
        let effects = Effects { surface, occlusion, ..effects(&lamps(), 0) };
        drawn(&scene, &view(40, 30), &effects)
    };
    let opaque = picture(Surface::Opaque { reflectivity: 0.0 });
    assert_eq!(picture(Surface::SeeThrough { opacity: 1.0 }), opaque);
    assert_ne!(picture(Surface::SeeThrough { opacity: 0.99 }), opaque);
}
