//! Pictures: that each shows what it should, and notices when it is wrong.

use glam::Vec3;

use super::sphere::{HEIGHT, Sphere, WIDTH, colored, scene, targets, view, view_from};
use crate::gpu::{Gpu, IsoRenderer, RenderError, Shading, render};
use crate::{Image, Kernel, Metaball, Picture, Scene, Shaded, View, WorkKind};

const MIDDLE: (u32, u32) = (WIDTH / 2, HEIGHT / 2);

fn pixel(image: &Image, (column, row): (u32, u32)) -> [u8; 3] {
    let start = 4 * (row * image.width + column) as usize;
    assert_eq!(image.rgba[start + 3], 255);
    [image.rgba[start], image.rgba[start + 1], image.rgba[start + 2]]
}

fn draw(gpu: &Gpu, mut renderer: Sphere, scene: &Scene, view: &View, picture: Picture) -> Shaded {
    let targets = targets(gpu, scene, renderer.counting);
    renderer.build(gpu, scene).expect("builds");
    render(gpu, &mut renderer, &targets, view).expect("renders");
    let shaded = Shading::new(gpu).draw(&targets, view, scene, picture).expect("draws");
    assert_eq!((shaded.image.width, shaded.image.height), (WIDTH, HEIGHT));
    assert_eq!(shaded.image.rgba.len(), 4 * view.pixels());
    shaded
}

fn brightness(pixel: [u8; 3]) -> u32 {
    pixel.iter().map(|&channel| u32::from(channel)).sum()
}

#[test]
fn phong_lights_the_outside() {
    let Some(gpu) = Gpu::for_test() else { return };
    let right = draw(&gpu, Sphere::new(), &scene(), &view(), Picture::Phong).image;
    let turned = Sphere { outward: -1.0, ..Sphere::new() };
    let wrong = draw(&gpu, turned, &scene(), &view(), Picture::Phong).image;
    assert!(brightness(pixel(&right, MIDDLE)) > 2 * brightness(pixel(&wrong, MIDDLE)));
    // The key light stands to the left, above.
    let (left, below) = ((MIDDLE.0 - 4, MIDDLE.1 - 4), (MIDDLE.0 + 4, MIDDLE.1 + 4));
    assert!(brightness(pixel(&right, left)) > brightness(pixel(&right, below)));
    assert_eq!(pixel(&right, (0, 0)), pixel(&wrong, (0, 0)));
}

#[test]
fn colour_is_the_balls_own() {
    let Some(gpu) = Gpu::for_test() else { return };
    let image = draw(&gpu, Sphere::new(), &colored(), &view(), Picture::Color).image;
    assert_eq!(pixel(&image, MIDDLE), [200, 40, 10]);
}

#[test]
fn normals_face_the_eye() {
    let Some(gpu) = Gpu::for_test() else { return };
    let image = draw(&gpu, Sphere::new(), &scene(), &view(), Picture::Normal).image;
    let [red, green, blue] = pixel(&image, MIDDLE);
    // Half a pixel off the middle of the sphere: cosines below 0.1.
    assert!(red.abs_diff(128) < 14 && green.abs_diff(128) < 14 && blue > 250);
    let [red, ..] = pixel(&image, (MIDDLE.0 + 6, MIDDLE.1));
    let [_, green, _] = pixel(&image, (MIDDLE.0, MIDDLE.1 - 6));
    assert!(red > 160 && green > 160);
    assert_eq!(pixel(&image, (0, 0)), [0, 0, 0]);
}

#[test]
fn depth_falls_from_the_middle() {
    let Some(gpu) = Gpu::for_test() else { return };
    let Shaded { image, range } = draw(&gpu, Sphere::new(), &scene(), &view(), Picture::Depth);
    let range = range.expect("depth has a scale");
    // Nearest at 4; farthest where the tangent from 5 touches, √24.
    assert!((4.0..4.01).contains(&range.low) && (4.5..4.9).contains(&range.high), "{range:?}");
    assert!(pixel(&image, MIDDLE)[0] > pixel(&image, (MIDDLE.0 + 7, MIDDLE.1))[0]);
}

