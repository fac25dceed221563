// The field between two separators as the polynomial that it is: of degree four or six along a ray
// for kernels of degree two or three in v = 1 - r²/R² (section 3: "it is also possible to use exact
// polynomials for appropriately chosen density functions").
//
// Along a ray v is a parabola, with three Bernstein coefficients on an interval; those of its powers
// follow (numerics: products in Bernstein form), and their sum over the active balls is the field's.
#define_import_path metaball::illes_fraglist::piece

#import metaball::illes_fraglist::balls::{ball_of_rank, segment_of, support_of_rank}
#import metaball::illes_fraglist::bernstein::{first_root_of_polynomial, is_quartic, Polynomial}
#import metaball::illes_fraglist::budget
#import metaball::illes_fraglist::cubic::NO_ROOT
#import metaball::illes_fraglist::records::{ENTER, LEAVE, MOST}
#import metaball::scene::scene
#import metaball::strength::strength
#import metaball::work::{count_balls, count_evaluations, count_leaf_test}

// The kernel: the sum of these weights times v, v² and v³.
@id(50) override once_weight: f32 = 0.0;
@id(51) override twice_weight: f32 = 1.0;
@id(52) override thrice_weight: f32 = 0.0;

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
    var sum = Polynomial(vec4(-scene.threshold), vec3(-scene.threshold));
    for (var place = 0u; place < count; place++) {
        let ball = current[place];
        let ends = (vec2(start, end) - ball.middle) / ball.radius;
        let v = ball.depth - vec3(ends.x * ends.x, ends.x * ends.y, ends.y * ends.y);
        add_kernel(&sum, max(v.x, 0.0), v.y, max(v.z, 0.0), ball.weight);
    }
    budget::spend(count);
    let root = first_root_of_polynomial(sum);
    return select(NO_ROOT, start + root * (end - start), root >= 0.0);
}

// Adds q k(v) for the parabola v with Bernstein coefficients a, b, c.
fn add_kernel(sum: ptr<function, Polynomial>, a: f32, b: f32, c: f32, q: f32) {
    // The parabola and its square, as degree four.
    let once = array(a, 0.5 * (a + b), (a + 4.0 * b + c) / 6.0, 0.5 * (b + c), c);
    let twice = array(a * a, a * b, (a * c + 2.0 * b * b) / 3.0, b * c, c * c);
    let low = vec4(
        once_weight * once[0] + twice_weight * twice[0],
        once_weight * once[1] + twice_weight * twice[1],
        once_weight * once[2] + twice_weight * twice[2],
        once_weight * once[3] + twice_weight * twice[3],
    );
    let last = once_weight * once[4] + twice_weight * twice[4];
    if is_quartic() {
        (*sum).low += q * low;
        (*sum).high += q * vec3(last, 0.0, 0.0);
        return;
    }
    // Raised to degree six, and the cube.
    let raised = array(
        low.x,
        (low.x + 2.0 * low.y) / 3.0,
        (low.x + 8.0 * low.y + 6.0 * low.z) / 15.0,
        (low.y + 3.0 * low.z + low.w) / 5.0,
        (6.0 * low.z + 8.0 * low.w + last) / 15.0,
        (2.0 * low.w + last) / 3.0,
        last,
    );
    let ends = vec2(a * a * a, c * c * c);
    let second = vec2(a * a * b, b * c * c);
    let third = vec2(a * (a * c + 4.0 * b * b), c * (a * c + 4.0 * b * b)) / 5.0;
    let middle = b * (2.0 * b * b + 3.0 * a * c) / 5.0;
    let front = vec4(ends.x, second.x, third.x, middle);
    let back = vec3(third.y, second.y, ends.y);
    (*sum).low += q * (vec4(raised[0], raised[1], raised[2], raised[3]) + thrice_weight * front);
    (*sum).high += q * (vec3(raised[4], raised[5], raised[6]) + thrice_weight * back);
}
