//! Where a ray enters and leaves supports, to the rounding of f32: what depth peeling depends on.

use metaball_core::{Metaball, Ray, Scene};

/// The points of one ray up to some distance.
#[derive(Debug)]
pub struct Points {
    /// Pairs of points of different balls that f32 may take for one.
    pub coincident: usize,
    /// The most supports over one point, widened by rounding at both ends.
    pub overlap: usize,
}

/// A ball's interval of a ray.
struct Chord {
    enter: f64,
    leave: f64,
    /// How far both ends can be off in f32.
    rounding: f64,
}

impl Points {
    /// The points at 0 ≤ t ≤ `end`, rounding allowed for.
    pub fn up_to(end: f64, scene: &Scene, ray: &Ray) -> Self {
        let chords: Vec<_> = scene
            .balls()
            .filter_map(|ball| Chord::new(&ball, ray))
            .filter(|chord| {
                chord.leave + chord.rounding > 0.0 && chord.enter - chord.rounding <= end
            })
            .collect();
        Self { coincident: coincident(&chords, end), overlap: overlap(&chords, end) }
    }
}

impl Chord {
    /// With u = 2⁻²³, the error of one operation: the projection m is a sum of three products of
    /// rounded numbers, wrong by 5u·D at the distance D of the centre; the vector q from the ray to
    /// the centre by that, the product's and the difference's rounding, below 10u·D; Q² = R² − |q|²
    /// by 20u·D·|q| + 8u·R². The error of Q is half of that over Q, and never above its root.
    fn new(ball: &Metaball, ray: &Ray) -> Option<Self> {
        let unit = f64::from(f32::EPSILON);
        let to_center = ball.center.as_dvec3() - ray.origin.as_dvec3();
        let direction = ray.direction.as_dvec3();
        let middle = to_center.dot(direction) / direction.length_squared();
        let off_axis = (to_center - middle * direction).length();
        let (radius, distance) = (f64::from(ball.radius), to_center.length());
        let half_squared = radius * radius - off_axis * off_axis;
        let of_square = unit * (20.0 * distance * off_axis + 8.0 * radius * radius);
        if half_squared <= -of_square {
            return None;
        }
        let half = half_squared.max(0.0).sqrt();
        let of_half = if half > 0.0 { of_square / half } else { f64::INFINITY };
        Some(Self {
            enter: middle - half,
            leave: middle + half,
            rounding: unit * (5.0 * distance + middle.abs() + half)
                + of_half.min((2.0 * of_square).sqrt()),
        })
    }
}

fn coincident(chords: &[Chord], end: f64) -> usize {
    let mut points: Vec<(f64, f64, usize)> = Vec::new();
    for (ball, chord) in chords.iter().enumerate() {
        for t in [chord.enter, chord.leave] {
            let (from, to) = (t - chord.rounding, t + chord.rounding);
            if to >= 0.0 && from <= end {
                points.push((from, to, ball));
            }
        }
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let pairs_from = |(index, &(_, to, ball)): (usize, &(f64, f64, usize))| {
        let near = points[index + 1..].iter().take_while(|other| other.0 <= to);
        near.filter(|other| other.2 != ball).count()
    };
    points.iter().enumerate().map(pairs_from).sum()
}

fn overlap(chords: &[Chord], end: f64) -> usize {
    let mut changes: Vec<(f64, isize)> = Vec::new();
    for chord in chords {
        changes.push(((chord.enter - chord.rounding).max(0.0), 1));
        changes.push((chord.leave + chord.rounding, -1));
    }
    // Who enters where another leaves is there together with it.
    changes.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let mut here = 0;
    let before = changes.iter().take_while(|(t, _)| *t <= end);
    let most = before.map(|(_, change)| {
        here += change;
        here
    });
    most.max().unwrap_or(0).unsigned_abs()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::Kernel;

    use super::*;

    fn points(centers: &[f32], end: f64) -> Points {
        let balls = centers.iter().map(|&z| Metaball::new(Vec3::new(0.0, 0.0, z), 1.0));
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.5).expect("legal");
        Points::up_to(end, &scene, &Ray::new(Vec3::ZERO, Vec3::Z))
    }

    #[test]
    fn coincident_points_are_counted_once_a_pair() {
        assert_eq!(points(&[5.0, 5.0], 10.0).coincident, 2);
        assert_eq!(points(&[5.0, 5.0], 4.5).coincident, 1);
        assert_eq!(points(&[5.0, 7.0], 10.0).coincident, 1);
        assert_eq!(points(&[5.0, 7.1], 10.0).coincident, 0);
        assert_eq!(points(&[5.0, 5.0], 3.0).coincident, 0);
    }

    #[test]
    fn overlap_is_the_most_at_one_point() {
        assert_eq!(points(&[5.0, 5.1, 5.2, 9.0], 20.0).overlap, 3);
        assert_eq!(points(&[5.0, 5.1, 5.2], 4.15).overlap, 2);
        assert_eq!(points(&[0.5, -0.5, -5.0], 20.0).overlap, 2);
        assert_eq!(points(&[], 20.0).overlap, 0);
    }
}
