//! The search for a crossing in one leaf in f32, eight balls at a time, by Bernstein coefficients:
//! for kernels that are polynomials of v. What it cannot decide is left to [`super::ranges`].

use glam::{DVec3, Vec3};
use metaball_core::{Kernel, Ray};
use pulp::{Arch, Simd, WithSimd};

use super::bernstein::{inverse_binomials, negative_until, only_root, value_and_slope};
use super::lanes::{Lanes, Mask, array_of};
use super::pack::{Local, Pack, Part, UNIT};
use super::{Counter, Crossing};

/// What a search has come to.
#[derive(Debug, Clone, Copy)]
pub(super) enum Answer {
    /// No crossing on the stretch.
    Nothing,
    /// The ray starts beyond the crossing.
    Start,
    /// The first crossing: the ray's t, and the gradient of the field there.
    Root(f64, DVec3),
    /// Certainly a crossing: what a search is content with that does not ask where.
    Somewhere,
    /// f32 cannot tell.
    Unclear,
}

/// What is asked of a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Question {
    pub(super) kernel: Kernel,
    pub(super) threshold: f64,
    pub(super) crossing: Crossing,
    /// Whether any crossing will do.
    pub(super) any: bool,
}

/// Intervals looked at before the search gives up: two are the rule.
pub(super) const MOST_INTERVALS: usize = 24;

impl Question {
    /// Searches a leaf that has been taken up, over the ray's stretch in it.
    pub(super) fn ask(
        &self,
        arch: Arch,
        pack: &mut Pack,
        ray: &Ray,
        stretch: (f64, f64),
        counter: &mut impl Counter,
    ) -> Answer {
        match self.kernel {
            Kernel::Perlin => Answer::Unclear,
            Kernel::Wyvill => self.ask_degree::<7>(arch, pack, ray, stretch, counter),
            Kernel::Power(exponent) => match exponent.get() {
                1 => self.ask_degree::<3>(arch, pack, ray, stretch, counter),
                2 => self.ask_degree::<5>(arch, pack, ray, stretch, counter),
                3 => self.ask_degree::<7>(arch, pack, ray, stretch, counter),
                4 => self.ask_degree::<9>(arch, pack, ray, stretch, counter),
                5 => self.ask_degree::<11>(arch, pack, ray, stretch, counter),
                6 => self.ask_degree::<13>(arch, pack, ray, stretch, counter),
                7 => self.ask_degree::<15>(arch, pack, ray, stretch, counter),
                _ => self.ask_degree::<17>(arch, pack, ray, stretch, counter),
            },
        }
    }

    fn ask_degree<const N: usize>(
        &self,
        arch: Arch,
        pack: &mut Pack,
        ray: &Ray,
        stretch: (f64, f64),
        counter: &mut impl Counter,
    ) -> Answer {
        arch.dispatch(Asking::<N, _> { question: self, pack, ray, stretch, counter })
    }

    /// Front to back: nothing crosses before `start`.
    #[inline(always)]
    fn search<const N: usize>(
        &self,
        pack: &Pack,
        local: &Local,
        stretch: (f64, f64),
        counter: &mut impl Counter,
    ) -> Answer {
        let last = local.half;
        let (mut start, mut end) = (-last, last);
        for interval in 0..MOST_INTERVALS {
            counter.evaluation();
            let Some(sums) = self.sums::<N>(&pack.parts, start, end) else {
                return Answer::Unclear;
            };
            if interval == 0 && stretch.0 <= 0.0 && sums.upper[0] >= 0.0 {
                return if sums.ends[0] > 0.0 { Answer::Start } else { Answer::Unclear };
            }
            if self.any && (sums.ends[0] > 0.0 || sums.ends[1] > 0.0) {
                return Answer::Somewhere;
            }
            if sums.upper.iter().all(|&most| most < 0.0) {
                if end >= last {
                    return Answer::Nothing;
                }
                (start, end) = (end, (end + 2.0 * (end - start)).min(last));
                continue;
            }
            if sums.upper[0] >= 0.0 {
                return Answer::Unclear;
            }
            let width = f64::from(end) - f64::from(start);
            if sums.is_exact && sums.changes_sign_once() {
                let x = only_root(&sums.middle());
                let guess = f64::from(start) + x * width;
                return self.polish::<N>(pack, local, guess, (start, end), stretch, counter);
            }
            // No crossing before `clear`; nor a little short of it, where the field is clear of T.
            let clear = negative_until(sums.upper).unwrap_or(1.0);
            let beyond = [1.0 / 32.0, 1.0 / 8.0, 0.5]
                .map(|part| clear + part * (1.0 - clear))
                .into_iter()
                .find(|&x| value_and_slope(sums.lower, x).0 > 0.0);
            if self.any && beyond.is_some() {
                return Answer::Somewhere;
            }
            let clear = clear * (15.0 / 16.0);
            let until = beyond.unwrap_or(if clear > 0.25 { 1.0 } else { 0.5 + 0.5 * clear });
            let next = ((f64::from(start) + clear * width) as f32).max(start);
            end = ((f64::from(start) + until * width) as f32).next_up().min(end);
            start = next;
            if start >= end {
                return Answer::Unclear;
            }
        }
        Answer::Unclear
    }

