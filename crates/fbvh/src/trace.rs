//! Rays through a tree on the CPU: sections 4 and 5.2 in f32, and the certified tree.

mod bernstein;
mod certified;
mod lanes;
mod leaf;
mod nearby;
mod pack;
mod packet;
mod packet_leaf;
mod polynomial;
mod ranges;
mod slabs;
mod work;

use glam::Vec3;
use metaball_core::{Hit, Ray, Verdict};
use rayon::prelude::*;

use crate::node::{EMPTY, MAX_DEPTH};
use crate::tree::Child;
use crate::{Field, Kind, Tree};

use self::certified::Scratch;
use self::slabs::Slabs;
pub use self::work::{Counter, Work};

/// How section 5.2's leaf test of the Fitted BVH is read, which says neither what happens when
/// projections lie outside the leaf's box nor where the bracket starts. The modified BVH is not
/// affected: section 4 leaves no choice, and it reads as [`Reading::Literal`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reading {
    /// Projections count wherever they fall, the bracket starts at the ray's origin, and the leaf's
    /// list is used even outside its box, where it is incomplete.
    Literal,
    /// Only the ray's stretch inside the box counts: the field is tested where it enters and where
    /// it leaves, projections in between, and the bracket starts at the entry. T or more at the
    /// entry is a hit there.
    Clipped,
}

/// How a leaf is searched for the surface: section 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceOptions {
    /// How the leaf test is read.
    pub reading: Reading,
    /// The search ends where |F − T| is at most this part of T. An f32 sum of a dozen kernels is
    /// right to about 1e-6, so there is nothing to gain below.
    pub tolerance: f32,
    /// The search ends after this many steps, with the nearest point known to be inside.
    pub max_iterations: u32,
}

impl TraceOptions {
    /// Clipped, to 1e-5. False position gains half a bracket at the least in two steps when its
    /// weights are halved (Illinois), so 64 steps take 2³² off the longest bracket, more than an
    /// f32 holds; a handful is the rule.
    pub const DEFAULT: Self =
        Self { reading: Reading::Clipped, tolerance: 1e-5, max_iterations: 64 };
}

impl Default for TraceOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Which way a ray goes through the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Crossing {
    In,
    Out,
}

/// Asks rays of a tree. Cheap to make; shares the tree and the field it was built from.
#[derive(Debug)]
pub struct Tracer<'a, F> {
    tree: &'a Tree,
    field: &'a F,
    options: TraceOptions,
}

impl<'a, F: Field> Tracer<'a, F> {
    /// A tracer for a tree of this very field: another one gives wrong pictures, or panics where
    /// it has fewer balls.
    pub fn new(tree: &'a Tree, field: &'a F, options: TraceOptions) -> Self {
        Self { tree, field, options }
    }

    /// Where the ray first enters the solid.
    pub fn first_hit(&self, ray: &Ray) -> Hit {
        self.first_hit_counting(ray, &mut ())
    }

    /// First hits of many rays, in their order, on rayon's current pool. Fastest where neighbours in
    /// the slice are neighbours in space: a certified tree is asked for eight rays at once. No verdict
    /// depends on which; in the last digits of t and of the normal it may show.
    pub fn first_hits(&self, rays: &[Ray]) -> Vec<Hit> {
        if self.tree.kind == Kind::Certified {
            return self.certain_hits(rays, false);
        }
        self.batch(rays, Hit::MISS, |rays, scratch, answers| {
            answer_each(rays, answers, |ray| self.hit(ray, scratch, &mut ()));
        })
    }

