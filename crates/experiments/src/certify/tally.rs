//! Answers counted against the truth.

use std::collections::BTreeMap;
use std::fmt;

use metaball_core::RayQuery;
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Hit, NO_LIMIT, Ray, Scene, Verdict};
use serde::{Deserialize, Serialize};

use super::ray_distribution::{RayDistribution, TestRay};
use harness::fronts::WRONG_FRONT;
use harness::score::{Finding, Judgement};

/// Who answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tracer {
    /// `fbvh::Tracer`, on the CPU.
    Cpu,
    /// The shaders, on the adapter.
    Adapter,
}

/// What a ray queries: [`RayQuery`] as records name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Query {
    /// Where the ray first meets the solid.
    FirstHit,
    /// Whether it does.
    AnyHit,
    /// Where it first leaves the solid that it starts in.
    Exit,
}

impl fmt::Display for Tracer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "CPU",
            Self::Adapter => "adapter",
        })
    }
}

impl From<RayQuery> for Query {
    fn from(query: RayQuery) -> Self {
        match query {
            RayQuery::FirstHit => Self::FirstHit,
            RayQuery::AnyHit => Self::AnyHit,
            RayQuery::Exit => Self::Exit,
        }
    }
}

impl fmt::Display for Query {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FirstHit => "first hit",
            Self::AnyHit => "any hit",
            Self::Exit => "exit",
        })
    }
}

/// Whose answers to what, about which rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Category {
    /// Who answers.
    pub tracer: Tracer,
    /// What the rays query.
    #[serde(alias = "question")]
    pub query: Query,
    /// How the rays were made.
    #[serde(alias = "aim")]
    pub distribution: RayDistribution,
}

/// How often the answers were what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Count {
    /// Rays answered.
    pub rays: u64,
    /// Of these, within a thousandth of a radius of tangency or of a box's face.
    pub near: u64,
    /// Rays that hit, by the oracle, or that leave the solid.
    pub hits: u64,
    /// Rays that miss, by the oracle, or that do not leave it.
    pub misses: u64,
    /// Rays that the oracle finds too close to call; part of hits and misses.
    pub ambiguous: u64,
    /// Rays that the tracer could not decide, ambiguous or not.
    pub undecided: u64,
    /// Of these, clear to the oracle.
    pub undecided_clear: u64,
    /// Clear rays with a wrong verdict or a wrong front.
    pub wrong: u64,
}

/// Where an error is counted: by its tracer, the ball's size and its distance, in whole powers of ten.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ErrorClass {
    /// Who answers.
    pub tracer: Tracer,
    /// The nearest power of ten to the least radius at the hit, scene units.
    pub scale: i32,
    /// The power of ten at or below t over that radius.
    pub distance: i32,
}

/// Relative errors of t at clear hits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Hits.
    pub hits: u64,
    /// Sum of ((t − t*)/t*)².
    pub squares: f64,
    /// Largest |t − t*|/t*.
    pub worst: f64,
}

impl Errors {
    /// Root of the mean square; 0 of no hits.
    pub fn rms(&self) -> f64 {
        if self.hits == 0 { 0.0 } else { (self.squares / self.hits as f64).sqrt() }
    }

    /// Adds what was measured elsewhere.
    pub fn add(&mut self, other: &Self) {
        self.hits += other.hits;
        self.squares += other.squares;
        self.worst = self.worst.max(other.worst);
    }
}

/// A wrong answer, with what it takes to trace its ray again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Wrong {
    /// The test scene.
    #[serde(alias = "shard")]
    pub test_scene: String,
    /// Who answered what.
    #[serde(alias = "heading")]
    pub category: Category,
    /// The ray's start, direction and end; decimal numbers that read back as the same floats.
    pub origin: [f32; 3],
    /// See `origin`.
    pub direction: [f32; 3],
    /// See `origin`.
    pub t_max: f32,
    /// What is true, and what was found.
    pub account: String,
}

/// Wrong answers that are kept in full; all are counted.
const MOST_KEPT: usize = 200;

