//! The search for a crossing in one leaf in f32, on eight rays at a time: what
//! [`super::polynomial`] does for one ray and eight balls, ball by ball with the rays side by side.
//!
//! Each lane has an interval of its own and the margins of its own ray; none looks at another. What
//! differs is what saves passes over the balls:
//! - A ball that reaches no ray's stretch is left out, and where the greatest values that the balls
//!   have on a stretch do not come to T together, nothing crosses.
//! - Where a ball comes to T alone, the first interval ends just before its projection.
//! - An interval holds one crossing also where the field is below T at its start and above at its
//!   end, and no ball that reaches it falls on it: the field rises there, whatever rims there are.

use metaball_core::Kernel;
use pulp::{Arch, Simd, WithSimd};

use super::bernstein::{inverse_binomials, right_of, value_and_rise};
use super::lanes::{Lanes, Mask, WIDTH, array_of, lanes_of};
use super::nearby::{Locals, Nearby};
use super::pack::{Part, UNIT};
use super::packet::{Exact, Packet};
use super::polynomial::{Answer, MOST_INTERVALS, Question, Terms};

/// Enclosures of F − T, lane by lane, in Bernstein coefficients.
struct Enclosure<const N: usize> {
    upper: [Lanes<f32>; N],
    lower: [Lanes<f32>; N],
    /// At the interval's ends at least this.
    ends: [Lanes<f32>; 2],
    /// Where the field is a polynomial on the interval.
    is_exact: Mask,
    /// Where rounding does not drown the field.
    is_known: Mask,
}

/// Where lanes have found the only crossing of an interval.
struct Crossings {
    found: Mask,
    start: Lanes<f32>,
    end: Lanes<f32>,
    /// Somewhere near it.
    guess: Lanes<f32>,
}

/// What the projections tell.
struct Outlook {
    /// Where the field may come to T; the other lanes are answered.
    todo: Mask,
    /// Where the first interval had better end.
    end: Lanes<f32>,
}

impl Question {
    /// Whether packets can be asked: on the way in, by polynomials.
    pub(super) fn suits_packets(&self) -> bool {
        self.crossing == super::Crossing::In && self.kernel != Kernel::Perlin
    }

    /// Searches a leaf that has been taken up, over the stretches of some of the packet's rays.
    pub(super) fn ask_packet(
        &self,
        arch: Arch,
        nearby: &mut Nearby,
        (packet, exact): (&Packet, &Exact),
        stretch: (Lanes<f64>, Lanes<f64>),
        lanes: u32,
    ) -> [Answer; WIDTH] {
        let mut answers = [Answer::Unclear; WIDTH];
        let (question, results) = (self, &mut answers);
        let asking = AskingPacket { question, nearby, packet, exact, stretch, lanes, results };
        match self.kernel {
            Kernel::Perlin => {}
            Kernel::Wyvill => arch.dispatch(Degree::<7>(asking)),
            Kernel::Power(exponent) => match exponent.get() {
                1 => arch.dispatch(Degree::<3>(asking)),
                2 => arch.dispatch(Degree::<5>(asking)),
                3 => arch.dispatch(Degree::<7>(asking)),
                4 => arch.dispatch(Degree::<9>(asking)),
                5 => arch.dispatch(Degree::<11>(asking)),
                6 => arch.dispatch(Degree::<13>(asking)),
                7 => arch.dispatch(Degree::<15>(asking)),
                _ => arch.dispatch(Degree::<17>(asking)),
            },
        }
        answers
    }

    /// k(v) for v ≥ 0.
    #[inline(always)]
    fn value<const N: usize>(&self, v: Lanes<f32>) -> Lanes<f32> {
        if self.kernel == Kernel::Wyvill {
            return v.map(|v| v * v * (5.0 + 4.0 * v) * (1.0 / 9.0));
        }
        (1..(N - 1) / 2).fold(v, |product, _| product * v)
    }
}

