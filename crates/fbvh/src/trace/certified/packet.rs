//! Eight rays at once through the certified tree.
//!
//! Neighbours meet the same nodes and leaves, so a packet reads a node once for eight rays, and a leaf
//! is searched on all of its rays side by side (`trace/certified/packet/leaf.rs`). Boxes are tested by
//! the operations of a single ray and each leaf's answer is certain for the ray alone, so no verdict
//! depends on the other rays of the packet. What a packet cannot decide in a leaf is searched again as
//! for a single ray; where one ray of a packet is left, it continues alone.

mod balls;
mod enclosure;
mod leaf;
mod polynomial;
mod rays;
mod root;

use metaball_core::{Aabb, Ray, SurfaceHit};
use pulp::{Simd, WithSimd};

use self::balls::Balls;
use self::leaf::Found;
use self::rays::{ExactPacket, Packet, is_negative};
use super::lanes::{WIDTH, lanes_of};
use super::query::{Answer, Query};
use super::ray::{RayState, Scratch, UNDECIDED};
use crate::Field;
use crate::node::{EMPTY, MAX_DEPTH};
use crate::trace::field_tree::FieldTree;
use crate::tree::Child;

/// What the packets of a task share, for its memory.
pub(in crate::trace) struct PacketScratch {
    single: Scratch,
    /// Leaves that have been loaded, each at its number's remainder: neighbours meet them too.
    leaves: Vec<Balls>,
}

/// How many leaves stay loaded. With 32, mirrored and occlusion rays take 3 % more instructions, and
/// rays from the eye as many.
const LOADED: usize = 128;

impl PacketScratch {
    pub(in crate::trace) fn new() -> Self {
        let mut leaves = Vec::new();
        leaves.resize_with(LOADED, Balls::default);
        Self { single: Scratch::with_leaves(LOADED), leaves }
    }

    /// For rays that go alone.
    pub(in crate::trace) fn single(&mut self) -> &mut Scratch {
        &mut self.single
    }
}

/// Rays in packets: neighbours that go the same way along each axis.
pub(in crate::trace) fn packets(rays: &[Ray]) -> impl Iterator<Item = &[Ray]> {
    let same_way = |a: &Ray, b: &Ray| is_negative(a) == is_negative(b);
    rays.chunk_by(same_way).flat_map(|rays| rays.chunks(WIDTH))
}

/// Siblings still to be visited, with the lanes whose rays cross them. [`MAX_DEPTH`] says why it cannot
/// overflow.
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

    /// The last sibling that open rays cross, and which of them.
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

/// The traversal of a packet, as `pulp` compiles it for wider vectors.
struct Traversal<'a, F> {
    tree: &'a FieldTree<'a, F>,
    query: &'a Query,
    rays: &'a [Ray],
    answers: &'a mut [SurfaceHit],
    scratch: &'a mut PacketScratch,
    /// Lanes whose rays have no answer yet.
    open: u32,
    /// Lanes whose rays met a leaf at whose end the field was too close to T.
    uncertain: u32,
}

impl<F: Field> FieldTree<'_, F> {
    /// [`FieldTree::first_crossing`] of up to eight rays.
    pub(in crate::trace) fn first_crossings(
        &self,
        query: &Query,
        rays: &[Ray],
        scratch: &mut PacketScratch,
        answers: &mut [SurfaceHit],
    ) {
        let first = rays.first().filter(|_| leaf::is_searched_in_packets(query)).map(is_negative);
        match first {
            Some(first) if rays.iter().all(|ray| is_negative(ray) == first) => {
                let (open, uncertain) = ((1 << rays.len()) - 1, 0);
                let arch = scratch.single.arch;
                let tree = self;
                arch.dispatch(Traversal { tree, query, rays, answers, scratch, open, uncertain });
            }
            _ => {
                for (ray, answer) in rays.iter().zip(answers) {
                    *answer = self.first_crossing(query, ray, &mut scratch.single, &mut ());
                }
            }
        }
    }
}