/// Everything that was counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// Counts.
    pub counts: BTreeMap<Category, Count>,
    /// Errors of distance.
    pub errors: BTreeMap<ErrorClass, Errors>,
    /// Hits by tracer and power of ten at or below the relative error.
    pub histogram: BTreeMap<(Tracer, i32), u64>,
    /// The first wrong answers.
    pub wrong: Vec<Wrong>,
}

/// The power of ten below which an error is no error in f64 either.
const LEAST_ERROR: i32 = -12;

/// What is checked: who answers what in which test scene.
#[derive(Clone, Copy)]
pub struct Check<'a> {
    /// Name of the test scene.
    pub test_scene: &'a str,
    /// The scene.
    pub scene: &'a Scene,
    /// The truth about it.
    pub oracle: &'a Oracle<'a>,
    /// Who answers.
    pub tracer: Tracer,
    /// What the rays query.
    pub query: Query,
}

impl Tally {
    /// Counts one answer.
    pub fn count(&mut self, check: &Check<'_>, ray: &TestRay, truth: &Truth, found: &Hit) {
        let distribution = ray.distribution;
        let category = Category { tracer: check.tracer, query: check.query, distribution };
        let (truth, hit) = in_terms_of_first_hits(check.query, &ray.ray, truth, found);
        let mut judgement = Judgement::new(&truth, &hit);
        let is_undecided = judgement.finding == Finding::Undecided;
        if check.query == Query::Exit && (judgement.is_wrong() || is_undecided) {
            judgement.ambiguous =
                judgement.ambiguous || exit_is_ambiguous(check, &ray.ray, truth.t);
        }
        let is_wrong = judgement.is_wrong() && !is_as_near_as_floats(&truth, &hit);

        let count = self.counts.entry(category).or_default();
        count.rays += 1;
        count.near += u64::from(ray.is_near(&truth));
        let is_hit = truth.verdict != Verdict::Miss;
        *(if is_hit { &mut count.hits } else { &mut count.misses }) += 1;
        count.ambiguous += u64::from(judgement.ambiguous);
        if is_undecided {
            count.undecided += 1;
            count.undecided_clear += u64::from(!judgement.ambiguous);
        }
        if is_wrong {
            count.wrong += 1;
            if self.wrong.len() < MOST_KEPT {
                let Ray { origin, direction, t_max, .. } = ray.ray;
                self.wrong.push(Wrong {
                    test_scene: check.test_scene.to_owned(),
                    category,
                    origin: origin.to_array(),
                    direction: direction.to_array(),
                    t_max,
                    account: format!("needed {truth:?}, found {found:?}"),
                });
            }
        } else if !judgement.ambiguous
            && check.query != Query::AnyHit
            && matches!(judgement.finding, Finding::Hit { .. })
            && truth.t > 0.0
        {
            self.measure(check.tracer, &truth, &hit);
        }
    }

    fn measure(&mut self, tracer: Tracer, truth: &Truth, hit: &Hit) {
        let relative = (f64::from(hit.t) - truth.t).abs() / truth.t;
        let radius = f64::from(truth.smallest_radius);
        let scale = radius.log10().round() as i32;
        let distance = (truth.t / radius).log10().floor() as i32;
        let errors = Errors { hits: 1, squares: relative * relative, worst: relative };
        self.errors.entry(ErrorClass { tracer, scale, distance }).or_default().add(&errors);
        let decade = relative.max(1e-300).log10().floor() as i32;
        *self.histogram.entry((tracer, decade.max(LEAST_ERROR))).or_default() += 1;
    }

    /// Adds what was counted elsewhere.
    pub fn add(&mut self, other: Self) {
        for (category, count) in other.counts {
            let sum = self.counts.entry(category).or_default();
            sum.rays += count.rays;
            sum.near += count.near;
            sum.hits += count.hits;
            sum.misses += count.misses;
            sum.ambiguous += count.ambiguous;
            sum.undecided += count.undecided;
            sum.undecided_clear += count.undecided_clear;
            sum.wrong += count.wrong;
        }
        for (class, errors) in other.errors {
            self.errors.entry(class).or_default().add(&errors);
        }
        for (bin, hits) in other.histogram {
            *self.histogram.entry(bin).or_default() += hits;
        }
        let left = MOST_KEPT.saturating_sub(self.wrong.len());
        self.wrong.extend(other.wrong.into_iter().take(left));
    }
}

