// The field between two separators as the polynomial that it is: of degree four or six along a ray
// for kernels of degree two or three in v = 1 - r²/R² (section 3: "it is also possible to use exact
// polynomials for appropriately chosen density functions").
#define_import_path metaball::illes_fraglist::piece

#import metaball::illes_fraglist::balls::{ball_of_rank, segment_of, support_of_rank}
#import metaball::illes_fraglist::bernstein::first_root_of_polynomial
#import metaball::illes_fraglist::budget
#import metaball::illes_fraglist::cubic::NO_ROOT
#import metaball::illes_fraglist::polynomial::{add_kernel, constant, Polynomial}
#import metaball::illes_fraglist::records::{ENTER, LEAVE, MOST}
#import metaball::scene::scene
#import metaball::strength::strength
#import metaball::work::{count_balls, count_evaluations, count_leaf_test}

struct Active {
    rank: u32,
    middle: f32,
    // v at the midpoint, Q²/R².
    depth: f32,
    radius: f32,
    weight: f32,
}

// Each active ball's LEAVE is among the records, so there are at most as many.
var<private> current: array<Active, MOST>;
var<private> count: u32;

fn pass_separator(rank: u32, kind: u32, direction: vec3<f32>) {
    if kind == ENTER {
        let support = support_of_rank(rank);
        let segment = segment_of(support.center, support.radius, direction);
        let ratio = segment.half / support.radius;
        let weight = strength(ball_of_rank[rank]);
        current[count] =
            Active(rank, segment.middle, ratio * ratio, support.radius, weight);
        count++;
        count_balls(1u);
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

// The first point in [start, end] where the field reaches the threshold, or NO_ROOT. No separator lies
// between the two.
fn first_root(start: f32, end: f32) -> f32 {
    count_leaf_test();
    count_evaluations(count);
    var sum = constant(-scene.threshold);
    for (var place = 0u; place < count; place++) {
        let ball = current[place];
        let ends = (vec2(start, end) - ball.middle) / ball.radius;
        add_kernel(&sum, ball.depth, ends, ball.weight);
    }
    budget::spend(count);
    let root = first_root_of_polynomial(sum);
    return select(NO_ROOT, start + root * (end - start), root >= 0.0);
}
