//! How far a method's picture is from the reference: [`scoring`] has the definitions.

use metaball_core::Hit;
pub use scoring::{
    Accuracy, Finding, Judgement, NormalDegrees, RadiusError, is_hit, many_are_ambiguous,
};

use crate::reference::Reference;

/// Compares a method's image, row by row from the top left, with the reference.
///
/// # Errors
/// When the image has another number of pixels than the reference's.
pub fn score(reference: &Reference, hits: &[Hit]) -> anyhow::Result<Accuracy> {
    anyhow::ensure!(
        hits.len() == reference.image_pixels(),
        "hits: needed {} × {} pixels, found {}",
        reference.width(),
        reference.height(),
        hits.len()
    );
    let rays = reference.rays().map(|(pixel, truth)| (truth, &hits[pixel]));
    Ok(scoring::score(rays, reference.subset()))
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use metaball_core::reference::Truth;
    use metaball_core::{Camera, Ray, Verdict, View};

    use super::*;

    const SIZE: u32 = 48;

    /// The surface of balls that do not touch is spheres: truth without any oracle.
    fn truth(spheres: &[(DVec3, f64)], ray: &Ray) -> Truth {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let nearest = spheres
            .iter()
            .filter_map(|&(center, radius)| {
                let to_center = center - origin;
                let middle = to_center.dot(direction);
                let rise = radius * radius - (to_center - middle * direction).length_squared();
                (rise >= 0.0).then(|| (middle - rise.sqrt(), center))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((t, center)) = nearest else {
            return Truth {
                verdict: Verdict::Miss,
                t: f64::INFINITY,
                exit: f64::INFINITY,
                normal: DVec3::ZERO,
                margin: 1.0,
                smallest_radius: 0.0,
            };
        };
        Truth {
            verdict: Verdict::Hit,
            t,
            exit: t + 0.1,
            normal: (origin + t * direction - center).normalize(),
            margin: 1.0,
            smallest_radius: 2.0,
        }
    }

    fn rays() -> Vec<Ray> {
        let eye = Vec3::new(0.0, 0.0, 6.0);
        let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 50.0).expect("legal");
        let view = View::new(camera, SIZE, SIZE).expect("legal");
        let pixel = |index: u32| {
            let direction =
                view.camera().exact_direction(index % SIZE, index / SIZE, SIZE, SIZE).as_vec3();
            Ray::new(eye, direction)
        };
        (0..SIZE * SIZE).map(pixel).collect()
    }

    const TWO: [(DVec3, f64); 2] =
        [(DVec3::new(-1.3, 0.0, 0.0), 1.0), (DVec3::new(1.3, 0.4, 0.0), 0.9)];

    fn reference() -> Reference {
        let truths = rays().iter().map(|ray| truth(&TWO, ray)).collect();
        Reference::of_every_pixel((SIZE, SIZE), truths)
    }

    /// What a method that is right to f32 finds.
    fn good() -> Vec<Hit> {
        reference().hits()
    }

    #[test]
    fn a_right_picture_scores_well() {
        let accuracy = score(&reference(), &good()).expect("equal sizes");
        assert_eq!(accuracy.rays, (SIZE * SIZE) as usize);
        assert!(accuracy.oracle_hits > 100);
        assert_eq!((accuracy.wrong_verdicts(), accuracy.ambiguous), (0, 0));
        // Rounding t < 8 to f32 errs by at most 2.4e-7, normals by 6e-8 in each coordinate.
        assert!(accuracy.t_error_over_radius.expect("hits").max < 2.4e-7);
        assert!(accuracy.rel_rms_t.expect("hits") < 6e-8);
        assert!(accuracy.normal_degrees.expect("hits").max < 1.1e-7_f64.to_degrees());
    }

    #[test]
    fn canary_shifted_by_a_pixel() {
        let mut hits = good();
        hits.rotate_right(1);
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert!(accuracy.false_negative > 10 && accuracy.false_positive > 10, "{accuracy:?}");
    }

    #[test]
    fn canary_flipped_normal() {
        let mut hits = good();
        let hit = hits.iter_mut().find(|hit| hit.is_hit()).expect("there are hits");
        hit.normal = -hit.normal;
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert!(accuracy.normal_degrees.expect("hits").max > 179.9);
    }

    #[test]
    fn canary_missing_ball() {
        let without: Vec<_> = rays().iter().map(|ray| truth(&TWO[..1], ray)).collect();
        let hits = Reference::of_every_pixel((SIZE, SIZE), without).hits();
        assert!(score(&reference(), &hits).expect("equal sizes").false_negative > 50);
    }

    #[test]
    fn canary_truncated_buffer() {
        let mut hits = good();
        hits.pop();
        let error = score(&reference(), &hits).expect_err("a pixel is missing");
        assert_eq!(error.to_string(), "hits: needed 48 × 48 pixels, found 2303");
    }

    #[test]
    fn broken_numbers_are_never_good() {
        let mut hits = good();
        let hit = hits.iter_mut().find(|hit| hit.is_hit()).expect("there are hits");
        hit.t = f32::NAN;
        hit.normal = Vec3::NAN;
        let accuracy = score(&reference(), &hits).expect("equal sizes");
        assert_eq!(accuracy.wrong_front, 1);
        assert_eq!(accuracy.t_error_over_radius.expect("hits").max, f64::INFINITY);
        assert_eq!(accuracy.rel_rms_t, Some(f64::INFINITY));
        assert_eq!(accuracy.normal_degrees.expect("hits").max, 180.0);
    }

    fn judge(truth: Truth, hit: Hit) -> Judgement {
        Judgement::new(&truth, &hit)
    }

    #[test]
    fn fronts_are_wrong_beyond_a_twentieth_of_a_radius() {
        let ray = Ray::new(Vec3::new(-1.3, 0.0, 6.0), Vec3::NEG_Z);
        let truth = truth(&TWO, &ray);
        assert!((truth.t - 5.0).abs() < 1e-12 && truth.smallest_radius == 2.0);
        let at = |t| Hit { verdict: Verdict::Hit, fallback: false, t, normal: Vec3::Z };
        assert!(!judge(truth, at(5.09)).is_wrong());
        assert!(judge(truth, at(5.11)).is_wrong());
        assert!(judge(truth, at(4.89)).is_wrong());
        assert!(judge(truth, Hit::MISS).is_wrong());
        // The same error on an ambiguous ray is counted there and not here.
        let ambiguous = Truth { margin: 1e-5, ..truth };
        assert!(judge(ambiguous, Hit::MISS).ambiguous && !judge(ambiguous, Hit::MISS).is_wrong());
        let clear = Truth { margin: 1.1e-5, ..truth };
        assert!(judge(clear, Hit::MISS).is_wrong());
    }

    #[test]
    fn inside_counts_as_a_hit_and_undecided_as_neither() {
        let ray = Ray::new(Vec3::new(-1.3, 0.0, 6.0), Vec3::NEG_Z);
        let inside = Truth { verdict: Verdict::Inside, t: 0.0, ..truth(&TWO, &ray) };
        let hit = Hit { verdict: Verdict::Inside, fallback: false, t: 0.0, normal: Vec3::Z };
        assert_eq!(judge(inside, hit).finding, Finding::Hit { error: 0.0 });
        let reference = Reference::of_every_pixel((1, 1), vec![inside]);
        let accuracy = score(&reference, &[hit]).expect("equal sizes");
        assert_eq!((accuracy.oracle_hits, accuracy.rel_rms_t), (1, None));

        let undecided = Hit { verdict: Verdict::Undecided, ..hit };
        assert!(!judge(inside, undecided).is_wrong());
        let accuracy = score(&reference, &[undecided]).expect("equal sizes");
        assert_eq!((accuracy.wrong_verdicts(), accuracy.t_error_over_radius), (0, None));
    }
}
