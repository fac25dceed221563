//! The surface inside leaves, and solid leaves solid.

use glam::DVec3;
use metaball_core::Support;
use rayon::prelude::*;

use super::flaw::Flaw;
use super::neighbors::Neighbors;
use super::samples::{ROUNDING, lattice, squared_distance, value};
use crate::tree::Child;
use crate::{Field, Kind, Tree};

impl Tree {
    pub(super) fn check_surface(&self, field: &impl Field) -> Result<(), Flaw> {
        let neighbors = Neighbors::new(field);
        let directions = (0..27)
            .map(|at| DVec3::new((at % 3) as f64, (at / 3 % 3) as f64, (at / 9) as f64) - 1.0)
            .filter(|direction| *direction != DVec3::ZERO)
            .map(DVec3::normalize);
        let directions: Vec<DVec3> = directions.collect();
        let outside = (0..field.ball_count()).into_par_iter().find_map_first(|ball| {
            let near = neighbors.of(field, ball);
            let mut points = directions
                .iter()
                .filter_map(|&direction| surface_from(field, &near, ball, direction));
            let point = points.find(|&point| !self.is_in_leaf(point))?;
            Some(Flaw::SurfaceOutside { ball: ball as u32, point })
        });
        outside.map_or(Ok(()), Err)
    }

    pub(super) fn check_solids(&self, field: &impl Field) -> Result<(), Flaw> {
        let threshold = f64::from(field.threshold());
        let is_solid = |leaf: usize| {
            self.kind == Kind::Certified && self.leaves[leaf].first == self.leaves[leaf + 1].first
        };
        for leaf in (0..self.leaf_count()).filter(|&leaf| is_solid(leaf)) {
            let bounds = self.leaves[leaf].bounds();
            let near: Vec<u32> = (0..field.ball_count() as u32)
                .filter(|&ball| {
                    let Support { center, radius } = field.support(ball as usize);
                    squared_distance(center, &bounds) < f64::from(radius).powi(2)
                })
                .collect();
            let low = lattice(&bounds).find(|&point| value(field, &near, point) <= threshold);
            if let Some(point) = low {
                return Err(Flaw::NotSolid { leaf, point });
            }
        }
        Ok(())
    }

    /// Whether the point is in any leaf's closed box.
    fn is_in_leaf(&self, point: DVec3) -> bool {
        let mut is_held = false;
        self.visit(|child, bounds, _| {
            let inside = point.cmpge(bounds.min.as_dvec3()).all()
                && point.cmple(bounds.max.as_dvec3()).all();
            is_held |= inside && matches!(child, Child::Leaf(_));
            inside && !is_held
        });
        is_held
    }
}

/// The last point of the solid before the field first falls below T on the way from a ball's centre
/// to the rim of its support; `None` where it starts below or stays above.
fn surface_from(field: &impl Field, near: &[u32], ball: usize, direction: DVec3) -> Option<DVec3> {
    const STEPS: usize = 32;
    let Support { center, radius } = field.support(ball);
    let (start, length) = (center.as_dvec3(), f64::from(radius));
    let at = |part: f64| start + part * length * direction;
    let near: Vec<u32> = near
        .iter()
        .copied()
        .filter(|&other| meets(&field.support(other as usize), start, direction, length))
        .collect();
    // A hair above T: a field that only just touches T at a point has no surface to lose.
    let threshold = f64::from(field.threshold()) * (1.0 + 1e-9);
    let solid = |part: f64| value(field, &near, at(part)) >= threshold;
    if !solid(0.0) {
        return None;
    }
    let first_below = (1..=STEPS).find(|&step| !solid(step as f64 / STEPS as f64))?;
    let (mut inside, mut outside) =
        ((first_below - 1) as f64 / STEPS as f64, first_below as f64 / STEPS as f64);
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (inside + outside);
        if solid(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(at(inside))
}

/// Whether a support, grown by more than rounding, holds a point of the line from `start`, `length`
/// long in a unit direction. Balls that do not add nothing there.
fn meets(support: &Support, start: DVec3, direction: DVec3, length: f64) -> bool {
    let to_center = support.center.as_dvec3() - start;
    let nearest = to_center.dot(direction).clamp(0.0, length) * direction;
    let reach = f64::from(support.radius) * (1.0 + ROUNDING);
    to_center.distance_squared(nearest) <= reach * reach
}
