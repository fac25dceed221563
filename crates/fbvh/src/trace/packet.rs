//! Eight rays at once through the certified tree.
//!
//! Neighbours meet the same nodes and leaves, so a packet reads a node once for eight rays, and a leaf
//! is searched on all of its rays side by side ([`super::packet_leaf`]). Each ray's boxes are told by
//! the operations of [`Slabs`](super::slabs::Slabs) and each leaf's answer is certain for the ray
//! alone, so a verdict does not depend on the company. What a packet cannot decide in a leaf is asked
//! again of that leaf as for a single ray; where one ray is left of a packet, it goes on alone.

use metaball_core::{Aabb, Hit, Ray, Verdict};
use pulp::{Simd, WithSimd};

use super::Tracer;
use super::certified::{Journey, Scratch};
use super::lanes::{Lanes, WIDTH, array_of, lanes_of};
use super::polynomial::{Answer, Question};
use super::ranges::UNIT;
use super::slabs::WIDER;
use crate::Field;
use crate::node::{EMPTY, MAX_DEPTH};
use crate::tree::Child;

/// Rays side by side that go the same way along each axis, and so through the same order of leaves.
/// Lanes that have no ray repeat the first one.
pub(super) struct Packet {
    pub(super) origin: [Lanes<f32>; 3],
    pub(super) direction: [Lanes<f32>; 3],
    inverse: [Lanes<f32>; 3],
    limit: Lanes<f32>,
    /// Per axis: whether the rays go towards −∞.
    falls: [bool; 3],
}

/// What leaves need to know of a packet: most packets that meet nothing come to none.
pub(super) struct Exact {
    pub(super) origin: [Lanes<f64>; 3],
    inverse: [Lanes<f64>; 3],
    /// The origins' distance from the world's, scene units.
    pub(super) distance: Lanes<f32>,
    /// Length of the directions, and its square: unit to 1e-7 only.
    pub(super) length: Lanes<f32>,
    pub(super) square: Lanes<f64>,
}

impl Packet {
    #[inline(always)]
    fn new(rays: &[Ray]) -> Self {
        let mut all = [rays[0]; WIDTH];
        all[..rays.len()].copy_from_slice(rays);
        let all = Lanes(all);
        let direction: [_; 3] = array_of(|axis| all.map(|ray| ray.direction[axis]));
        Self {
            origin: array_of(|axis| all.map(|ray| ray.origin[axis])),
            direction,
            inverse: array_of(|axis| direction[axis].map(f32::recip)),
            limit: all.map(|ray| ray.t_max),
            falls: falls(&rays[0]),
        }
    }

    #[inline(always)]
    fn exact(&self) -> Exact {
        let direction: [_; 3] = array_of(|axis| self.direction[axis].map(f64::from));
        let [x, y, z] = direction;
        Exact {
            origin: array_of(|axis| self.origin[axis].map(f64::from)),
            inverse: array_of(|axis| direction[axis].map(f64::recip)),
            distance: length_squared(self.origin).sqrt(),
            length: length_squared(self.direction).sqrt(),
            square: x * x + y * y + z * z,
        }
    }

    /// The lanes whose rays cross the closed box: [`Slabs::crossing`](super::slabs::Slabs::crossing).
    #[inline(always)]
    fn crossing(&self, min: &[f32; 3], max: &[f32; 3]) -> u32 {
        let (mut enter, mut leave) = (Lanes::splat(0.0), self.limit);
        for axis in 0..3 {
            let (near, far) = if self.falls[axis] { (max, min) } else { (min, max) };
            let to = |face: f32| (Lanes::splat(face) - self.origin[axis]) * self.inverse[axis];
            enter = to(near[axis]).max(enter);
            leave = (to(far[axis]) * WIDER).min(leave);
        }
        enter.is_at_most(leave).bits()
    }

    /// Where the rays are in a box, widened by rounding; those that are not start after the end. As
    /// [`Journey::stretch`].
    #[inline(always)]
    fn stretch(&self, exact: &Exact, bounds: &Aabb) -> (Lanes<f64>, Lanes<f64>) {
        let (mut start, mut end) = (Lanes::splat(0.0), self.limit.map(f64::from));
        for axis in 0..3 {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let (near, far) = if self.falls[axis] { (max, min) } else { (min, max) };
            let to = |face: f32| {
                (Lanes::splat(f64::from(face)) - exact.origin[axis]) * exact.inverse[axis]
            };
            start = to(near).map(|t| t - 6.0 * UNIT * t.abs()).max(start);
            end = to(far).map(|t| t + 6.0 * UNIT * t.abs()).min(end);
        }
        (start, end)
    }
}

/// Per axis: whether the ray goes towards −∞.
#[inline(always)]
fn falls(ray: &Ray) -> [bool; 3] {
    array_of(|axis| ray.direction[axis].is_sign_negative())
}

#[inline(always)]
pub(super) fn length_squared([x, y, z]: [Lanes<f32>; 3]) -> Lanes<f32> {
    x * x + y * y + z * z
}

/// Siblings to come back to, with the lanes whose rays cross them. As high as [`Stack`](super::Stack).
struct Siblings {
    entries: [(u32, u32); MAX_DEPTH],
    height: usize,
}

impl Siblings {
    fn new() -> Self {
        Self { entries: [(EMPTY, 0); MAX_DEPTH], height: 0 }
    }

    fn push(&mut self, reference: u32, lanes: u32) {
        self.entries[self.height] = (reference, lanes);
        self.height += 1;
    }

    /// The last sibling that rays still open cross, and which.
    fn pop(&mut self, open: u32) -> Option<(u32, u32)> {
        while self.height > 0 {
            self.height -= 1;
            let (reference, lanes) = self.entries[self.height];
            if lanes & open != 0 {
                return Some((reference, lanes & open));
            }
        }
        None
    }
}