    /// Encloses the field on an interval, unless rounding drowns it.
    #[inline(always)]
    fn sums<const N: usize>(&self, parts: &[Part], start: f32, end: f32) -> Option<Sums<N>> {
        let terms = self.terms::<N>(parts, Lanes::splat(start), Lanes::splat(end));
        Sums::new(self, parts.len(), &terms)
    }

    /// Adds up lane by lane what encloses the field on an interval.
    #[inline(always)]
    pub(super) fn terms<const N: usize>(
        &self,
        parts: &[Part],
        start: Lanes<f32>,
        end: Lanes<f32>,
    ) -> Terms<N> {
        let zero = Lanes::splat(0.0f32);
        let (mut most, mut least) = ([zero; N], [zero; N]);
        let (mut error, mut falls) = (zero, Mask::NONE);
        let (start_square, product, end_square) = (start * start, start * end, end * end);
        let middle = (start + end) * 0.5;
        for part in parts {
            let at = |t: Lanes<f32>, square| part.constant + part.linear * t - part.square * square;
            let v = [at(start, start_square), at(middle, product), at(end, end_square)];
            let top = v[0].max(v[1]).max(v[2]) + part.margin;
            let reaches = !top.is_at_most(zero);
            if !reaches.any() {
                continue;
            }
            let covers = part.margin.is_at_most(v[0].min(v[2]));
            let terms = self.coefficients::<N>(array_of(|k| v[k].max(zero)), part.strength);
            for k in 0..N {
                most[k] += terms[k];
                least[k] += covers.select(terms[k], zero);
            }
            error += part.strength * part.margin * self.slope::<N>(top.max(zero));
            let end_slope = part.linear - part.square * end * 2.0;
            falls = falls | reaches & !part.slope_margin.is_at_most(end_slope);
        }
        Terms { most, least, error, falls }
    }

    /// The coefficients of q·k(v), times their binomials: those of a product of polynomials are then
    /// the products' sums.
    #[inline(always)]
    fn coefficients<const N: usize>(
        &self,
        [first, second, third]: [Lanes<f32>; 3],
        strength: Lanes<f32>,
    ) -> [Lanes<f32>; N] {
        let mut product = [Lanes::splat(0.0); N];
        let v = [first, second * 2.0, third];
        for k in 0..3 {
            product[k] = v[k] * strength;
        }
        // How many factors v there are but the first, which may be a Wyvill's 5/9 + 4/9 v.
        let factors = match self.kernel {
            Kernel::Wyvill => 1,
            _ => (N - 1) / 2 - 1,
        };
        for factor in 0..factors {
            multiply(&mut product, &v, 2 * factor + 2);
        }
        if self.kernel == Kernel::Wyvill {
            let wyvill = |v: Lanes<f32>, one: f32| v.map(|v| (5.0 * one + 4.0 * v) * (1.0 / 9.0));
            multiply(&mut product, &[wyvill(v[0], 1.0), wyvill(v[1], 2.0), wyvill(v[2], 1.0)], 4);
        }
        product
    }

