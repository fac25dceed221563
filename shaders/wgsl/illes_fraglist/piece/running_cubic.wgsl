// As the printed running cubic w: coefficients of (t³, t², t, 1), to which each separator adds its Δw, made
// once when its ball is taken from the list (sections 4 and 6). In f32 this is wrong by 4 % of a ball ten
// radii from the eye and by half a ball at thirty.

#import core::field::contribution
#import core::scene::scene
#import illes_fraglist::balls::{ball_of_rank, Segment}
#import illes_fraglist::cubic_root::{first_root_of_cubic, NO_ROOT}
#import work::{count_balls, count_evaluations, count_leaf_test}

struct Change {
    // Δw.
    coefficients: vec4<f32>,
}

struct Changes {
    enter: Change,
    middle: Change,
    leave: Change,
}

// w.
var<private> running: vec4<f32>;

// The printed factor γ(s) must be γ(m): it vanishes at both ends otherwise.
fn changes_of(rank: u32, segment: Segment, radius: f32) -> Changes {
    let q = segment.half;
    let ratio = q / radius;
    // A shorter chord adds less than rounding, and its cube may be zero.
    if ratio < 1e-6 {
        return Changes();
    }
    count_balls(1u);
    count_evaluations(1u);
    let factor = contribution(ball_of_rank[rank], ratio * ratio) / (q * q * q);
    let m = segment.middle;
    let enter = end_change(m - q, q);
    let middle = vec4(4.0, -12.0 * m, 12.0 * m * m, -4.0 * m * m * m);
    let leave = end_change(m + q, -q);
    return Changes(Change(factor * enter), Change(factor * middle), Change(factor * leave));
}

// Δw at an end of a chord, in parts of γ/Q³. The table's two rows differ in the sign of Q.
fn end_change(s: f32, q: f32) -> vec4<f32> {
    return vec4(-2.0, 6.0 * s + 3.0 * q, -6.0 * s * (s + q), s * s * (2.0 * s + 3.0 * q));
}

fn pass_separator(change: Change, direction: vec3<f32>) {
    running += change.coefficients;
}

fn first_root(start: f32, end: f32) -> f32 {
    count_leaf_test();
    let ends = vec2(start, end);
    let values = ((running.x * ends + running.y) * ends + running.z) * ends + running.w
        - scene.threshold;
    let slopes = (3.0 * running.x * ends + 2.0 * running.y) * ends + running.z;
    let third = (end - start) / 3.0;
    let inner = values + vec2(third, -third) * slopes;
    let root = first_root_of_cubic(vec4(values.x, inner, values.y));
    return select(NO_ROOT, start + root * (end - start), root >= 0.0);
}

fn kept_sum() -> vec4<f32> {
    return running;
}

fn restore_sum(sum: vec4<f32>) {
    running = sum;
}

// All separators at the position are in the sum that is kept, or none.
fn can_wait_before(at: f32, position: f32) -> bool {
    return at > position;
}