/// A search, as `pulp` compiles it for wider vectors.
struct AskingPacket<'a> {
    question: &'a Question,
    nearby: &'a mut Nearby,
    packet: &'a Packet,
    exact: &'a Exact,
    stretch: (Lanes<f64>, Lanes<f64>),
    lanes: u32,
    results: &'a mut [Answer; WIDTH],
}

/// A search for a kernel of which N coefficients make a sum.
struct Degree<'a, const N: usize>(AskingPacket<'a>);

impl<const N: usize> WithSimd for Degree<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(mut asking) = self;
        let locals =
            asking.nearby.locals(asking.packet, asking.exact, asking.stretch, asking.lanes);
        let outlook = asking.project::<N>(&locals);
        if outlook.todo.any() {
            let crossings = asking.search::<N>(&locals, outlook);
            if crossings.found.any() {
                let guess = asking.approach::<N>(&crossings);
                asking.polish::<N>(&locals, &crossings, guess);
            }
        }
    }
}

impl AskingPacket<'_> {
    /// Projects the balls on the rays and keeps those that reach a stretch.
    ///
    /// # Rounding
    /// As [`Pack::project`](super::pack::Pack::project): ρ + λ + ω is at most what the ball's centre
    /// and `reach` are away from the leaf's middle, in radii. The projection, where v is largest, is
    /// misplaced by a few u(ρ + λ + ω)R, which changes v by the square of that.
    #[inline(always)]
    fn project<const N: usize>(&mut self, locals: &Locals) -> Outlook {
        const MARGIN: f32 = 16.0 * UNIT;
        let packet = self.packet;
        let zero = Lanes::splat(0.0f32);
        let origin: [_; 3] = array_of(|axis| locals.origin[axis].map(|x| x as f32));
        let square = self.exact.square.map(|square| square as f32);
        let inverse_square_length = square.map(f32::recip);
        let back = zero - locals.half;
        let [dx, dy, dz] = packet.direction;
        let threshold = Lanes::splat(self.question.threshold as f32);
        let (mut roof, mut end) = (zero, locals.half);
        self.nearby.cull(packet, locals, self.lanes.trailing_zeros() as usize);
        let Nearby { balls, kept, parts, .. } = &mut *self.nearby;
        parts.clear();
        let mut count = 0;
        for candidate in 0..kept.len() {
            let at = kept[candidate];
            let ball = &balls[at as usize];
            let [x, y, z] = array_of(|axis| Lanes::splat(ball.center[axis]) - origin[axis]);
            let along = x * dx + y * dy + z * dz;
            let distance = (x * x + y * y + z * z) * ball.inverse_square_f32;
            let reaches = (locals.reach * ball.inverse_radius).map(|reach| ball.away + reach);
            let margin = (reaches * reaches).map(|x| MARGIN * (1.0 + x));
            let part = Part {
                constant: distance.map(|x| 1.0 - x),
                linear: along * (2.0 * ball.inverse_square_f32),
                square: square * ball.inverse_square_f32,
                margin,
                slope_margin: margin * ball.inverse_radius,
                strength: Lanes::splat(ball.strength),
            };
            let t = (along * inverse_square_length).min(locals.half).max(back);
            let top = part.constant + (part.linear - part.square * t) * t + margin;
            if !(!top.is_at_most(zero)).any() {
                continue;
            }
            // What is no number stays none.
            let most = self.question.value::<N>(zero.max(top)) * ball.strength;
            roof += most;
            // Slope margins before the projection it certainly rises still.
            let before = t - margin * ball.radius;
            end = threshold.is_less(most).select(before.min(end), end);
            kept[count] = at;
            count += 1;
            parts.push(part);
        }
        kept.truncate(count);
        let rounding = (self.nearby.parts.len() + 34) as f32 * UNIT;
        let below = (roof * (1.0 + rounding)).is_less(threshold);
        let asked = Mask::from_bits(self.lanes);
        self.answer((below & asked).bits(), Answer::Nothing);
        Outlook { todo: asked & !below, end: back.is_less(end).select(end, locals.half) }
    }

    #[inline(always)]
    fn answer(&mut self, lanes: u32, answer: Answer) {
        for lane in lanes_of(lanes) {
            self.results[lane] = answer;
        }
    }

    /// Front to back, each lane on its own: nothing crosses before `start`. Lanes that cannot tell
    /// stay without an answer.
    #[inline(always)]
    fn search<const N: usize>(&mut self, locals: &Locals, outlook: Outlook) -> Crossings {
        let zero = Lanes::splat(0.0f32);
        let last = locals.half;
        let (mut start, Outlook { mut todo, mut end }) = (zero - last, outlook);
        let mut crossings = Crossings { found: Mask::NONE, start: zero, end: zero, guess: zero };
        // A step this long is more than rounding on the way.
        let step = last * (4.0 * UNIT);
        for _ in 0..MOST_INTERVALS {
            let terms = self.question.terms::<N>(&self.nearby.parts, start, end);
            let sums = self.enclose(&terms);
            // Not where a ray starts inside, nor where rounding drowns the field.
            todo = todo & sums.is_known & sums.upper[0].is_less(zero);
            if self.question.any {
                let inside = zero.is_less(sums.ends[0]) | zero.is_less(sums.ends[1]);
                self.answer((todo & inside).bits(), Answer::Somewhere);
                todo = todo & !inside;
            }
            let is_below = sums.upper.iter().fold(todo, |below, c| below & c.is_less(zero));
            let is_last = last.is_at_most(end);
            self.answer((is_below & is_last).bits(), Answer::Nothing);
            let rises = !terms.falls & zero.is_less(sums.ends[1]);
            let once = todo & (rises | sums.is_exact & sums.changes_sign_once());
            if once.any() {
                crossings.found = crossings.found | once;
                crossings.start = once.select(start, crossings.start);
                crossings.end = once.select(end, crossings.end);
                let guess = start + (end - start) * sums.polygon_crossing();
                crossings.guess = once.select(guess, crossings.guess);
            }
            todo = todo & !once & !(is_below & is_last);
            if !todo.any() {
                break;
            }
            let width = end - start;
            // No crossing before `clear`; nor a little short of it, where the field is clear of T.
            let clear = negative_until(&sums.upper);
            let mut until = clear.map(|clear| {
                if clear * (15.0 / 16.0) > 0.25 { 1.0 } else { 0.5 + 0.5 * clear * (15.0 / 16.0) }
            });
            let may_be_above = sums.lower.iter().fold(Mask::NONE, |may, &c| may | zero.is_less(c));
            if (todo & may_be_above).any() {
                for part in [0.5, 1.0 / 8.0, 1.0 / 32.0] {
                    let x = clear + (Lanes::splat(1.0) - clear) * part;
                    let is_above = zero.is_less(value_and_rise(sums.lower, x).0);
                    until = is_above.select(x, until);
                }
            }
            let ahead = start + (width * clear * (15.0 / 16.0) - step).max(zero);
            let beyond = (start + width * until + step).min(end);
            let far = (end + width * 2.0).min(last);
            start = is_below.select(end, ahead);
            end = is_below.select(far, beyond);
            todo = todo & start.is_less(end);
        }
        crossings
    }

    /// Rounding as for a single ray, and 32 u for sums and products here, which are f32.
    #[inline(always)]
    fn enclose<const N: usize>(&self, terms: &Terms<N>) -> Enclosure<N> {
        let inverses = const { inverse_binomials::<N>() };
        let threshold = self.question.threshold as f32;
        let rounding = (self.nearby.parts.len() + 4 * N + 48) as f32 * UNIT;
        let error = terms.error.map(|error| error * 1.0001 + 8.0 * UNIT * threshold);
        let most: [_; N] = array_of(|k| terms.most[k] * inverses[k] as f32);
        let least: [_; N] = array_of(|k| terms.least[k] * inverses[k] as f32);
        let up = |c: Lanes<f32>| (c * (1.0 + rounding) + error).map(|c| c - threshold);
        let down = |c: Lanes<f32>| (c * (1.0 - rounding) - error).map(|c| c - threshold);
        let differs = (0..N).fold(Mask::NONE, |differs, k| differs | !most[k].is_at_most(least[k]));
        Enclosure {
            upper: array_of(|k| up(most[k])),
            lower: array_of(|k| down(least[k])),
            ends: [down(most[0]), down(most[N - 1])],
            is_exact: !differs,
            is_known: error.is_less(Lanes::splat(threshold)),
        }
    }

    /// The crossings to what f32 can tell: Newton's steps, kept between the ends.
    #[inline(always)]
    fn approach<const N: usize>(&self, crossings: &Crossings) -> Lanes<f32> {
        const MOST_STEPS: usize = 12;
        let zero = Lanes::splat(0.0f32);
        let Crossings { found, start: mut low, end: mut high, guess: mut t } = *crossings;
        // The next error is the square of this.
        let near = (high - low) * 1e-4;
        for _ in 0..MOST_STEPS {
            let mut excess = Lanes::splat(-self.question.threshold as f32);
            let mut slope = zero;
            for part in &self.nearby.parts {
                let v = part.constant + (part.linear - part.square * t) * t;
                let v = v.max(zero);
                excess += part.strength * self.question.value::<N>(v);
                let along = part.linear - part.square * t * 2.0;
                slope += part.strength * self.question.slope::<N>(v) * along;
            }
            let is_above = zero.is_at_most(excess);
            high = is_above.select(t, high);
            low = is_above.select(low, t);
            let newton = t - excess.zip(slope, |excess, slope| excess / slope);
            let is_between = low.is_less(newton) & newton.is_less(high);
            let next = is_between.select(newton, (low + high) * 0.5);
            let moves = near.is_less((next - t).map(f32::abs));
            t = next;
            if !(moves & found).any() {
                break;
            }
        }
        t
    }

    /// Newton's steps in f64 on the field itself, and its gradient.
    #[inline(always)]
    fn polish<const N: usize>(
        &mut self,
        locals: &Locals,
        crossings: &Crossings,
        guess: Lanes<f32>,
    ) {
        const MOST_STEPS: usize = 6;
        let Crossings { start, end, .. } = *crossings;
        let direction: [_; 3] = array_of(|axis| self.packet.direction[axis].map(f64::from));
        let mut t = guess.map(f64::from);
        // What a step leaves is its square, and the normal, from before it, is off by it over the distance
        // from a centre. But for α = 1, whose slope jumps at a rim: then it may leave as much again.
        let last = if N == 3 { 1e-8 } else { 1e-6 };
        let radii = self.nearby.kept.iter().map(|&at| self.nearby.balls[at as usize].radius);
        let last_step = last * f64::from(radii.fold(f32::INFINITY, f32::min));
        let mut todo = crossings.found.bits();
        for _ in 0..MOST_STEPS {
            let (excess, gradient) = self.field::<N>(locals, &direction, t);
            let [x, y, z] = gradient;
            let slope = x * direction[0] + y * direction[1] + z * direction[2];
            let step = excess.zip(slope, |excess, slope| excess / slope);
            t = t - step;
            for lane in lanes_of(todo) {
                let (here, step) = (t.0[lane], step.0[lane]);
                let is_between = here >= f64::from(start.0[lane]) && here <= f64::from(end.0[lane]);
                let is_close = step.abs() <= last_step.min(last * f64::from(locals.half.0[lane]));
                if is_between && !is_close {
                    continue;
                }
                todo &= !(1 << lane);
                let t = locals.base.0[lane] + here;
                // Past the ray's end by a rounding: too close to call here.
                if is_between && t <= self.stretch.1.0[lane] {
                    let gradient = glam::DVec3::from(array_of(|axis| gradient[axis].0[lane]));
                    self.results[lane] = Answer::Root(t.max(self.stretch.0.0[lane]), gradient);
                }
            }
            if todo == 0 {
                break;
            }
        }
    }

    /// F − T and the gradient of F, 1/scene unit.
    #[inline(always)]
    fn field<const N: usize>(
        &self,
        locals: &Locals,
        direction: &[Lanes<f64>; 3],
        t: Lanes<f64>,
    ) -> (Lanes<f64>, [Lanes<f64>; 3]) {
        let mut point = locals.origin;
        for axis in 0..3 {
            point[axis] += t * direction[axis];
        }
        let mut sum = Lanes::splat(-self.question.threshold);
        let mut gradient = [Lanes::splat(0.0f64); 3];
        for &at in &self.nearby.kept {
            let ball = &self.nearby.balls[at as usize];
            let [x, y, z] = array_of(|axis| Lanes::splat(ball.exact[axis]) - point[axis]);
            let v = (x * x + y * y + z * z)
                .map(|distance| (1.0 - distance * ball.inverse_square).max(0.0));
            let strength = f64::from(ball.strength);
            let (value, slope) = self.question.value_and_slope::<N>(v);
            sum += value * strength;
            let pull = slope * (strength * ball.inverse_square * 2.0);
            for (sum, offset) in gradient.iter_mut().zip([x, y, z]) {
                *sum += offset * pull;
            }
        }
        (sum, gradient)
    }
}

