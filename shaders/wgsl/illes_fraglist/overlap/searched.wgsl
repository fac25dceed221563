// More separators than the array has room for: the rest of the ray is searched without it, in
// stretches that each take one walk along the list. It costs time, and the picture stays right.

#import illes_fraglist::balls::{ball_of_rank, effective_distance, segment_of}
#import illes_fraglist::balls::support_of_rank
#import illes_fraglist::polynomial_root::first_root_of_polynomial
#import illes_fraglist::budget
#import illes_fraglist::cubic_root::NO_ROOT
#import illes_fraglist::lists
#import illes_fraglist::polynomial::{add_kernel, constant, Polynomial}
#import kernel::kernel
#import core::scene::scene
#import strength::strength
#import work::{count_evaluations, count_leaf_test}

// Whether a ray can be searched without the array.
fn can_search() -> bool {
    return true;
}

// The greatest float.
const FAR: f32 = 0x1.fffffep+127f;

// What one walk along the list tells of a stretch of the ray.
struct Stretch {
    // The field less the threshold, where no chord begins or ends inside.
    field: Polynomial,
    // The field is nowhere above this: the sum of each ball's greatest value, rounding included.
    bound: f32,
    // Where the first chord begins or ends inside; the greatest float where none does.
    separator: f32,
    // Whether no chord goes on behind the stretch.
    is_last: bool,
}

// Searches from the position to the limit, at first in a stretch of a width, scene units; 0: as long as the
// first ball's radius. Returns the first root, or NO_ROOT with the position as far as was searched: short
// of the limit where the budget is spent, and to be gone on from with the width that is left.
fn search_crowd(
    head: u32,
    direction: vec3<f32>,
    limit: f32,
    position: ptr<function, f32>,
    width: ptr<function, f32>,
) -> f32 {
    if *width == 0.0 {
        *width = support_of_rank(lists::rank_at(head)).radius;
    }
    while *position < limit && budget::can_go_on() {
        let start = *position;
        // However short, a stretch reaches the next float, and no further: two floats on, a separator
        // may lie between, and no stretch before it would ever end there.
        let next = bitcast<f32>(bitcast<u32>(start) + 1u);
        let end = min(max(start + *width, next), limit);
        let stretch = look_at_stretch(head, direction, start, end);
        if stretch.bound >= scene.threshold {
            if stretch.separator < end {
                // Too much in one stretch: half of it, or at last the piece before the separator.
                *width = max(0.5 * (end - start), stretch.separator - start);
                continue;
            }
            let root = first_root_of_polynomial(stretch.field);
            if root >= 0.0 {
                return start + root * (end - start);
            }
        }
        *position = select(end, limit, stretch.is_last);
        *width = 2.0 * (end - start);
    }
    return NO_ROOT;
}

fn look_at_stretch(head: u32, direction: vec3<f32>, start: f32, end: f32) -> Stretch {
    count_leaf_test();
    var stretch = Stretch(constant(-scene.threshold), 0.0, FAR, true);
    var balls = 0u;
    var place = head;
    while place != lists::END {
        place = add_ball(place, direction, start, end, &stretch);
        place = add_ball(place, direction, start, end, &stretch);
        place = add_ball(place, direction, start, end, &stretch);
        place = add_ball(place, direction, start, end, &stretch);
        balls += 4u;
    }
    budget::spend(balls / 4u + 1u);
    count_evaluations(balls);
    // A sum of n terms that are not negative, each of a few roundings (numerics, section 9).
    stretch.bound *= 1.0 + f32(balls + 16u) * 0x1p-22f;
    return stretch;
}

// Adds a ball of the list to a stretch. Returns the next place; END behind the last ball that reaches
// the stretch.
fn add_ball(
    place: u32,
    direction: vec3<f32>,
    start: f32,
    end: f32,
    stretch: ptr<function, Stretch>,
) -> u32 {
    if place == lists::END {
        return lists::END;
    }
    let rank = lists::rank_at(place);
    let support = support_of_rank(rank);
    if effective_distance(support) > end {
        (*stretch).is_last = false;
        return lists::END;
    }
    let segment = segment_of(support.center, support.radius, direction);
    let enter = segment.middle - segment.half;
    let leave = segment.middle + segment.half;
    (*stretch).is_last = (*stretch).is_last && leave <= end;
    if segment.half > 0.0 && leave > start && enter < end {
        let separator = min(select(FAR, enter, enter > start), select(FAR, leave, leave < end));
        (*stretch).separator = min((*stretch).separator, separator);
        let ratio = segment.half / support.radius;
        let depth = ratio * ratio;
        let weight = strength(ball_of_rank[rank]);
        let ends = (vec2(start, end) - segment.middle) / support.radius;
        let nearest = clamp(0.0, ends.x, ends.y);
        (*stretch).bound += weight * kernel(depth - nearest * nearest);
        var field = (*stretch).field;
        add_kernel(&field, depth, ends, weight);
        (*stretch).field = field;
    }
    return lists::after(place);
}