    /// [`Tracer::first_hits`] of a picture's rays, which come row by row, `width` to a row. Where rays go
    /// in packets, blocks of 4 × 2 pixels make closer neighbours than eight pixels of a row.
    pub fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit> {
        const BLOCK: (usize, usize) = (4, 2);
        /// Four rows of blocks, since a leaf is taken up once for neighbours.
        const ROWS: usize = 4 * BLOCK.1;
        if self.tree.kind != Kind::Certified || width == 0 {
            return self.first_hits(rays);
        }
        let question = self.question(Crossing::In, false);
        let corners = || {
            let tops = || (0..ROWS).step_by(BLOCK.1);
            (0..width).step_by(BLOCK.0).flat_map(move |left| tops().map(move |top| (left, top)))
        };
        let mut hits = blanks(rays, Hit::MISS);
        let tasks = rays.par_chunks(ROWS * width).zip(hits.par_chunks_mut(ROWS * width));
        tasks.for_each_init(Scratch::new, |scratch, (rays, hits)| {
            let (mut places, mut packet) = (Vec::new(), Vec::new());
            for (left, top) in corners() {
                places.clear();
                for row in top..top + BLOCK.1 {
                    let columns = left..(left + BLOCK.0).min(width);
                    let row = columns.map(|column| row * width + column);
                    places.extend(row.filter(|&place| place < rays.len()));
                }
                packet.clear();
                packet.extend(places.iter().map(|&place| rays[place]));
                let mut answers = [Hit::MISS; BLOCK.0 * BLOCK.1];
                self.certain_packet(&question, &packet, scratch, &mut answers[..packet.len()]);
                for (&place, answer) in places.iter().zip(answers) {
                    hits[place] = answer;
                }
            }
        });
        hits
    }

    /// As [`Tracer::first_hit`], and tells the counter what it does. With `()` for a counter
    /// nothing of that is compiled.
    pub fn first_hit_counting(&self, ray: &Ray, counter: &mut impl Counter) -> Hit {
        self.hit(ray, &mut Scratch::new(), counter)
    }

    /// Whether there is solid on the ray, wherever: [`Verdict::Inside`] where the ray starts in it,
    /// [`Verdict::Hit`] where it comes to it. What a shadow ray asks; ends at the first certainty,
    /// and looks for no root.
    ///
    /// In a published tree it is the paper's bracket that tells: it ends at a point inside.
    pub fn any_hit(&self, ray: &Ray) -> Verdict {
        self.any(ray, &mut Scratch::new())
    }

    /// [`Tracer::any_hit`] of many rays, in their order, on rayon's current pool.
    pub fn any_hits(&self, rays: &[Ray]) -> Vec<Verdict> {
        if self.tree.kind == Kind::Certified {
            return self.certain_hits(rays, true).iter().map(|hit| hit.verdict).collect();
        }
        self.batch(rays, Verdict::Miss, |rays, scratch, answers| {
            answer_each(rays, answers, |ray| self.any(ray, scratch));
        })
    }

    /// Where a ray that starts inside first leaves the solid, the normal out of it: the field falls
    /// below T there. A miss when the ray starts outside, or ends before it leaves. `None` when the
    /// tree is not certified: the paper's test starts outside.
    pub fn first_exit(&self, ray: &Ray) -> Option<Hit> {
        (self.tree.kind == Kind::Certified).then(|| self.exit(ray, &mut Scratch::new()))
    }

    /// [`Tracer::first_exit`] of many rays, in their order, on rayon's current pool.
    pub fn first_exits(&self, rays: &[Ray]) -> Option<Vec<Hit>> {
        let exits = || {
            self.batch(rays, Hit::MISS, |rays, scratch, answers| {
                answer_each(rays, answers, |ray| self.exit(ray, scratch));
            })
        };
        (self.tree.kind == Kind::Certified).then(exits)
    }

    /// [`Tracer::certain`] of many rays on the way into the solid.
    fn certain_hits(&self, rays: &[Ray], any: bool) -> Vec<Hit> {
        let question = self.question(Crossing::In, any);
        self.batch(rays, Hit::MISS, |rays, scratch, answers| {
            for (rays, answers) in rays.chunks(lanes::WIDTH).zip(answers.chunks_mut(lanes::WIDTH)) {
                self.certain_packet(&question, rays, scratch, answers);
            }
        })
    }

    /// One answer for each ray, in parallel.
    fn batch<T: Copy + Send + Sync>(
        &self,
        rays: &[Ray],
        blank: T,
        answer: impl Fn(&[Ray], &mut Scratch, &mut [T]) + Sync,
    ) -> Vec<T> {
        /// A multiple of a packet.
        const TASK: usize = 256;
        let mut answers = blanks(rays, blank);
        let tasks = rays.par_chunks(TASK).zip(answers.par_chunks_mut(TASK));
        tasks.for_each_init(Scratch::new, |scratch, (rays, answers)| {
            answer(rays, scratch, answers);
        });
        answers
    }