/// The walk of a packet, as `pulp` compiles it for wider vectors.
struct Walk<'a, F> {
    tracer: &'a Tracer<'a, F>,
    question: &'a Question,
    rays: &'a [Ray],
    answers: &'a mut [Hit],
    scratch: &'a mut Scratch,
    /// Lanes whose rays have no answer yet.
    open: u32,
    /// Lanes whose rays met a leaf that could not tell.
    doubt: u32,
}

impl<F: Field> Tracer<'_, F> {
    /// [`Tracer::certain`] for up to eight rays.
    pub(super) fn certain_packet(
        &self,
        question: &Question,
        rays: &[Ray],
        scratch: &mut Scratch,
        answers: &mut [Hit],
    ) {
        let first = rays.first().filter(|_| question.suits_packets()).map(falls);
        match first {
            Some(first) if rays.iter().all(|ray| falls(ray) == first) => {
                let (open, doubt) = ((1 << rays.len()) - 1, 0);
                let arch = scratch.arch;
                arch.dispatch(Walk { tracer: self, question, rays, answers, scratch, open, doubt });
            }
            _ => {
                for (ray, answer) in rays.iter().zip(answers) {
                    *answer = self.certain(question, ray, scratch, &mut ());
                }
            }
        }
    }
}

impl<F: Field> WithSimd for Walk<'_, F> {
    type Output = ();

    /// Front to back, as [`Tracer::first_in_order`].
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let tree = self.tracer.tree;
        let packet = Packet::new(self.rays);
        let mut exact = None;
        let mut siblings = Siblings::new();
        let Aabb { min, max } = tree.bounds;
        let met = self.open & packet.crossing(&min.to_array(), &max.to_array());
        let mut place = Some((tree.root, met));
        while let Some((next, lanes)) = place {
            place = match Child::read(next) {
                None => break,
                _ if lanes.count_ones() < 2 => {
                    self.each(lanes, |walk, lane| walk.go_alone(next, lane));
                    None
                }
                Some(Child::Node(node)) => {
                    let node = &tree.nodes[node];
                    let left = lanes & packet.crossing(&node.left_min, &node.left_max);
                    let right = lanes & packet.crossing(&node.right_min, &node.right_max);
                    let (left, right) = ((node.left, left), (node.right, right));
                    let falls = packet.falls[node.axis as usize];
                    let (near, far) = if falls { (right, left) } else { (left, right) };
                    if near.1 == 0 {
                        Some(far)
                    } else {
                        if far.1 != 0 {
                            siblings.push(far.0, far.1);
                        }
                        Some(near)
                    }
                }
                Some(Child::Leaf(leaf)) => {
                    let exact = exact.get_or_insert_with(|| packet.exact());
                    self.visit(&packet, exact, leaf, lanes);
                    None
                }
            };
            place = place.filter(|place| place.1 != 0).or_else(|| siblings.pop(self.open));
        }
        let undecided = Hit { verdict: Verdict::Undecided, ..Hit::MISS };
        for (lane, answer) in self.answers.iter_mut().enumerate() {
            if self.open & 1 << lane != 0 {
                *answer = if self.doubt & 1 << lane != 0 { undecided } else { Hit::MISS };
            }
        }
    }
}

impl<F: Field> Walk<'_, F> {
    /// Asks for the answers of some lanes; `None` when the ray goes on.
    #[inline(always)]
    fn each(&mut self, lanes: u32, mut answer: impl FnMut(&mut Self, usize) -> Option<Hit>) {
        for lane in lanes_of(lanes) {
            if let Some(hit) = answer(self, lane) {
                self.answers[lane] = hit;
                self.open &= !(1 << lane);
            }
        }
    }

    /// Searches a leaf on the rays of some lanes.
    #[inline(always)]
    fn visit(&mut self, packet: &Packet, exact: &Exact, leaf: usize, lanes: u32) {
        let bounds = self.tracer.tree.leaves[leaf].bounds();
        let list = self.tracer.list(leaf);
        let stretch = packet.stretch(exact, &bounds);
        let lanes = lanes & stretch.0.is_at_most(stretch.1).bits();
        if list.is_empty() || lanes.count_ones() < 2 {
            self.each(lanes, |walk, lane| walk.ask_alone(leaf, lane));
            return;
        }
        let arch = self.scratch.arch;
        let nearby = self.scratch.nearby(leaf);
        nearby.take(self.tracer.field, leaf, &bounds, list);
        let rays = (packet, exact);
        let answers = self.question.ask_packet(arch, nearby, rays, stretch, lanes);
        self.each(lanes, |walk, lane| match answers[lane] {
            Answer::Unclear => walk.ask_alone(leaf, lane),
            answer => walk.tracer.hit_of(answer, leaf, &walk.rays[lane]),
        });
    }

    /// Searches a leaf on one ray.
    fn ask_alone(&mut self, leaf: usize, lane: usize) -> Option<Hit> {
        let Self { tracer, question, .. } = *self;
        let mut journey = Journey::new(&self.rays[lane]);
        let hit = tracer.visit(question, leaf, &mut journey, self.scratch, &mut ());
        self.doubt |= u32::from(journey.doubt) << lane;
        hit
    }

    /// Goes through a subtree with one ray.
    #[inline(never)]
    fn go_alone(&mut self, reference: u32, lane: usize) -> Option<Hit> {
        let Self { tracer, question, .. } = *self;
        let mut journey = Journey::new(&self.rays[lane]);
        let hit = tracer.certain_below(reference, question, &mut journey, self.scratch, &mut ());
        self.doubt |= u32::from(journey.doubt) << lane;
        hit
    }
}
