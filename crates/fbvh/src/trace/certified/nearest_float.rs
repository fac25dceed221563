//! The float nearest to a root.
//!
//! Which float is nearest to a root depends on the ray and the leaf alone, and so does the field there:
//! however a search isolates a root, on whichever rays beside it, t and the normal come out the same to
//! the last bit. For that the field is always summed in f64, in the order of the leaf's list, at the
//! float itself.

use glam::DVec3;

/// What the field is at a float.
#[derive(Debug, Clone, Copy)]
pub(super) struct Excess {
    /// F − T.
    pub(super) value: f64,
    /// The gradient of F, 1/scene unit.
    pub(super) gradient: DVec3,
    /// Its product with the ray's direction: dF/dt.
    pub(super) slope: f64,
}

impl Excess {
    /// Whether one is below T and the other is not.
    fn is_across(&self, other: &Self) -> bool {
        (self.value < 0.0) != (other.value < 0.0)
    }
}

/// A search for the float nearest to the only root between two ends: Newton's steps, at last from float to
/// float.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearestFloat {
    /// Where to look at the field: a t of the ray.
    pub(super) at: f64,
    /// Where the root is, in the ray's t.
    ends: (f64, f64),
    /// The floats that may be the answer.
    limits: (f32, f32),
    /// The least radius of the leaf's balls.
    radius: f64,
    /// Whether the slope may jump between neighbouring floats, as for α = 1.
    has_kinks: bool,
    stage: Stage,
}

#[derive(Debug, Clone, Copy)]
enum Stage {
    /// On the way to the root.
    Approach,
    /// At a float, the root known about.
    Float { root: f64, before: Option<(f32, Excess)> },
    /// At the neighbour of the float before: one of the two it is.
    Neighbor { root: f64, before: (f32, Excess) },
}

/// What comes after a look.
pub(super) enum Next {
    /// A look at another place.
    Another,
    /// The nearest float, and the gradient there.
    Found(f32, DVec3),
    /// Newton's steps lead elsewhere: not decided here.
    Lost,
}

/// How many looks are taken: two are typical.
pub(super) const MOST_LOOKS: usize = 8;

/// A step that ends the approach, in radii: the next error is its square.
const CLOSE: f64 = 1e-4;

/// The widest gap between floats, in radii, over which the field is straight enough for Newton's steps from
/// float to float; where floats are coarser, rounding the root has to do.
const FINE: f64 = 1e-3;

/// How close, in gaps between floats, a root may be to the middle between two of them and still be
/// closer to one of them by Newton's step from either: the step errs by a part [`FINE`] of a gap at most.
const TIE: f64 = 4e-3;

impl NearestFloat {
    pub(super) fn new(
        guess: f64,
        ends: (f64, f64),
        limits: (f32, f32),
        radius: f64,
        has_kinks: bool,
    ) -> Self {
        Self { at: guess, ends, limits, radius, has_kinks, stage: Stage::Approach }
    }

    /// Takes what the field is at the place.
    pub(super) fn look(&mut self, here: Excess) -> Next {
        let exact = self.at - here.value / here.slope;
        match self.stage {
            Stage::Approach => {
                if !(self.ends.0 <= exact && exact <= self.ends.1) {
                    return Next::Lost;
                }
                let is_close = (exact - self.at).abs() <= CLOSE * self.radius;
                self.at = exact;
                if is_close {
                    self.go_to(self.float_at(exact), Stage::Float { root: exact, before: None });
                }
                Next::Another
            }
            Stage::Float { root, before } => self.look_at_float(here, exact, (root, before)),
            Stage::Neighbor { root, before } if before.1.is_across(&here) => {
                self.closer_of(before, here, root)
            }
            // Over a kink the step fell short.
            Stage::Neighbor { before, .. } => {
                self.look_at_float(here, exact, (exact, Some(before)))
            }
        }
    }

    fn look_at_float(
        &mut self,
        here: Excess,
        exact: f64,
        (root, before): (f64, Option<(f32, Excess)>),
    ) -> Next {
        let t = self.at as f32;
        let gap = gap_at(t);
        if gap > FINE * self.radius {
            return self.found(t, here, root);
        }
        let next = self.float_at(exact);
        if next != t {
            return match before {
                Some((float, there)) if float == next => {
                    self.closer_of((float, there), here, exact)
                }
                _ => {
                    self.go_to(next, Stage::Float { root: exact, before: Some((t, here)) });
                    Next::Another
                }
            };
        }
        let neighbor = if exact > self.at { t.next_up() } else { t.next_down() };
        let share = (exact - self.at) / (f64::from(neighbor) - self.at);
        let is_tie = (share - 0.5).abs() <= TIE || self.has_kinks && exact != self.at;
        if !is_tie || neighbor < self.limits.0 || neighbor > self.limits.1 {
            return self.found(t, here, exact);
        }
        match before {
            Some((float, there)) if float == neighbor => {
                self.closer_of((float, there), here, exact)
            }
            _ => {
                self.go_to(neighbor, Stage::Neighbor { root: exact, before: (t, here) });
                Next::Another
            }
        }
    }