    fn hit(&self, ray: &Ray, scratch: &mut Scratch, counter: &mut impl Counter) -> Hit {
        if self.tree.kind == Kind::Certified {
            return self.certain(&self.question(Crossing::In, false), ray, scratch, counter);
        }
        if let Some(leaf) = self.published_start(ray, counter) {
            let normal = self.normal(leaf, ray, 0.0);
            return Hit { verdict: Verdict::Inside, fallback: false, t: 0.0, normal };
        }
        let found = if self.tree.kind == Kind::ModifiedBvh {
            self.nearest_of_all(ray, counter)
        } else {
            self.first_in_order(ray, counter, |leaf, stretch, counter| {
                let t = self.search(leaf, ray, stretch, counter)?;
                Some((leaf, t))
            })
        };
        found.map_or(Hit::MISS, |(leaf, t)| {
            let normal = self.normal(leaf, ray, t);
            Hit { verdict: Verdict::Hit, fallback: false, t, normal }
        })
    }

    fn any(&self, ray: &Ray, scratch: &mut Scratch) -> Verdict {
        if self.tree.kind == Kind::Certified {
            let question = self.question(Crossing::In, true);
            return self.certain(&question, ray, scratch, &mut ()).verdict;
        }
        if self.published_start(ray, &mut ()).is_some() {
            return Verdict::Inside;
        }
        let found = self.first_in_order(ray, &mut (), |leaf, stretch, counter| {
            self.bracket(leaf, ray, stretch, counter)
        });
        found.map_or(Verdict::Miss, |_| Verdict::Hit)
    }

    fn exit(&self, ray: &Ray, scratch: &mut Scratch) -> Hit {
        if self.leaf_around(ray.origin).is_none() {
            return Hit::MISS;
        }
        let question = self.question(Crossing::Out, false);
        let hit = self.certain(&question, ray, scratch, &mut ());
        if hit.verdict == Verdict::Inside { Hit::MISS } else { hit }
    }

    /// A leaf that finds the ray's start inside.
    fn published_start(&self, ray: &Ray, counter: &mut impl Counter) -> Option<usize> {
        self.leaf_around(ray.origin)
            .filter(|&leaf| self.value(leaf, ray, 0.0, counter) >= self.field.threshold())
    }

    /// A leaf whose list is complete at the point, if the field can reach T there.
    ///
    /// Lists of the Fitted BVH are complete in the leaf's box. Those of the modified BVH are so in
    /// the supports of the leaf's own balls.
    fn leaf_around(&self, point: Vec3) -> Option<usize> {
        if !self.tree.bounds.contains(point) {
            return None;
        }
        let mut stack = Stack::new();
        let mut next = self.tree.root;
        loop {
            match Child::read(next)? {
                Child::Node(node) => {
                    let node = &self.tree.nodes[node];
                    let left = node.left_bounds().contains(point);
                    let right = node.right_bounds().contains(point);
                    next = match (left, right) {
                        (true, true) => {
                            stack.push(node.right, 0.0);
                            node.left
                        }
                        (true, false) => node.left,
                        (false, true) => node.right,
                        (false, false) => stack.pop().0,
                    };
                }
                Child::Leaf(leaf) => {
                    let complete = match self.tree.kind {
                        Kind::Fitted | Kind::Certified => true,
                        Kind::ModifiedBvh => self.tree.leaf_balls(leaf).0.iter().any(|&ball| {
                            let support = self.field.support(ball as usize);
                            support.center.distance_squared(point) <= support.radius.powi(2)
                        }),
                    };
                    if complete {
                        return Some(leaf);
                    }
                    next = stack.pop().0;
                }
            }
        }
    }

    /// The modified BVH: leaves overlap, so the nearest hit of all that the ray meets before it.
    fn nearest_of_all(&self, ray: &Ray, counter: &mut impl Counter) -> Option<(usize, f32)> {
        let slabs = Slabs::new(ray);
        let mut limit = ray.t_max;
        let mut found = None;
        let mut stack = Stack::new();
        slabs.crossing(&self.tree.bounds, limit)?;
        let mut next = self.tree.root;
        loop {
            match Child::read(next) {
                None => return found,
                Some(Child::Node(node)) => {
                    counter.node();
                    let node = &self.tree.nodes[node];
                    let left = slabs.crossing(&node.left_bounds(), limit);
                    let right = slabs.crossing(&node.right_bounds(), limit);
                    next = match (left, right) {
                        (Some((left, _)), Some((right, _))) => {
                            if left <= right {
                                stack.push(node.right, right);
                                node.left
                            } else {
                                stack.push(node.left, left);
                                node.right
                            }
                        }
                        (Some(_), None) => node.left,
                        (None, Some(_)) => node.right,
                        (None, None) => stack.pop_before(limit),
                    };
                }
                Some(Child::Leaf(leaf)) => {
                    // The search sees beyond the nearest hit so far: its bracket ends at a
                    // projection, which may lie behind it though the surface is in front.
                    if let Some(t) = self.search(leaf, ray, (0.0, ray.t_max), counter)
                        && (t < limit || found.is_none())
                    {
                        limit = t;
                        found = Some((leaf, t));
                    }
                    next = stack.pop_before(limit);
                }
            }
        }
    }

