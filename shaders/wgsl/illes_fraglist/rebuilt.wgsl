// The field between two separators as a cubic, made anew from the balls that are active there.
//
// A ball's cubic on either half of its interval has values 0 and γ and flat ends, so on any part of
// it values and slopes at the part's two ends tell all; their sums over the active balls are the
// sum's. The printed sum of coefficients (absolute.wgsl) loses its digits with the distance from the
// eye, and drifts when it is shifted along; this is right to 1.3e-6 of T at any distance and length.
#define_import_path metaball::illes_fraglist::piece

#import metaball::field::contribution
#import metaball::illes_fraglist::balls::{ball_of_rank, segment_of, support_of_rank}
#import metaball::illes_fraglist::budget
#import metaball::illes_fraglist::cubic::{first_root_of_cubic, NO_ROOT}
#import metaball::illes_fraglist::records::{ENTER, LEAVE, MOST}
#import metaball::scene::scene
#import metaball::work::{count_balls, count_evaluations, count_leaf_test}

struct Active {
    rank: u32,
    middle: f32,
    half: f32,
    // γ: the ball's field at the midpoint.
    peak: f32,
}

// Each active ball's LEAVE is among the records, so there are at most as many.
var<private> current: array<Active, MOST>;
var<private> count: u32;

fn pass_separator(rank: u32, kind: u32, direction: vec3<f32>) {
    if kind == ENTER {
        let support = support_of_rank(rank);
        let segment = segment_of(support.center, support.radius, direction);
        let ratio = segment.half / support.radius;
        let peak = contribution(ball_of_rank[rank], ratio * ratio);
        current[count] = Active(rank, segment.middle, segment.half, peak);
        count++;
        count_balls(1u);
        count_evaluations(1u);
    } else if kind == LEAVE {
        var place = 0u;
        while place < count && current[place].rank != rank {
            place++;
        }
        budget::spend(place);
        if place < count {
            count--;
            current[place] = current[count];
        }
    }
}

// The first point in [start, end] where the cubic reaches the threshold, or NO_ROOT. No separator lies
// between the two.
fn first_root(start: f32, end: f32) -> f32 {
    count_leaf_test();
    var values = vec2(-scene.threshold);
    var slopes = vec2(0.0);
    for (var place = 0u; place < count; place++) {
        let ball = current[place];
        // Parts of the half interval from the ball's end: 0 there, 1 at the midpoint.
        let parts = clamp(1.0 - abs(vec2(start, end) - ball.middle) / ball.half, vec2(0.0), vec2(1.0));
        let rises = 0.5 * (start + end) < ball.middle;
        values += ball.peak * parts * parts * (3.0 - 2.0 * parts);
        slopes += select(-ball.peak, ball.peak, rises) / ball.half
            * (6.0 * parts * (1.0 - parts));
    }
    budget::spend(count);
    let third = (end - start) / 3.0;
    let inner = values + vec2(third, -third) * slopes;
    let root = first_root_of_cubic(vec4(values.x, inner, values.y));
    return select(NO_ROOT, start + root * (end - start), root >= 0.0);
}