    /// Of two floats the one where the field is closer to T. Where it is on either side of T the root is
    /// between them, wherever a step over a kink may lead.
    fn closer_of(&self, (other, there): (f32, Excess), here: Excess, root: f64) -> Next {
        let t = self.at as f32;
        let (least, most) = (other.min(t).into(), other.max(t).into());
        let root = if there.is_across(&here) { root.clamp(least, most) } else { root };
        let is_other = (there.value.abs(), other) < (here.value.abs(), t);
        if is_other { self.found(other, there, root) } else { self.found(t, here, root) }
    }

    /// The answer, if it is next to the root, and the root between the ends.
    fn found(&self, t: f32, here: Excess, root: f64) -> Next {
        let is_between = self.ends.0 <= root && root <= self.ends.1;
        let is_limit = t == self.limits.0 || t == self.limits.1;
        let is_near = is_limit || (f64::from(t) - root).abs() <= gap_at(t);
        if is_between && is_near { Next::Found(t, here.gradient) } else { Next::Lost }
    }

    fn go_to(&mut self, float: f32, stage: Stage) {
        self.at = float.into();
        self.stage = stage;
    }

    /// The float nearest to a place, within the limits.
    fn float_at(&self, t: f64) -> f32 {
        (t as f32).max(self.limits.0).min(self.limits.1)
    }
}

/// The gap from a float to the next one away from 0.
fn gap_at(t: f32) -> f64 {
    f64::from(t.abs().next_up()) - f64::from(t.abs())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The answer from a guess, for a root between 0 and 10 of a field with radii of this size; `None`
    /// where none is found.
    fn nearest(
        guess: f64,
        radius: f64,
        has_kinks: bool,
        field: impl Fn(f64) -> (f64, f64),
    ) -> Option<f32> {
        let mut search = NearestFloat::new(guess, (0.0, 10.0), (0.0, 10.0), radius, has_kinks);
        for _ in 0..MOST_LOOKS {
            let (value, slope) = field(search.at);
            match search.look(Excess { value, gradient: DVec3::splat(slope), slope }) {
                Next::Another => {}
                Next::Found(t, _) => return Some(t),
                Next::Lost => return None,
            }
        }
        None
    }

    proptest! {
        /// On a line that has a kink at most a few floats from its root.
        #[test]
        fn the_answer_does_not_depend_on_the_guess(
            float in 1.0f32..2.0, share in 0.0f64..1.0, near in prop::bool::ANY,
            guesses in [-4.0f64..4.0, -4.0..4.0], slopes in (0.5f64..2.0, 0.5..2.0), kink in -2.0f64..2.0,
        ) {
            let gap = f64::from(float.next_up()) - f64::from(float);
            // Half of the roots lie near the middle between two floats.
            let share = if near { 0.5 + 1e-9 * (share - 0.5) } else { share };
            let root = f64::from(float) + share * gap;
            let kink = root + kink * gap;
            let field = |t: f64| {
                let at = |t: f64| if t < kink { slopes.0 * (t - kink) } else { slopes.1 * (t - kink) };
                (at(t) - at(root), if t < kink { slopes.0 } else { slopes.1 })
            };
            let found = guesses.map(|guess| nearest(root + guess * gap, 1.0, true, field));
            for t in found.into_iter().flatten() {
                let off = (f64::from(t) - root).abs() / gap;
                let most = if (kink - root).abs() > gap { 0.5 + TIE } else { 1.0 };
                prop_assert!(off <= most, "{} gaps", off);
            }
            match found {
                [Some(a), Some(b)] => prop_assert_eq!(a, b),
                // Around a kink so close it may be left to another search.
                _ => prop_assert!((kink - root).abs() < gap),
            }
        }

        /// On a curve whose width is no more than some floats, or many.
        #[test]
        fn what_is_found_is_next_to_the_root(
            root in 1.0f64..9.0, guess in -1.0f64..1.0, width in -8.0f64..0.0,
        ) {
            let width = 10f64.powf(width);
            let field = |t: f64| {
                let x = (t - root) / width;
                (x / (1.0 + x * x).sqrt(), (1.0 + x * x).powf(-1.5) / width)
            };
            if let Some(t) = nearest(root + guess * width, width, false, field) {
                prop_assert!((f64::from(t) - root).abs() <= gap_at(t));
            } else {
                prop_assert!(guess.abs() > 0.9);
            }
        }
    }

    #[test]
    fn what_is_flat_or_turns_back_has_no_root() {
        assert_eq!(nearest(1.5, 1.0, false, |_| (1.0, 0.0)), None);
        assert_eq!(nearest(1.5, 1.0, false, |t| ((t - 1.5).powi(2) + 1e-3, 2.0 * (t - 1.5))), None);
    }
}
