//! What the CPU alone draws, with the certified tree.

use fbvh::Kind;
use metaball_core::Scene;

use crate::backend::Opened;
use crate::{DrawOptions, Error};

impl DrawOptions {
    /// What only the certified tree on the CPU gives, of these options and of a scene, if there is any.
    pub(crate) fn cpu_alone(&self, scene: Option<&Scene>) -> Option<&'static str> {
        let clips = (!self.clip.is_all()).then_some("clip");
        let negative = scene.and_then(Scene::negative_ball).map(|_| "negative strengths");
        clips.or(self.light.is_see_through().then_some("opacity")).or(negative)
    }

    /// Opens the CPU for such an option, if nothing else was asked for.
    pub(crate) fn open_cpu(&self, option: &'static str) -> Result<Opened, Error> {
        let refused = |needed: &str, found: String| {
            Err(Error::Option { option, needed: needed.to_owned(), found })
        };
        if self.method.tree().is_none_or(|options| options.kind() != Kind::Certified) {
            let found = format!("method {}", self.method.name());
            return refused("method fbvh-certified, which alone has it", found);
        }
        match self.backend.adapter_asked() {
            Some(adapter) => refused("the CPU, which alone has it", adapter),
            None => Ok(Opened::cpu(format!("it alone has {option}"))),
        }
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use bench_scenes::{Overrides, load};
    use glam::Vec3;
    use metaball_core::gpu::AdapterChoice;
    use metaball_core::reference::Oracle;
    use metaball_core::{
        Aabb, Clip, Color, Hit, Image, Metaball, Picture, Ray, Scene, Verdict, View,
    };

    use super::*;
    use crate::{Backend, Drawing, LightOptions, Method, draw};

    const SIZE: (u32, u32) = (48, 36);

    fn drawn(clip: Clip, picture: Picture) -> (Scene, Vec<Ray>, Drawing) {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let base = DrawOptions { backend: Backend::Cpu, ..DrawOptions::default() };
        let options = DrawOptions { size: SIZE, clip, picture, ..base };
        let drawing = draw(&bench.scene, &bench.camera, &options).expect("drawn");
        let rays = View::new(bench.camera, SIZE.0, SIZE.1).expect("a size").rays();
        (bench.scene, rays, drawing)
    }

    /// Outward normals and offsets of planes through the scene, no numbers that boxes of balls have.
    const CORNER: [(Vec3, f32); 2] = [(Vec3::X, 0.301), (Vec3::Z, 0.203)];

    fn corner() -> Clip {
        CORNER.iter().fold(Clip::default(), |clip, &(normal, offset)| {
            clip.and_plane(normal, offset.into()).expect("a plane")
        })
    }

    /// Pixels that are wrong: what is hit is neither the first of the surface within the region, nor the
    /// face by which the ray enters it, where the field is T or more.
    fn wrong_pixels(scene: &Scene, rays: &[Ray], hits: &[Hit]) -> usize {
        let oracle = Oracle::new(scene);
        let wrong = |(ray, hit): (&Ray, &Hit)| {
            let (mut part, mut face) = (*ray, Vec3::ZERO);
            for (normal, offset) in CORNER {
                let t = (offset - ray.origin.dot(normal)) / ray.direction.dot(normal);
                if ray.direction.dot(normal) > 0.0 {
                    part.t_max = part.t_max.min(t);
                } else if t > part.t_min {
                    (part.t_min, face) = (t, normal);
                }
            }
            let truth = oracle.first_hit(&part);
            let is_near = (f64::from(hit.t) - truth.t).abs() < 1e-5;
            let is_right = match truth.verdict {
                Verdict::Miss => hit.verdict == Verdict::Miss,
                Verdict::Inside => hit.verdict == Verdict::Hit && is_near && hit.normal == face,
                _ => hit.verdict == Verdict::Hit && is_near,
            };
            // The ends of the part, in f32, are off by some roundings.
            truth.margin > 1e-3 && !is_right
        };
        rays.iter().zip(hits).filter(|pair| wrong(*pair)).count()
    }

    #[test]
    fn cut_pictures_are_the_oracles() {
        let (scene, rays, cut) = drawn(corner(), Picture::Phong);
        let on_faces = |axis| cut.hits.iter().filter(|hit| hit.normal == axis).count();
        assert!(on_faces(Vec3::Z) > 50, "{}", on_faces(Vec3::Z));
        assert_eq!(wrong_pixels(&scene, &rays, &cut.hits), 0);
        let (.., whole) = drawn(Clip::default(), Picture::Phong);
        assert!(wrong_pixels(&scene, &rays, &whole.hits) > 100);
        assert_ne!(cut.image, whole.image);
    }

    /// Each ball of the field colours the face by its share.
    #[test]
    fn faces_have_the_colour_of_the_solid() {
        let (scene, rays, cut) = drawn(corner(), Picture::Color);
        let colors = scene.colors().expect("coloured");
        let mut faces = 0;
        for (pixel, (ray, hit)) in rays.iter().zip(&cut.hits).enumerate() {
            if hit.normal != Vec3::Z {
                continue;
            }
            faces += 1;
            let point = ray.origin + hit.t * ray.direction;
            let mut blended = [Vec3::ZERO, Vec3::ZERO];
            for (ball, color) in scene.balls().zip(colors) {
                let share = point.distance_squared(ball.center) / ball.radius.powi(2);
                let weight = ball.strength * scene.kernel().value(share.into()) as f32;
                blended[0] += weight * color.to_linear();
                blended[1] += weight;
            }
            let wanted = Color::from_linear(blended[0] / blended[1]);
            let wanted = Image::new(1, 1, &[wanted]).rgba;
            let found = &cut.image.rgba[4 * pixel..][..4];
            let worst = found.iter().zip(&wanted).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(worst <= Some(1), "{found:?} for {wanted:?}");
        }
        assert!(faces > 50, "{faces}");
    }

    #[test]
    fn what_cannot_cut_is_refused_by_name() {
        let bench = load("colors-100", &Overrides::default()).expect("known");
        let base = DrawOptions { size: (4, 4), clip: corner(), ..DrawOptions::default() };
        let refusal = |options: DrawOptions| {
            draw(&bench.scene, &bench.camera, &options).expect_err("refused").to_string()
        };
        let fitted = Method::Tree(fbvh::Options::fitted());
        let error = refusal(DrawOptions { method: fitted, ..base.clone() });
        assert_eq!(
            error,
            "clip: needed method fbvh-certified, which alone has it, found method fbvh"
        );
        let software = Backend::Adapter(AdapterChoice::Software);
        let error = refusal(DrawOptions { backend: software, ..base.clone() });
        assert!(error.starts_with("clip: needed the CPU"), "{error}");
        let whole = DrawOptions { clip: Clip::default(), ..base.clone() };
        let light = LightOptions { opacity: Some(0.5), ..LightOptions::default() };
        let backend = Backend::Adapter(AdapterChoice::Software);
        let error = refusal(DrawOptions { light: light.clone(), backend, ..whole.clone() });
        assert!(error.starts_with("opacity: needed the CPU"), "{error}");
        let opened = DrawOptions { light, ..whole.clone() }.open(None);
        match Backend::Fastest.adapter_asked() {
            Some(_) => assert!(opened.is_err()),
            None => {
                let by = opened.expect("the CPU").describe();
                assert!(by.starts_with("the CPU") && by.ends_with("it alone has opacity"), "{by}");
            }
        }
        let carved = bench.scene.balls().enumerate().map(|(index, ball)| Metaball {
            strength: if index == 0 { -ball.strength } else { ball.strength },
            ..ball
        });
        let carved = Scene::new(carved, bench.scene.kernel(), 0.3).expect("legal");
        assert_eq!(base.cpu_alone(Some(&bench.scene)), Some("clip"));
        assert_eq!(whole.cpu_alone(Some(&bench.scene)), None);
        assert_eq!(whole.cpu_alone(Some(&carved)), Some("negative strengths"));
        let nothing = Aabb { min: Vec3::splat(50.0), max: Vec3::splat(51.0) };
        let clip = Clip::default().and_box(&nothing).expect("a box");
        let options = DrawOptions { clip, backend: Backend::Cpu, ..base };
        let empty = draw(&bench.scene, &bench.camera, &options);
        assert_eq!(empty.expect("drawn").hit_count(), 0);
    }
}
