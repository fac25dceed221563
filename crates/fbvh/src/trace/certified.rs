//! Rays through the certified tree: which answers are certain, and why.
//!
//! A leaf is searched in f32 first, by polynomials ([`super::polynomial`]), with every rounding
//! accounted for; what that cannot decide, kernels that are no polynomials among it, is searched in
//! f64 by ranges ([`super::ranges`]). A crossing found is finished by Newton's steps in f64.
//!
//! # By polynomials
//! On an interval of the ray a ball's v = 1 − r²/R² is a parabola with the Bernstein coefficients
//! v(a), its blossom at (a, b), and v(b). The parabola is nowhere above the one whose coefficients
//! below zero are raised to zero, so the sum of kernels of the raised ones, a polynomial again, is
//! nowhere below the field. It is the field where every ball that counts covers the whole interval;
//! leaving out the balls that do not gives a polynomial that is nowhere above. All terms are
//! products of non-negative numbers: nothing cancels. If all coefficients of the upper polynomial
//! are below T, the interval holds no crossing. If the two agree and their signs change once, it
//! holds one, the first. Otherwise the interval is shortened, from the front to where the upper
//! polynomial may first reach T, and from the back to where the lower one certainly has.
//!
//! # By packets
//! Of many rays, eight at a time go through the tree together ([`super::packet`]), and a leaf is
//! searched on all of them side by side by the same polynomials ([`super::packet_leaf`]). Every bound
//! is one ray's own, with the margins of that ray; what it cannot decide is asked again as above.
//!
//! # Rays that start inside
//! A box above T throughout and a box dropped never touch but where the field is T, so a ray that
//! starts inside leaves the solid in a leaf with a list: solid leaves are passed through.
//!
//! # Where leaves end
//! Boxes are cut down to where balls can make a surface, so a surface often touches a face with nothing
//! behind it: a lone ball six of them. There the field may be too close to T to tell at the ray's end of
//! the leaf, but in no leaf it is below T. So on the way in a field that rises to such a face has not
//! reached T; on the way out it falls to T at the face, if nowhere before. Only where a leaf goes on
//! behind the face that one has to tell.

use glam::DVec3;
use metaball_core::{Aabb, Hit, Ray, Verdict};
use pulp::Arch;

use super::nearby::Nearby;
use super::pack::Pack;
use super::polynomial::{Answer, Question, outward};
use super::ranges::{Chords, Found, Search, UNIT};
use super::{Counter, Crossing, Tracer};
use crate::Field;

/// What searches of leaves share, for its memory.
pub(super) struct Scratch {
    pub(super) arch: Arch,
    pack: Pack,
    /// Leaves that packets have met, each in the place of its number: their neighbours meet them too.
    /// No places where there were only single rays.
    nearby: Vec<Nearby>,
    chords: Chords,
}

/// Places for leaves that packets have met. With 8 pictures take 1 % longer, with 128 as long.
const NEARBY: usize = 32;

impl Scratch {
    pub(super) fn new() -> Self {
        Self {
            arch: Arch::new(),
            pack: Pack::default(),
            nearby: Vec::new(),
            chords: Chords::default(),
        }
    }

    /// The place of a leaf that packets meet.
    pub(super) fn nearby(&mut self, leaf: usize) -> &mut Nearby {
        if self.nearby.is_empty() {
            self.nearby.resize_with(NEARBY, Nearby::default);
        }
        &mut self.nearby[leaf % NEARBY]
    }
}

/// A ray on its way through the leaves.
pub(super) struct Journey<'a> {
    ray: &'a Ray,
    origin: DVec3,
    inverse: DVec3,
    /// Whether the field comes so close to T at the ray's end that it may have crossed it.
    pub(super) doubt: bool,
    /// On the way out: where the ray leaves the solid if no leaf begins there.
    leaving: Option<Leaving>,
}

/// The far face of a leaf at which the field comes as close to T as rounding tells. Space in no leaf is below
/// T, so that is the way out, unless another leaf begins there. On the way in there is nothing to note: the
/// field that rises to a face with no leaf behind it is below T before it, too.
struct Leaving {
    leaf: usize,
    t: f64,
}

impl<'a> Journey<'a> {
    pub(super) fn new(ray: &'a Ray) -> Self {
        let inverse = ray.direction.as_dvec3().recip();
        Self { ray, origin: ray.origin.as_dvec3(), inverse, doubt: false, leaving: None }
    }

    /// Where the ray is in a box, widened by rounding; `None` where it is not. A ray in the plane of
    /// a face is in the box, as for [`super::slabs::Slabs`].
    fn stretch(&self, bounds: &Aabb) -> Option<(f64, f64)> {
        let (mut start, mut end) = (0.0, f64::from(self.ray.t_max));
        let to_min = (bounds.min.as_dvec3() - self.origin) * self.inverse;
        let to_max = (bounds.max.as_dvec3() - self.origin) * self.inverse;
        for axis in 0..3 {
            let falls = self.inverse[axis].is_sign_negative();
            let (near, far) =
                if falls { (to_max[axis], to_min[axis]) } else { (to_min[axis], to_max[axis]) };
            let (near, far) = (near - 6.0 * UNIT * near.abs(), far + 6.0 * UNIT * far.abs());
            start = if near > start { near } else { start };
            end = if far < end { far } else { end };
        }
        (start <= end).then_some((start, end))
    }