impl<F: Field> WithSimd for Traversal<'_, F> {
    type Output = ();

    /// Front to back.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let tree = self.tree.tree;
        let packet = Packet::new(self.rays);
        let mut exact = None;
        let mut siblings = Siblings::new();
        let Aabb { min, max } = tree.bounds;
        let met = self.open & packet.crossing(&min.to_array(), &max.to_array());
        let mut next = Some((tree.root, met));
        while let Some((reference, lanes)) = next {
            next = match Child::read(reference) {
                None => break,
                _ if lanes.count_ones() < 2 => {
                    self.each(lanes, |traversal, lane| traversal.continue_alone(reference, lane));
                    None
                }
                Some(Child::Node(node)) => {
                    let node = &tree.nodes[node];
                    let left = lanes & packet.crossing(&node.left_min, &node.left_max);
                    let right = lanes & packet.crossing(&node.right_min, &node.right_max);
                    let (left, right) = ((node.left, left), (node.right, right));
                    let is_negative = packet.is_negative[node.axis as usize];
                    let (near, far) = if is_negative { (right, left) } else { (left, right) };
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
            next = next.filter(|next| next.1 != 0).or_else(|| siblings.pop(self.open));
        }
        for (lane, answer) in self.answers.iter_mut().enumerate() {
            if self.open & 1 << lane != 0 {
                let is_uncertain = self.uncertain & 1 << lane != 0;
                *answer = if is_uncertain { UNDECIDED } else { SurfaceHit::MISS };
            }
        }
    }
}

impl<F: Field> Traversal<'_, F> {
    /// Takes answers for some lanes; `None` where the ray continues.
    #[inline(always)]
    fn each(&mut self, lanes: u32, mut answer: impl FnMut(&mut Self, usize) -> Option<SurfaceHit>) {
        for lane in lanes_of(lanes) {
            if let Some(hit) = answer(self, lane) {
                self.answers[lane] = hit;
                self.open &= !(1 << lane);
            }
        }
    }

    /// Searches a leaf on the rays of some lanes.
    #[inline(always)]
    fn visit(&mut self, packet: &Packet, exact: &ExactPacket, leaf: usize, lanes: u32) {
        let FieldTree { tree, field, .. } = *self.tree;
        let bounds = tree.leaves[leaf].bounds();
        let list = tree.list(leaf);
        let interval = packet.interval(exact, &bounds);
        let lanes = lanes & interval.0.is_at_most(interval.1).bits();
        let rays = lanes.count_ones();
        if rays == 0 {
            return;
        }
        let PacketScratch { single, leaves } = &mut *self.scratch;
        let polynomial = self.tree.polynomial(self.query, single.arch, leaf, rays);
        if list.is_empty() || rays < 2 && polynomial.is_none() {
            self.each(lanes, |traversal, lane| traversal.visit_alone(leaf, lane));
            return;
        }
        let balls = &mut leaves[leaf % LOADED];
        balls.load(field, leaf, &bounds, list);
        let leaf_search = leaf::Leaf { balls, polynomial };
        let Found { nothing, somewhere, roots } =
            leaf::search(self.query, single.arch, leaf_search, (packet, exact), &interval, lanes);
        let (nothing, somewhere) = (nothing.bits(), somewhere.bits());
        self.each(somewhere, |traversal, lane| {
            traversal.tree.hit_of(Answer::Somewhere, leaf, &traversal.rays[lane])
        });
        self.each(roots.lanes, |traversal, lane| {
            let (t, gradient) = roots.roots[lane];
            traversal.tree.hit_of(Answer::Root(t, gradient), leaf, &traversal.rays[lane])
        });
        let undecided = lanes & !(nothing | somewhere | roots.lanes);
        self.each(undecided, |traversal, lane| traversal.visit_alone(leaf, lane));
    }

    /// Searches a leaf on one ray.
    fn visit_alone(&mut self, leaf: usize, lane: usize) -> Option<SurfaceHit> {
        let mut state = RayState::new(&self.rays[lane]);
        let single = &mut self.scratch.single;
        let hit = self.tree.search_leaf(self.query, leaf, &mut state, single, &mut ());
        self.uncertain |= u32::from(state.uncertain) << lane;
        hit
    }

    /// Takes one ray through a subtree.
    #[inline(never)]
    fn continue_alone(&mut self, reference: u32, lane: usize) -> Option<SurfaceHit> {
        let mut state = RayState::new(&self.rays[lane]);
        let single = &mut self.scratch.single;
        let hit =
            self.tree.first_crossing_below(reference, self.query, &mut state, single, &mut ());
        self.uncertain |= u32::from(state.uncertain) << lane;
        hit
    }
}