/// An answer to any query, and its truth, in terms of first hits: an exit is the hit of a ray that starts
/// inside; of an any hit only the verdict counts.
fn in_terms_of_first_hits(query: Query, ray: &Ray, truth: &Truth, found: &Hit) -> (Truth, Hit) {
    match query {
        Query::FirstHit => (*truth, *found),
        Query::AnyHit => (*truth, Hit { t: truth.t as f32, ..*found }),
        Query::Exit => {
            let comes_out = truth.verdict == Verdict::Inside && truth.exit < f64::from(ray.t_max);
            let truth = if comes_out {
                Truth { verdict: Verdict::Hit, t: truth.exit, ..*truth }
            } else {
                Truth { verdict: Verdict::Miss, t: f64::INFINITY, ..*truth }
            };
            // The space beyond the solid, found at the start: there is no exit to find.
            let starts_outside = found.verdict == Verdict::Inside;
            (truth, if starts_outside { Hit::MISS } else { *found })
        }
    }
}

/// Whether the hit is within four roundings of the true t. From 10⁵ radii on the floats next to t are on
/// other fronts.
fn is_as_near_as_floats(truth: &Truth, hit: &Hit) -> bool {
    let reach = 2.0 * f64::from(f32::EPSILON) * truth.t;
    truth.verdict != Verdict::Miss && hit.is_hit() && (f64::from(hit.t) - truth.t).abs() <= reach
}

/// The oracle's margin of a start inside is no margin of the exit: whether raising or lowering the
/// field by the ambiguous share of T moves it from this front.
fn exit_is_ambiguous(check: &Check<'_>, ray: &Ray, leaves: f64) -> bool {
    let share = Truth::AMBIGUOUS as f32;
    [1.0 - share, 1.0 + share].into_iter().any(|factor| {
        let threshold = check.scene.threshold() * factor;
        check.scene.clone().with_threshold(threshold).is_ok_and(|scene| {
            let truth = Oracle::new(&scene).first_hit(ray);
            let reach = WRONG_FRONT * f64::from(truth.smallest_radius);
            let end = f64::from(ray.t_max);
            let (one, other) = (truth.exit.min(end), leaves.min(end));
            // Both at the end of an endless ray are one.
            one != other && (one - other).abs() > reach.min(f64::from(NO_LIMIT))
        })
    })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::{Kernel, Metaball};

    use super::*;
    use crate::certify::ray_distribution::of_picture;

    /// Undecided exits from a ball, from so far right of its centre to the left, that are counted as clear
    /// rays'; and wrong answers.
    fn counted(start: f32, found: Hit) -> (u64, u64) {
        let ball = Metaball::new(Vec3::ZERO, 1.0);
        let scene = Scene::new([ball], Kernel::QUARTIC, 0.5).expect("legal");
        let oracle = Oracle::new(&scene);
        let check = Check {
            test_scene: "one ball",
            scene: &scene,
            oracle: &oracle,
            tracer: Tracer::Adapter,
            query: Query::Exit,
        };
        let ray = Ray::new(Vec3::X * start, Vec3::NEG_X);
        let mut tally = Tally::default();
        let truth = oracle.first_hit(&ray);
        assert_eq!(truth.verdict, Verdict::Inside);
        tally.count(&check, &of_picture(ray), &truth, &found);
        let count = tally.counts.values().next().expect("counted");
        (count.undecided_clear, count.wrong)
    }

    #[test]
    fn nothing_is_held_of_a_start_too_close_to_t() {
        let undecided = Hit { verdict: Verdict::Undecided, ..Hit::MISS };
        // The field is T at 0.541196.
        let (close, clear) = (0.541_195, 0.3);
        assert_eq!([counted(close, undecided), counted(clear, undecided)], [(0, 0), (1, 0)]);
        let late = Hit { verdict: Verdict::Hit, t: 0.9 * (close + 0.541_196), ..Hit::MISS };
        assert_eq!([counted(close, late), counted(clear, late)], [(0, 0), (0, 1)]);
    }
}