    /// What a ray has come to that met no crossing, nor is leaving.
    fn end(&self) -> Hit {
        if self.doubt { Hit { verdict: Verdict::Undecided, ..Hit::MISS } } else { Hit::MISS }
    }
}

impl<F: Field> Tracer<'_, F> {
    /// The first crossing along a ray, or the certainty that there is none, or neither. With `any`
    /// the verdict is all that is right.
    pub(super) fn certain(
        &self,
        question: &Question,
        ray: &Ray,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Hit {
        let mut journey = Journey::new(ray);
        let hit = self.first_in_order(ray, counter, |leaf, _, counter| {
            self.visit(question, leaf, &mut journey, scratch, counter)
        });
        hit.or_else(|| self.way_out(&journey)).unwrap_or_else(|| journey.end())
    }

    /// The same in a part of the tree whose box the ray meets; `None` when the ray goes on.
    pub(super) fn certain_below(
        &self,
        reference: u32,
        question: &Question,
        journey: &mut Journey<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<Hit> {
        self.first_below(reference, journey.ray, counter, |leaf, _, counter| {
            self.visit(question, leaf, journey, scratch, counter)
        })
    }

    pub(super) fn question(&self, crossing: Crossing, any: bool) -> Question {
        let threshold = f64::from(self.field.threshold());
        Question { kernel: self.field.kernel(), threshold, crossing, any }
    }

    /// Searches a leaf; `None` when the ray goes on.
    pub(super) fn visit(
        &self,
        question: &Question,
        leaf: usize,
        journey: &mut Journey<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<Hit> {
        let ray = journey.ray;
        let bounds = self.tree.leaves[leaf].bounds();
        let stretch = journey.stretch(&bounds)?;
        // A leaf that goes on behind the end of another tells what that left open, if it begins before it.
        if let Some(leaving) = &journey.leaving {
            if stretch.0 > leaving.t {
                return self.way_out(journey);
            }
            if stretch.1 > leaving.t {
                journey.leaving = None;
            }
        }
        let list = self.list(leaf);
        counter.leaf_test(list.len());
        // A leaf without a list is solid, to farther past its faces than rounding reaches.
        if list.is_empty() {
            if question.crossing == Crossing::Out {
                return None;
            }
            let t = stretch.0 as f32;
            let verdict = if t > 0.0 { Verdict::Hit } else { Verdict::Inside };
            return Some(Hit { verdict, fallback: false, t, normal: self.normal(leaf, ray, t) });
        }
        scratch.pack.take(self.field, leaf, &bounds, list);
        match question.ask(scratch.arch, &mut scratch.pack, ray, stretch, counter) {
            Answer::Unclear => {
                self.search_ranges(question, leaf, stretch, journey, scratch, counter)
            }
            answer => self.hit_of(answer, leaf, ray),
        }
    }

    /// What an answer says of the ray; `None` when it goes on.
    #[inline]
    pub(super) fn hit_of(&self, answer: Answer, leaf: usize, ray: &Ray) -> Option<Hit> {
        match answer {
            Answer::Nothing | Answer::Unclear => None,
            Answer::Root(t, gradient) => Some(Hit {
                verdict: Verdict::Hit,
                fallback: false,
                t: t as f32,
                normal: outward(gradient, ray),
            }),
            Answer::Somewhere => Some(Hit { verdict: Verdict::Hit, ..Hit::MISS }),
            Answer::Start => Some(self.at_start(leaf, ray)),
        }
    }

    fn search_ranges(
        &self,
        question: &Question,
        leaf: usize,
        stretch: (f64, f64),
        journey: &mut Journey<'_>,
        scratch: &mut Scratch,
        counter: &mut impl Counter,
    ) -> Option<Hit> {
        let ray = journey.ray;
        let chords = &mut scratch.chords;
        chords.gather(self.field, self.list(leaf), ray, stretch);
        let Question { kernel, threshold, crossing, .. } = *question;
        let search = Search { chords, kernel, threshold, crossing };
        let (verdict, t) = match search.first_root(stretch, counter) {
            Found::Nothing => return None,
            Found::Doubt => {
                journey.doubt = stretch.1 >= f64::from(ray.t_max);
                if crossing == Crossing::Out && !journey.doubt {
                    journey.leaving = Some(Leaving { leaf, t: stretch.1 });
                }
                return None;
            }
            Found::Start => return Some(self.at_start(leaf, ray)),
            Found::Root(t) => (Verdict::Hit, t as f32),
            Found::TooClose(t) => (Verdict::Undecided, t as f32),
        };
        Some(Hit { verdict, fallback: false, t, normal: self.normal(leaf, ray, t) })
    }

    /// Where the ray is leaving, if it is.
    fn way_out(&self, journey: &Journey<'_>) -> Option<Hit> {
        journey.leaving.as_ref().map(|&Leaving { leaf, t }| {
            let t = t as f32;
            let normal = self.normal(leaf, journey.ray, t);
            Hit { verdict: Verdict::Hit, fallback: false, t, normal }
        })
    }

    /// Beyond the crossing from the start.
    fn at_start(&self, leaf: usize, ray: &Ray) -> Hit {
        let normal = self.normal(leaf, ray, 0.0);
        Hit { verdict: Verdict::Inside, fallback: false, t: 0.0, normal }
    }
}
