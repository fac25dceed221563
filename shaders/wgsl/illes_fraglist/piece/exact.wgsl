// As the polynomial that it is: of degree four or six along a ray for kernels of degree two or three in
// v = 1 - r²/R² (section 3: "it is also possible to use exact polynomials for appropriately chosen
// density functions").

#import core::scene::scene
#import illes_fraglist::active
#import illes_fraglist::balls::{ball_of_rank, Segment}
#import illes_fraglist::budget
#import illes_fraglist::cubic_root::NO_ROOT
#import illes_fraglist::polynomial::{add_kernel, constant, Polynomial}
#import illes_fraglist::polynomial_root::first_root_of_polynomial
#import strength::strength
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

// A ball's weight is its strength.
fn pass_separator(change: Change, direction: vec3<f32>) {
    let rank = active::rank_of(change.label);
    let kind = active::kind_of(change.label);
    if kind == active::ENTER {
        var ball = active::ball_along(rank, direction);
        ball.weight = strength(ball_of_rank[rank]);
        active::enter(ball);
    } else if kind == active::LEAVE {
        active::leave(rank);
    }
}

fn first_root(start: f32, end: f32) -> f32 {
    count_leaf_test();
    count_evaluations(active::count);
    var sum = constant(-scene.threshold);
    for (var index = 0u; index < active::count; index++) {
        let ball = active::balls[index];
        let ends = (vec2(start, end) - ball.middle) / ball.radius;
        add_kernel(&sum, active::depth_of(ball), ends, ball.weight);
    }
    budget::spend(active::count);
    let root = first_root_of_polynomial(sum);
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