impl<const N: usize> Enclosure<N> {
    /// Where the signs of the true coefficients, wherever between the two they lie, change once, from
    /// below to above.
    #[inline(always)]
    fn changes_sign_once(&self) -> Mask {
        let zero = Lanes::splat(0.0f32);
        let one = Lanes::splat(1u32);
        let count = |mut run: Mask, lanes: &mut dyn Iterator<Item = Mask>| {
            let mut count = Lanes::splat(0u32);
            for mask in lanes {
                run = run & mask;
                count += run & one;
            }
            count
        };
        let all = !Mask::NONE;
        let below = count(all, &mut self.upper.iter().map(|c| c.is_less(zero)));
        let above = count(all, &mut self.lower.iter().rev().map(|c| zero.is_less(*c)));
        let none = Lanes::splat(0u32);
        none.is_less(below)
            & none.is_less(above)
            & Lanes::splat(N as u32).is_at_most(below + above + one)
    }

    /// Where the control polygon of the upper polynomial first crosses zero upwards; 1 where nowhere.
    #[inline(always)]
    fn polygon_crossing(&self) -> Lanes<f32> {
        let zero = Lanes::splat(0.0f32);
        let mut x = Lanes::splat(1.0f32);
        for k in (1..N).rev() {
            let (below, above) = (self.upper[k - 1], self.upper[k]);
            let share = below.zip(above, |below, above| below / (below - above));
            let at = share.map(|share| ((k - 1) as f32 + share) * (1.0 / (N - 1) as f32));
            x = (below.is_less(zero) & zero.is_at_most(above)).select(at, x);
        }
        x
    }
}