#[test]
fn work_is_a_heat_map() {
    let Some(gpu) = Gpu::for_test() else { return };
    let counting = || Sphere { counting: true, ..Sphere::new() };
    let picture = Picture::Work(WorkKind::Evaluations);
    let Shaded { image, range } = draw(&gpu, counting(), &scene(), &view(), picture);
    assert_eq!(range.expect("work has a scale").high, 1.0);
    // The two ends of viridis: yellow for the hits, purple for the misses, to the fit's 0.02.
    let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 6);
    assert!(near(pixel(&image, MIDDLE), [253, 231, 37]), "{:?}", pixel(&image, MIDDLE));
    assert!(near(pixel(&image, (0, 0)), [68, 1, 84]), "{:?}", pixel(&image, (0, 0)));

    let targets = targets(&gpu, &scene(), false);
    let refused = Shading::new(&gpu).draw(&targets, &view(), &scene(), picture);
    assert!(matches!(refused, Err(RenderError::NoTarget { what: "work" })));
}

#[test]
fn spheres_are_the_cores() {
    let Some(gpu) = Gpu::for_test() else { return };
    // The scene's one ball is its own surface: both pictures are of the unit sphere.
    let spheres = draw(&gpu, Sphere::new(), &scene(), &view(), Picture::Spheres).image;
    let surface = draw(&gpu, Sphere::new(), &scene(), &view(), Picture::Phong).image;
    let differing = spheres.rgba.iter().zip(&surface.rgba).filter(|(a, b)| a.abs_diff(**b) > 2);
    assert_eq!(differing.count(), 0);
}

/// What is drawn of spheres around the eye against an intersection of every sphere with every ray.
#[test]
fn spheres_near_the_eye_are_whole() {
    let Some(gpu) = Gpu::for_test() else { return };
    let offsets = [-1.9, -0.7, 0.4, 1.6];
    let balls: Vec<_> = (0..64)
        .map(|index| {
            let at = |shift: usize| offsets[index >> shift & 3];
            Metaball::new(Vec3::new(at(0), at(2), at(4)), 0.2 + 0.013 * index as f32)
        })
        .collect();
    let scene = Scene::new(balls, Kernel::Wyvill, 0.5).expect("legal");
    for distance in [0.01, 0.3, 1.1, 2.7] {
        let view = view_from(distance);
        let targets = targets(&gpu, &scene, false);
        let image = Shading::new(&gpu)
            .draw(&targets, &view, &scene, Picture::Spheres)
            .expect("draws")
            .image;
        let background = draw(
            &gpu,
            Sphere::new(),
            &Scene::new([], Kernel::Wyvill, 0.5).expect("legal"),
            &view,
            Picture::Phong,
        )
        .image;
        let mut seen = 0;
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                // Half of Wyvill's kernel is at half the support radius. The greatest of R² − d²
                // over the balls ahead says whether the ray meets one; within 1e-4 of a rim f32 may
                // differ.
                let eye = view.camera().eye().as_dvec3();
                let direction = view.camera().exact_direction(column, row, WIDTH, HEIGHT);
                let margin = scene
                    .balls()
                    .map(|ball| {
                        let radius = 0.5 * f64::from(ball.radius);
                        let offset = ball.center.as_dvec3() - eye;
                        let along = offset.dot(direction);
                        let near = (offset - along * direction).length_squared();
                        let chord = radius * radius - near;
                        // Ahead by as much as its far side is.
                        chord.min(along + chord.max(0.0).sqrt())
                    })
                    .fold(f64::NEG_INFINITY, f64::max);
                if margin.abs() < 1e-4 {
                    continue;
                }
                let at = (column, row);
                let is_sphere = pixel(&image, at) != pixel(&background, at);
                assert_eq!(is_sphere, margin > 0.0, "{at:?} from {distance}, margin {margin}");
                seen += usize::from(is_sphere);
            }
        }
        assert!(seen > 100, "{seen} pixels of spheres from {distance}");
    }
}