    /// dk/dv.
    #[inline(always)]
    pub(super) fn slope<const N: usize>(&self, v: Lanes<f32>) -> Lanes<f32> {
        if self.kernel == Kernel::Wyvill {
            return v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0));
        }
        let exponent = (N - 1) / 2;
        (1..exponent).fold(Lanes::splat(exponent as f32), |product, _| product * v)
    }

    /// Newton's steps in f64 on the field itself, and its gradient.
    #[inline(always)]
    fn polish<const N: usize>(
        &self,
        pack: &Pack,
        local: &Local,
        guess: f64,
        (start, end): (f32, f32),
        stretch: (f64, f64),
        counter: &mut impl Counter,
    ) -> Answer {
        const MOST_STEPS: usize = 6;
        let mut t = guess;
        for _ in 0..MOST_STEPS {
            counter.iteration();
            let (excess, gradient) = self.field::<N>(pack, local, t);
            let step = excess / gradient.dot(local.direction);
            t -= step;
            if !(t >= f64::from(start) && t <= f64::from(end)) {
                return Answer::Unclear;
            }
            // An f32 holds no more. Not sooner: behind the rim of a support slopes may differ, and
            // then the next error is as large as the step.
            if step.abs() <= 1e-8 * f64::from(local.half) {
                let t = local.base + t;
                // Past the ray's end by a rounding: too close to call here.
                return if t <= stretch.1 {
                    Answer::Root(t.max(stretch.0), gradient)
                } else {
                    Answer::Unclear
                };
            }
        }
        Answer::Unclear
    }

    /// F − T and the gradient of F, 1/scene unit.
    #[inline(always)]
    fn field<const N: usize>(&self, pack: &Pack, local: &Local, t: f64) -> (f64, DVec3) {
        let point = (local.origin + t * local.direction).to_array();
        let zero = Lanes::splat(0.0f64);
        let (mut sum, mut gradient) = (zero, [zero; 3]);
        for block in &pack.blocks {
            let [x, y, z] = array_of(|axis| block.exact[axis] - Lanes::splat(point[axis]));
            let v = (x * x + y * y + z * z)
                .zip(block.inverse_square, |distance, inverse| (1.0 - distance * inverse).max(0.0));
            let strength = block.strength.map(f64::from);
            let (value, slope) = self.value_and_slope::<N>(v);
            sum += value * strength;
            let pull = slope * strength * block.inverse_square * 2.0;
            for (sum, offset) in gradient.iter_mut().zip([x, y, z]) {
                *sum += offset * pull;
            }
        }
        let gradient = DVec3::from(array_of(|axis| gradient[axis].sum()));
        (sum.sum() - self.threshold, gradient)
    }

    /// k(v) and dk/dv for v ≥ 0.
    #[inline(always)]
    pub(super) fn value_and_slope<const N: usize>(
        &self,
        v: Lanes<f64>,
    ) -> (Lanes<f64>, Lanes<f64>) {
        if self.kernel == Kernel::Wyvill {
            return (
                v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0)),
                v.map(|v| v * (10.0 + 12.0 * v) * (1.0 / 9.0)),
            );
        }
        let exponent = (N - 1) / 2;
        // Outside the support the slope is zero, of α = 1 too.
        let inside = v.map(|v| if v > 0.0 { 1.0 } else { 0.0 });
        let power = (1..exponent).fold(inside, |product, _| product * v);
        (power * v, power * exponent as f64)
    }
}

/// A search, as `pulp` compiles it for wider vectors.
struct Asking<'a, const N: usize, C> {
    question: &'a Question,
    pack: &'a mut Pack,
    ray: &'a Ray,
    stretch: (f64, f64),
    counter: &'a mut C,
}

impl<const N: usize, C: Counter> WithSimd for Asking<'_, N, C> {
    type Output = Answer;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Answer {
        let local = self.pack.local(self.ray, self.stretch);
        self.pack.project(self.ray, &local);
        self.question.search::<N>(self.pack, &local, self.stretch, self.counter)
    }
}