/// Where polynomials that are negative at 0 first may reach 0, never after the first root; 1 where
/// they reach it nowhere. As [`super::bernstein::negative_until`].
#[inline(always)]
fn negative_until<const N: usize>(upper: &[Lanes<f32>; N]) -> Lanes<f32> {
    const CLIPS: usize = 2;
    let (zero, one) = (Lanes::splat(0.0f32), Lanes::splat(1.0f32));
    // Lerps err by 3u of the largest coefficient, N − 1 of them in a restriction.
    let largest = upper.iter().fold(zero, |largest, c| largest.max(c.map(f32::abs)));
    let guard = largest * (8.0 * N as f32 * UNIT);
    let mut coefficients: [_; N] = array_of(|k| upper[k] + guard);
    let mut start = zero;
    for clip in 0..CLIPS {
        let first = coefficients[0];
        let steepest = (2..N).fold(coefficients[1] - first, |steepest, k| {
            ((coefficients[k] - first) * (1.0 / k as f32)).max(steepest)
        });
        let x = first.zip(steepest, |first, steepest| {
            let x = -first / ((N - 1) as f32 * steepest) * (1.0 - 1e-6);
            if steepest > 0.0 && x < 1.0 { x } else { 1.0 }
        });
        let x = x.max(zero);
        start = start + (one - start) * x;
        if clip + 1 < CLIPS {
            right_of(&mut coefficients, x);
        }
    }
    start
}
