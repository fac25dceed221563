// As the published cubic, made anew from the balls that are active there. Not published.
//
// A ball's cubic on either half of its interval has values 0 and γ and flat ends, so on any part of
// it values and slopes at the part's two ends determine it; their sums over the active balls are the
// sum's. The printed sum of coefficients (the implementation running_cubic) loses its digits with the
// distance from the eye, and drifts when it is shifted along; this is right to 1.3e-6 of T at any
// distance and length.

#import core::field::contribution
#import core::scene::scene
#import illes_fraglist::active
#import illes_fraglist::balls::{ball_of_rank, Segment}
#import illes_fraglist::budget
#import illes_fraglist::cubic_root::{first_root_of_cubic, NO_ROOT}
#import work::{count_evaluations, count_leaf_test}

struct Change {
    // Of illes_fraglist::active.
    label: u32,
}

struct Changes {
    enter: Change,
    middle: Change,
    leave: Change,
}

fn changes_of(rank: u32, segment: Segment, radius: f32) -> Changes {
    let enter = Change(active::label_of(rank, active::ENTER));
    let middle = Change(active::label_of(rank, active::MIDDLE));
    return Changes(enter, middle, Change(active::label_of(rank, active::LEAVE)));
}

// A ball's weight is γ, its field at the midpoint.
fn pass_separator(change: Change, direction: vec3<f32>) {
    let rank = active::rank_of(change.label);
    let kind = active::kind_of(change.label);
    if kind == active::ENTER {
        var ball = active::ball_along(rank, direction);
        ball.weight = contribution(ball_of_rank[rank], active::depth_of(ball));
        active::enter(ball);
        count_evaluations(1u);
    } else if kind == active::LEAVE {
        active::leave(rank);
    }
}

fn first_root(start: f32, end: f32) -> f32 {
    count_leaf_test();
    var values = vec2(-scene.threshold);
    var slopes = vec2(0.0);
    for (var index = 0u; index < active::count; index++) {
        let ball = active::balls[index];
        // Parts of the half interval from the ball's end: 0 there, 1 at the midpoint.
        let parts = clamp(1.0 - abs(vec2(start, end) - ball.middle) / ball.half, vec2(0.0), vec2(1.0));
        let rises = 0.5 * (start + end) < ball.middle;
        values += ball.weight * parts * parts * (3.0 - 2.0 * parts);
        slopes += select(-ball.weight, ball.weight, rises) / ball.half
            * (6.0 * parts * (1.0 - parts));
    }
    budget::spend(active::count);
    let third = (end - start) / 3.0;
    let inner = values + vec2(third, -third) * slopes;
    let root = first_root_of_cubic(vec4(values.x, inner, values.y));
    return select(NO_ROOT, start + root * (end - start), root >= 0.0);
}

// Nothing: the active balls follow from the list.
fn kept_sum() -> vec4<f32> {
    return vec4(0.0);
}

fn restore_sum(sum: vec4<f32>) {}

fn can_wait_before(at: f32, position: f32) -> bool {
    return true;
}
