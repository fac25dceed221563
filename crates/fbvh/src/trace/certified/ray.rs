//! One ray through the certified tree.

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Hit, Ray, SurfaceHit, Verdict};
use pulp::Arch;

use super::polynomial::{self, Blocks};
use super::query::{Answer, Crossing, Query};
use super::ranges::{Chords, Found, RangeSearch, UNIT};
use crate::Field;
use crate::trace::counter::Counter;
use crate::trace::field_tree::FieldTree;
use crate::trace::slabs::{Slabs, WIDER};

/// What searches of leaves share, for its memory.
pub(in crate::trace) struct Scratch {
    pub(super) arch: Arch,
    /// Leaves that have been loaded, each at its number's remainder.
    leaves: Vec<Blocks>,
    chords: Chords,
}

impl Scratch {
    pub(in crate::trace) fn new() -> Self {
        Self::with_leaves(1)
    }

    /// That keeps so many leaves loaded, for rays that meet the same ones.
    pub(super) fn with_leaves(count: usize) -> Self {
        let mut leaves = Vec::new();
        leaves.resize_with(count, Blocks::default);
        Self { arch: Arch::new(), leaves, chords: Chords::default() }
    }
}

/// A ray and what the leaves so far have left open.
pub(super) struct RayState<'a> {
    ray: &'a Ray,
    origin: DVec3,
    inverse: DVec3,
    t_min: f64,
    t_max: f64,
    /// Whether the field comes so close to T at the ray's end that it may have crossed it.
    pub(super) uncertain: bool,
    /// For an exit: where it is if no leaf begins there.
    exit_face: Option<ExitFace>,
}

/// A ray that no arithmetic could decide.
pub(in crate::trace) const UNDECIDED: SurfaceHit =
    SurfaceHit { hit: Hit { verdict: Verdict::Undecided, ..Hit::MISS }, ..SurfaceHit::MISS };

/// The far face of a leaf at which the field comes as close to T as rounding lets one decide. Outside all
/// leaves it is below T, so the exit is there, unless another leaf begins there. For an entry there is
/// nothing to note: a field that rises to a face with no leaf behind it is below T before the face, too.
struct ExitFace {
    leaf: usize,
    t: f64,
}

impl<'a> RayState<'a> {
    pub(super) fn new(ray: &'a Ray) -> Self {
        Self {
            ray,
            origin: ray.origin.as_dvec3(),
            inverse: ray.direction.as_dvec3().recip(),
            t_min: ray.t_min.into(),
            t_max: ray.t_max.into(),
            uncertain: false,
            exit_face: None,
        }
    }

    /// The ray's interval in a box, widened by rounding; `None` where it misses it. A ray in the plane
    /// of a face is in the box, as for [`Slabs`](crate::trace::slabs::Slabs).
    pub(super) fn interval(&self, bounds: &Aabb) -> Option<(f64, f64)> {
        let (mut start, mut end) = (self.t_min, self.t_max);
        let to_min = (bounds.min.as_dvec3() - self.origin) * self.inverse;
        let to_max = (bounds.max.as_dvec3() - self.origin) * self.inverse;
        for axis in 0..3 {
            let is_negative = self.inverse[axis].is_sign_negative();
            let (near, far) = if is_negative {
                (to_max[axis], to_min[axis])
            } else {
                (to_min[axis], to_max[axis])
            };
            let (near, far) = (near - 6.0 * UNIT * near.abs(), far + 6.0 * UNIT * far.abs());
            start = if near > start { near } else { start };
            end = if far < end { far } else { end };
        }
        (start <= end).then_some((start, end))
    }

    /// Whether an interval of the ray begins where the ray does.
    fn starts_at(&self, t: f64) -> bool {
        t <= self.t_min
    }

    /// The answer for a ray that met no crossing, nor an exit at a face.
    fn end(&self) -> SurfaceHit {
        if self.uncertain { UNDECIDED } else { SurfaceHit::MISS }
    }
}

