// As the printed running cubic: coefficients of (t³, t², t, 1), to which each separator adds its Δw
// (section 4). In f32 this is wrong by 4 % of a ball ten radii from
// the eye and by half a ball at thirty; it is here to show that.

#import core::field::contribution
#import core::scene::scene
#import illes_fraglist::balls::{ball_of_rank, segment_of, support_of_rank}
#import illes_fraglist::cubic_root::{first_root_of_cubic, NO_ROOT}
#import illes_fraglist::records::{ENTER, LEAVE}
#import work::{count_balls, count_evaluations, count_leaf_test}

// w of the paper.
var<private> running: vec4<f32>;

// Adds Δw. The printed factor γ(s) must be γ(m): it vanishes at both ends otherwise.
fn pass_separator(rank: u32, kind: u32, direction: vec3<f32>) {
    let support = support_of_rank(rank);
    let segment = segment_of(support.center, support.radius, direction);
    let ratio = segment.half / support.radius;
    // A shorter chord adds less than rounding, and its cube may be zero.
    if ratio < 1e-6 {
        return;
    }
    let q = segment.half;
    let factor = contribution(ball_of_rank[rank], ratio * ratio) / (q * q * q);
    count_balls(1u);
    count_evaluations(1u);
    if kind == ENTER {
        let s = segment.middle - q;
        let tail = vec2(-6.0 * s * (s + q), s * s * (2.0 * s + 3.0 * q));
        running += factor * vec4(-2.0, 6.0 * s + 3.0 * q, tail);
    } else if kind == LEAVE {
        let s = segment.middle + q;
        let tail = vec2(-6.0 * s * (s - q), s * s * (2.0 * s - 3.0 * q));
        running += factor * vec4(-2.0, 6.0 * s - 3.0 * q, tail);
    } else {
        let s = segment.middle;
        running += factor * vec4(4.0, -12.0 * s, 12.0 * s * s, -4.0 * s * s * s);
    }
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
