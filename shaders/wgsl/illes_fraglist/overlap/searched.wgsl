// The rest of the ray is searched without the array, in intervals that each take one walk along the list.
// It costs time, and the picture stays right.

#import core::scene::scene
#import illes_fraglist::balls::{ball_of_rank, effective_distance, segment_of, support_of_rank}
#import illes_fraglist::budget
#import illes_fraglist::cubic_root::NO_ROOT
#import illes_fraglist::lists
#import illes_fraglist::polynomial::{add_kernel, constant, Polynomial}
#import illes_fraglist::polynomial_root::first_root_of_polynomial
#import kernel::kernel
#import strength::strength
#import work::{count_evaluations, count_leaf_test}

fn can_search() -> bool {
    return true;
}

// The greatest float.
const FAR: f32 = 0x1.fffffep+127f;

// What one walk along the list finds of an interval of the ray.
struct Interval {
    // The field less the threshold, where no chord begins or ends inside.
    field: Polynomial,
    // An upper bound of the field: the sum of each ball's greatest value, rounding included.
    upper_bound: f32,
    // Where the first chord begins or ends inside; the greatest float where none does.
    separator: f32,
    // Whether no chord continues behind the interval.
    is_last: bool,
}

fn search_without_array(
    head: u32,
    direction: vec3<f32>,
    limit: f32,
    position: ptr<function, f32>,
    width: ptr<function, f32>,
) -> f32 {
    if *width == 0.0 {
        *width = support_of_rank(lists::rank_at(head)).radius;
    }
    while *position < limit && budget::can_continue() {
        let start = *position;
        // However short, an interval reaches the next float, and no further: two floats on, a separator
        // may lie between, and no interval before it would ever end there.
        let next = bitcast<f32>(bitcast<u32>(start) + 1u);
        let end = min(max(start + *width, next), limit);
        let interval = interval_from(head, direction, start, end);
        if interval.upper_bound >= scene.threshold {
            if interval.separator < end {
                // Too much in one interval: half of it, or at last the piece before the separator.
                *width = max(0.5 * (end - start), interval.separator - start);
                continue;
            }
            let root = first_root_of_polynomial(interval.field);
            if root >= 0.0 {
                return start + root * (end - start);
            }
        }
        *position = select(end, limit, interval.is_last);
        *width = 2.0 * (end - start);
    }
    return NO_ROOT;
}

fn interval_from(head: u32, direction: vec3<f32>, start: f32, end: f32) -> Interval {
    count_leaf_test();
    var interval = Interval(constant(-scene.threshold), 0.0, FAR, true);
    var balls = 0u;
    var node = head;
    while node != lists::END {
        node = add_ball(node, direction, start, end, &interval);
        node = add_ball(node, direction, start, end, &interval);
        node = add_ball(node, direction, start, end, &interval);
        node = add_ball(node, direction, start, end, &interval);
        balls += 4u;
    }
    budget::spend(balls / 4u + 1u);
    count_evaluations(balls);
    // A sum of n terms that are not negative, each of a few roundings, errs by less than this part of it.
    interval.upper_bound *= 1.0 + f32(balls + 16u) * 0x1p-22f;
    return interval;
}

// Adds a ball of the list to an interval. Returns the next node; END behind the last ball that reaches
// the interval.
fn add_ball(
    node: u32,
    direction: vec3<f32>,
    start: f32,
    end: f32,
    interval: ptr<function, Interval>,
) -> u32 {
    if node == lists::END {
        return lists::END;
    }
    let rank = lists::rank_at(node);
    let support = support_of_rank(rank);
    if effective_distance(support) > end {
        (*interval).is_last = false;
        return lists::END;
    }
    let segment = segment_of(support.center, support.radius, direction);
    let enter = segment.middle - segment.half;
    let leave = segment.middle + segment.half;
    (*interval).is_last = (*interval).is_last && leave <= end;
    if segment.half > 0.0 && leave > start && enter < end {
        let separator = min(select(FAR, enter, enter > start), select(FAR, leave, leave < end));
        (*interval).separator = min((*interval).separator, separator);
        let ratio = segment.half / support.radius;
        let depth = ratio * ratio;
        let weight = strength(ball_of_rank[rank]);
        let ends = (vec2(start, end) - segment.middle) / support.radius;
        let nearest = clamp(0.0, ends.x, ends.y);
        (*interval).upper_bound += weight * kernel(depth - nearest * nearest);
        var field = (*interval).field;
        add_kernel(&field, depth, ends, weight);
        (*interval).field = field;
    }
    return lists::after(node);
}