    /// Leaves that do not overlap: the first find in the order of the ray. `search` is given a leaf
    /// and the stretch of the ray in its box.
    fn first_in_order<C: Counter, T>(
        &self,
        ray: &Ray,
        counter: &mut C,
        search: impl FnMut(usize, (f32, f32), &mut C) -> Option<T>,
    ) -> Option<T> {
        Slabs::new(ray).crossing(&self.tree.bounds, ray.t_max)?;
        self.first_below(self.tree.root, ray, counter, search)
    }

    /// The same in a part of the tree whose box the ray meets.
    fn first_below<C: Counter, T>(
        &self,
        reference: u32,
        ray: &Ray,
        counter: &mut C,
        mut search: impl FnMut(usize, (f32, f32), &mut C) -> Option<T>,
    ) -> Option<T> {
        let slabs = Slabs::new(ray);
        let mut stack = Stack::new();
        let mut next = reference;
        loop {
            match Child::read(next)? {
                Child::Node(node) => {
                    counter.node();
                    let node = &self.tree.nodes[node];
                    let left = slabs.crossing(&node.left_bounds(), ray.t_max);
                    let right = slabs.crossing(&node.right_bounds(), ray.t_max);
                    next = match (left, right) {
                        (Some(_), Some(_)) => {
                            if ray.direction[node.axis as usize] >= 0.0 {
                                stack.push(node.right, 0.0);
                                node.left
                            } else {
                                stack.push(node.left, 0.0);
                                node.right
                            }
                        }
                        (Some(_), None) => node.left,
                        (None, Some(_)) => node.right,
                        (None, None) => stack.pop().0,
                    };
                }
                Child::Leaf(leaf) => {
                    let bounds = self.tree.leaves[leaf].bounds();
                    if let Some(stretch) = slabs.crossing(&bounds, ray.t_max)
                        && let Some(find) = search(leaf, stretch, counter)
                    {
                        return Some(find);
                    }
                    next = stack.pop().0;
                }
            }
        }
    }
}

/// Room for an answer to each ray. Filled in parallel: on fresh memory that takes a while.
fn blanks<T: Copy + Send + Sync>(rays: &[Ray], blank: T) -> Vec<T> {
    rays.par_iter().map(|_| blank).collect()
}

/// Answers rays one by one.
fn answer_each<T>(rays: &[Ray], answers: &mut [T], mut answer: impl FnMut(&Ray) -> T) {
    for (ray, place) in rays.iter().zip(answers) {
        *place = answer(ray);
    }
}

/// Siblings to come back to, with the distance at which the ray enters them. [`MAX_DEPTH`] says why
/// it cannot overflow.
struct Stack {
    entries: [(u32, f32); MAX_DEPTH],
    height: usize,
}

impl Stack {
    fn new() -> Self {
        Self { entries: [(EMPTY, 0.0); MAX_DEPTH], height: 0 }
    }

    fn push(&mut self, reference: u32, entry: f32) {
        self.entries[self.height] = (reference, entry);
        self.height += 1;
    }

    /// The last sibling; [`EMPTY`] when there is none left.
    fn pop(&mut self) -> (u32, f32) {
        if self.height == 0 {
            return (EMPTY, 0.0);
        }
        self.height -= 1;
        self.entries[self.height]
    }

    /// The last sibling that the ray enters before the limit.
    fn pop_before(&mut self, limit: f32) -> u32 {
        loop {
            let (reference, entry) = self.pop();
            if reference == EMPTY || entry <= limit {
                return reference;
            }
        }
    }
}