/// Multiplies a polynomial of so high a degree by one of degree two.
#[inline(always)]
fn multiply<const N: usize>(
    product: &mut [Lanes<f32>; N],
    [first, second, third]: &[Lanes<f32>; 3],
    degree: usize,
) {
    for k in (0..=degree + 2).rev() {
        let mut term = Lanes::splat(0.0);
        if k <= degree {
            term += product[k] * *first;
        }
        if k >= 1 && k <= degree + 1 {
            term += product[k - 1] * *second;
        }
        if k >= 2 {
            term += product[k - 2] * *third;
        }
        product[k] = term;
    }
}

/// Sums over balls, lane by lane: coefficients, times their binomials, of the polynomials above and
/// below the field, and how far rounding of the parabolas can move the field.
pub(super) struct Terms<const N: usize> {
    pub(super) most: [Lanes<f32>; N],
    pub(super) least: [Lanes<f32>; N],
    pub(super) error: Lanes<f32>,
    /// Where some ball may fall before the interval's end.
    pub(super) falls: Mask,
}

/// Enclosures of what is to cross zero upwards, in Bernstein coefficients: F − T on the way in,
/// T − F on the way out.
struct Sums<const N: usize> {
    upper: [f64; N],
    lower: [f64; N],
    /// At the interval's ends at least this: there the raised parabolas are the true ones.
    ends: [f64; 2],
    /// Whether the field is a polynomial on the interval: no support's rim is in it.
    is_exact: bool,
}

impl<const N: usize> Sums<N> {
    #[inline(always)]
    fn new(
        question: &Question,
        parts: usize,
        Terms { most, least, error, .. }: &Terms<N>,
    ) -> Option<Self> {
        let inverses = const { inverse_binomials::<N>() };
        // Products and sums of non-negative terms: one rounding each.
        let rounding = (parts + 4 * N + 16) as f64 * f64::from(UNIT);
        let error = f64::from(error.sum()) * 1.0001;
        // Not a number, where margins of balls that are tiny beside the leaf overflow.
        if error.is_nan() || error >= question.threshold {
            return None;
        }
        let most: [f64; N] = array_of(|k| f64::from(most[k].sum()) * inverses[k]);
        let least: [f64; N] = array_of(|k| f64::from(least[k].sum()) * inverses[k]);
        let is_exact = most == least;
        let up = |c: f64| c * (1.0 + rounding) + error - question.threshold;
        let down = |c: f64| c * (1.0 - rounding) - error - question.threshold;
        let ends = [most[0], most[N - 1]];
        Some(match question.crossing {
            Crossing::In => Self {
                upper: array_of(|k| up(most[k])),
                lower: array_of(|k| down(least[k])),
                ends: array_of(|k| down(ends[k])),
                is_exact,
            },
            Crossing::Out => Self {
                upper: array_of(|k| -down(least[k])),
                lower: array_of(|k| -up(most[k])),
                ends: array_of(|k| -up(ends[k])),
                is_exact,
            },
        })
    }

    /// Whether the signs of the true coefficients, wherever between the two they lie, change once,
    /// from below to above.
    #[inline(always)]
    fn changes_sign_once(&self) -> bool {
        let below = self.upper.iter().take_while(|&&c| c < 0.0).count();
        let above = self.lower.iter().rev().take_while(|&&c| c > 0.0).count();
        below >= 1 && above >= 1 && below + above + 1 >= N
    }

    #[inline(always)]
    fn middle(&self) -> [f64; N] {
        array_of(|k| 0.5 * (self.upper[k] + self.lower[k]))
    }
}

/// The unit vector out of the surface; against the ray where the gradient is zero.
pub(super) fn outward(gradient: DVec3, ray: &Ray) -> Vec3 {
    // Scaled first: the squares of tiny components would be lost.
    let scaled = gradient / -gradient.abs().max_element();
    let normal = scaled.try_normalize().map(DVec3::as_vec3);
    normal.unwrap_or_else(|| (-ray.direction).normalize_or_zero())
}
