// As the polynomial that it is: of degree four or six along a ray for kernels of degree two or three in
// v = 1 - r²/R² (section 3: "it is also possible to use exact polynomials for appropriately chosen
// density functions").

#import core::scene::scene
#import illes_fraglist::active
#import illes_fraglist::balls::ball_of_rank
#import illes_fraglist::budget
#import illes_fraglist::cubic_root::NO_ROOT
#import illes_fraglist::polynomial::{add_kernel, constant, Polynomial}
#import illes_fraglist::polynomial_root::first_root_of_polynomial
#import illes_fraglist::records::{ENTER, LEAVE}
#import strength::strength
#import work::{count_evaluations, count_leaf_test}

// A ball's weight is its strength.
fn pass_separator(rank: u32, kind: u32, direction: vec3<f32>) {
    if kind == ENTER {
        var ball = active::ball_along(rank, direction);
        ball.weight = strength(ball_of_rank[rank]);
        active::enter(ball);
    } else if kind == LEAVE {
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
