//! Nishita and Nakamae's intervals along one ray (section 3.1).

use metaball_core::{Ray, Scene};

use super::bernstein::Sum;
use super::chord::Chord;
use super::clipping::Search;

/// The points of a ray in order, up to its nearest kernel sphere.
#[derive(Debug)]
pub(super) struct Intervals {
    /// t, and whose chord begins or ends there.
    points: Vec<(f64, usize)>,
    start: f64,
    end: f64,
    kernel_sphere: f64,
}

impl Intervals {
    /// Sorts the ends of the chords.
    pub(super) fn new(chords: &[Chord], ray: &Ray, kernel_sphere: f64) -> Self {
        let (start, end) = (f64::from(ray.t_min), f64::from(ray.t_max));
        let mut points = Vec::with_capacity(2 * chords.len());
        for (index, chord) in chords.iter().enumerate() {
            let enter = chord.enter().max(start);
            if enter <= kernel_sphere {
                points.push((enter, index));
                points.push((chord.leave(), index));
            }
        }
        points.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        Self { points, start, end, kernel_sphere }
    }

    /// t of the ray's first surface point.
    pub(super) fn first_hit(
        &self,
        scene: &Scene,
        chords: &[Chord],
        search: &mut Search,
    ) -> Option<f64> {
        let end = self.kernel_sphere.min(self.end);
        let mut active: Vec<usize> = Vec::new();
        let mut low = self.start;
        for &(t, ball) in &self.points {
            let high = t.min(end);
            if high > low {
                if let Some(t) = first_in(scene, chords, &active, (low, high), search) {
                    return Some(t);
                }
                low = high;
            }
            if t > end {
                break;
            }
            match active.iter().position(|&other| other == ball) {
                Some(index) => drop(active.swap_remove(index)),
                None => active.push(ball),
            }
        }
        // A kernel sphere lies in the solid: a ray that reaches it has hit.
        (self.kernel_sphere <= self.end).then_some(self.kernel_sphere)
    }
}

/// The first root in one interval, over which the same balls are active throughout.
fn first_in(
    scene: &Scene,
    chords: &[Chord],
    active: &[usize],
    (low, high): (f64, f64),
    search: &mut Search,
) -> Option<f64> {
    // The surface of a ball alone is its kernel sphere, which bounds the search.
    if active.len() < 2 {
        return None;
    }
    let mut sum = Sum::below(scene.kernel(), f64::from(scene.threshold()))?;
    for &ball in active {
        sum.add(&chords[ball], low, high);
    }
    let (points, degree) = sum.control_points();
    let root = search.first_root(&points, degree)?;
    Some(low + root * (high - low))
}
