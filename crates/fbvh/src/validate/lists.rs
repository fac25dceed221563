//! Who owns a ball, and whether lists are complete.

use metaball_core::{Aabb, Support};

use super::flaw::Flaw;
use super::samples::{ROUNDING, lattice, overlap, squared_distance, value};
use crate::tree::Child;
use crate::{Field, Kind, Tree};

impl Tree {
    pub(super) fn check_lists(&self, field: &impl Field) -> Result<(), Flaw> {
        let mut owners = vec![0usize; field.ball_count()];
        let mut seen = vec![usize::MAX; field.ball_count()];
        for leaf in 0..self.leaf_count() {
            let (own, split) = self.leaf_balls(leaf);
            for &ball in own.iter().chain(split) {
                match seen.get_mut(ball as usize) {
                    Some(seen) if *seen != leaf => *seen = leaf,
                    _ => return Err(Flaw::Listing { leaf, ball }),
                }
            }
            let bounds = self.leaves[leaf].bounds();
            for &ball in own {
                owners[ball as usize] += 1;
                let Support { center, radius } = field.support(ball as usize);
                if self.kind == Kind::ModifiedBvh
                    && bounds.union(&Aabb::around_sphere(center, radius)) != bounds
                {
                    return Err(Flaw::OwnOutside { leaf, ball });
                }
            }
        }
        // Where a ball does not reach its own leaf's fitted box, it is nobody's own.
        let legal = match self.kind {
            Kind::ModifiedBvh => 1..=1,
            Kind::Fitted => 0..=1,
            Kind::Certified => 0..=0,
        };
        match owners.iter().position(|found| !legal.contains(found)) {
            Some(ball) => Err(Flaw::Ownership { ball: ball as u32, found: owners[ball] }),
            None => Ok(()),
        }
    }

    pub(super) fn check_completeness(&self, field: &impl Field) -> Result<(), Flaw> {
        let mut missing = vec![Vec::new(); self.leaf_count()];
        for ball in 0..field.ball_count() {
            let Support { center, radius } = field.support(ball);
            let reach = f64::from(radius) * (1.0 - ROUNDING);
            self.visit(|child, bounds, _| {
                if squared_distance(center, bounds) >= reach * reach {
                    return false;
                }
                if let Child::Leaf(leaf) = *child {
                    let (own, split) = self.leaf_balls(leaf);
                    let due = match self.kind {
                        Kind::ModifiedBvh => own.iter().any(|&other| {
                            overlap(&field.support(ball), &field.support(other as usize))
                        }),
                        Kind::Fitted => true,
                        // A leaf without a list is solid.
                        Kind::Certified => !split.is_empty(),
                    };
                    if due && !own.contains(&(ball as u32)) && !split.contains(&(ball as u32)) {
                        missing[leaf].push(ball as u32);
                    }
                }
                true
            });
        }
        for (leaf, missing) in missing.iter().enumerate() {
            let Some(&ball) = missing.first() else { continue };
            if self.kind == Kind::ModifiedBvh || self.matter(field, leaf, missing) {
                return Err(Flaw::Incomplete { leaf, ball });
            }
        }
        Ok(())
    }

    /// Whether balls that reach a leaf's box but are not listed lift the field to T anywhere there, or lower it:
    /// on a lattice over the part of the box that each of them reaches.
    fn matter(&self, field: &impl Field, leaf: usize, missing: &[u32]) -> bool {
        let threshold = f64::from(field.threshold());
        let (own, split) = self.leaf_balls(leaf);
        let listed: Vec<u32> = own.iter().chain(split).copied().collect();
        missing.iter().any(|&ball| {
            let Support { center, radius } = field.support(ball as usize);
            let part =
                Aabb::around_sphere(center, radius).intersection(&self.leaves[leaf].bounds());
            lattice(&part).any(|point| {
                let with_list = value(field, &listed, point);
                let whole = with_list + value(field, missing, point);
                with_list < threshold * (1.0 - ROUNDING) && whole > threshold
                    || with_list > threshold * (1.0 + ROUNDING) && whole < threshold
            })
        })
    }
}
