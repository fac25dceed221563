//! The lists of nodes that are still to be divided.

use std::ops::Range;

use glam::Vec3A;
use metaball_core::Aabb;

use super::ball::Ball;
use super::plane::Plane;

/// A pool of at least so many balls gives back the room that it does not need; in a smaller one lists soon
/// take it again.
const SPARING_FROM: usize = 1 << 16;

/// Lists of balls on a stack.
#[derive(Default)]
pub(super) struct Pool {
    /// What lies behind `top` is meaningless.
    balls: Vec<Ball>,
    top: usize,
}

impl Pool {
    /// A list that is alone.
    pub(super) fn new(list: Vec<Ball>) -> Self {
        Self { top: list.len(), balls: list }
    }

    /// The end of the topmost list.
    pub(super) fn top(&self) -> usize {
        self.top
    }

    /// Takes away all lists that end behind.
    pub(super) fn truncate(&mut self, top: usize) {
        self.top = top;
    }

    pub(super) fn list(&self, list: &Range<usize>) -> &[Ball] {
        &self.balls[list.clone()]
    }

    pub(super) fn list_mut(&mut self, list: &Range<usize>) -> &mut [Ball] {
        &mut self.balls[list.clone()]
    }

    /// One ball.
    pub(super) fn ball(&self, at: usize) -> Ball {
        self.balls[at]
    }

    /// Puts a ball on top.
    pub(super) fn push(&mut self, ball: Ball) {
        self.balls.truncate(self.top);
        self.balls.push(ball);
        self.top += 1;
    }

    /// Takes a list out, and keeps the others that end before `top`.
    pub(super) fn split_off(&mut self, list: &Range<usize>, top: usize) -> Self {
        let taken = self.balls[list.clone()].to_vec();
        self.top = top;
        if top >= SPARING_FROM {
            self.balls.truncate(top);
            self.balls.shrink_to_fit();
        }
        Self::new(taken)
    }

    /// Divides the list of a node that is cut in two: what reaches the left goes on top, what reaches the
    /// right overwrites the node's list. Balls reach the node's box; so each reaches the part on whose
    /// side its centre is, and the other one if it reaches the face between them.
    pub(super) fn divide(
        &mut self,
        list: &Range<usize>,
        plane: &Plane,
        face: &Aabb,
    ) -> (Range<usize>, Range<usize>) {
        let mut end = Vec3A::INFINITY;
        end[plane.axis] = plane.at;

        let top = self.top;
        if self.balls.len() < top + list.len() {
            self.balls.resize(top + list.len(), Ball::NONE);
        }
        let (below, left) = self.balls.split_at_mut(top);
        let right = &mut below[list.clone()];
        let left = &mut left[..right.len()];
        let (mut left_count, mut right_count) = (0, 0);
        for at in 0..right.len() {
            let ball = right[at];
            let is_left = ball.center().cmplt(end).all();
            let crosses = ball.reaches(face);
            left[left_count] = ball;
            right[right_count] = ball;
            left_count += usize::from(is_left | crosses);
            right_count += usize::from(!is_left | crosses);
        }
        self.top = top + left_count;
        (top..self.top, list.start..list.start + right_count)
    }
}