impl<F: Field> FieldTree<'_, F> {
    /// The first crossing along a ray, or the certainty that there is none, or neither. For a query
    /// that any crossing will do for, only the verdict is right.
    pub(in crate::trace) fn first_crossing(
        &self,
        query: &Query,
        ray: &Ray,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> SurfaceHit {
        let mut state = RayState::new(ray);
        let hit = self.tree.first_in_order(ray, counter, |leaf, _, counter| {
            self.search_leaf(query, leaf, &mut state, scratch, counter)
        });
        hit.or_else(|| self.exit_at_face(&state)).unwrap_or_else(|| state.end())
    }

    /// [`FieldTree::first_crossing`] for an exit. Outside all leaves the field is T or below: a ray that
    /// starts there is at its exit.
    pub(in crate::trace) fn first_exit(
        &self,
        query: &Query,
        ray: &Ray,
        scratch: &mut Scratch,
    ) -> SurfaceHit {
        if ray.is_empty() {
            return SurfaceHit::MISS;
        }
        // In a leaf that is searched from the ray's start on, wherever rounding enters it.
        let (slabs, state) = (Slabs::new(ray), RayState::new(ray));
        let start = ray.t_min * WIDER;
        let holds_start = |bounds: &Aabb| {
            slabs.crossing(bounds, start).is_some()
                && state.interval(bounds).is_some_and(|(start, _)| state.starts_at(start))
        };
        if self.tree.leaf_around(holds_start, |_| true).is_none() {
            let (t, normal) = (ray.t_min, ray.direction);
            let hit = Hit { verdict: Verdict::Inside, fallback: false, t, normal };
            return SurfaceHit { hit, ..SurfaceHit::MISS };
        }
        self.first_crossing(query, ray, scratch, &mut ())
    }

    /// [`FieldTree::first_crossing`] in a subtree whose box the ray meets; `None` when the ray continues.
    pub(super) fn first_crossing_below(
        &self,
        reference: u32,
        query: &Query,
        state: &mut RayState<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<SurfaceHit> {
        self.tree.first_below(reference, state.ray, counter, |leaf, _, counter| {
            self.search_leaf(query, leaf, state, scratch, counter)
        })
    }

    /// Searches a leaf; `None` when the ray continues.
    pub(super) fn search_leaf(
        &self,
        query: &Query,
        leaf: usize,
        state: &mut RayState<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<SurfaceHit> {
        let ray = state.ray;
        let bounds = self.tree.leaves[leaf].bounds();
        let interval = state.interval(&bounds)?;
        // A leaf that begins before the exit face of another and continues behind it decides there.
        if let Some(face) = &state.exit_face {
            if interval.0 > face.t {
                return self.exit_at_face(state);
            }
            if interval.1 > face.t {
                state.exit_face = None;
            }
        }
        let list = self.tree.list(leaf);
        counter.leaf_test(list.len());
        // A leaf without a list is solid, to farther past its faces than rounding reaches.
        if list.is_empty() {
            if query.crossing == Crossing::Exit {
                return None;
            }
            let t = interval.0 as f32;
            let verdict = if t > ray.t_min { Verdict::Hit } else { Verdict::Inside };
            return Some(self.hit_at(verdict, leaf, ray, t));
        }
        let Scratch { arch, leaves, .. } = scratch;
        let place = leaf % leaves.len();
        let blocks = &mut leaves[place];
        blocks.load(self.field, leaf, &bounds, list);
        match polynomial::search(query, *arch, blocks, (ray, interval), counter) {
            Answer::Undecided => self.search_ranges(query, leaf, interval, state, scratch, counter),
            answer => self.hit_of(answer, leaf, ray),
        }
    }

    /// The hit that an answer makes; `None` when the ray continues.
    #[inline]
    pub(super) fn hit_of(&self, answer: Answer, leaf: usize, ray: &Ray) -> Option<SurfaceHit> {
        let (t, normal) = match answer {
            Answer::Nothing | Answer::Undecided => return None,
            Answer::StartsBeyond => {
                return Some(self.hit_at(Verdict::Inside, leaf, ray, ray.t_min));
            }
            Answer::Root(t, gradient) => (t, outward(gradient, ray)),
            Answer::Somewhere => (f32::INFINITY, Vec3::ZERO),
        };
        let hit = Hit { verdict: Verdict::Hit, fallback: false, t, normal };
        Some(SurfaceHit { hit, place: leaf as u32 })
    }

    fn search_ranges(
        &self,
        query: &Query,
        leaf: usize,
        interval: (f64, f64),
        state: &mut RayState<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<SurfaceHit> {
        let ray = state.ray;
        let chords = &mut scratch.chords;
        chords.gather(self.field, self.tree.list(leaf), ray, interval);
        let starts = state.starts_at(interval.0);
        let search = RangeSearch { chords, query };
        let (verdict, t) = match search.first_root(interval, starts, counter) {
            Found::Nothing => return None,
            Found::UncertainEnd => {
                state.uncertain = interval.1 >= state.t_max;
                if query.crossing == Crossing::Exit && !state.uncertain {
                    state.exit_face = Some(ExitFace { leaf, t: interval.1 });
                }
                return None;
            }
            Found::StartsBeyond => (Verdict::Inside, ray.t_min),
            Found::Root(t) => {
                let blocks = &scratch.leaves[leaf % scratch.leaves.len()];
                if let Some((t, gradient)) = polynomial::nearest_float(query, blocks, ray, t) {
                    return self.hit_of(Answer::Root(t, gradient), leaf, ray);
                }
                (Verdict::Hit, t as f32)
            }
            Found::Undecided(t) => (Verdict::Undecided, t as f32),
        };
        Some(self.hit_at(verdict, leaf, ray, t))
    }

    /// The exit at a face, if there is one.
    fn exit_at_face(&self, state: &RayState<'_>) -> Option<SurfaceHit> {
        let face = state.exit_face.as_ref()?;
        Some(self.hit_at(Verdict::Hit, face.leaf, state.ray, face.t as f32))
    }
}

/// The unit vector out of the surface; against the ray where the gradient is zero.
fn outward(gradient: DVec3, ray: &Ray) -> Vec3 {
    // Scaled first: the squares of tiny components would be lost.
    let scaled = gradient / -gradient.abs().max_element();
    let normal = scaled.try_normalize().map(DVec3::as_vec3);
    normal.unwrap_or_else(|| (-ray.direction).normalize_or_zero())
}
