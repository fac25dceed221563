// Balls in the order of a frame, and a ball along a ray (Illés and Szécsi, section 3, figure 5).

#import core::scene::Support
#import core::view::{view, NO_LIMIT}
#import support::support_of

// Balls by rising effective distance. A ball's index here is its rank: lists hold ranks, so that
// putting a list in order is sorting numbers, and equal distances have an order, too.
@group(2) @binding(0) var<storage, read> ball_of_rank: array<u32>;
// Radius of each ball's core sphere, scene units; 0 where the ball alone never reaches the threshold.
@group(2) @binding(1) var<storage, read> core_radii: array<f32>;

// Where a ray is inside a sphere: [middle - half, middle + half] along the ray, scene units.
struct Segment {
    middle: f32,
    // 0 where the ray does not meet the sphere.
    half: f32,
}

// m_j and Q_j of the paper. Q² comes from the vector across the ray: the printed difference of
// squares loses all digits a few hundred radii from the eye.
fn segment_of(center: vec3<f32>, radius: f32, direction: vec3<f32>) -> Segment {
    let offset = center - view.eye;
    let rough = dot(offset, direction);
    // What rounding left of the offset along the ray, and what the direction lacks to unit length,
    // shows in the small vector that remains.
    let middle = rough + dot(offset - rough * direction, direction);
    let across = offset - middle * direction;
    return Segment(middle, sqrt(max(radius * radius - dot(across, across), 0.0)));
}

// No point of the ball's support is nearer to the eye: the key of the order.
fn effective_distance(support: Support) -> f32 {
    return length(support.center - view.eye) - support.radius;
}

fn support_of_rank(rank: u32) -> Support {
    return support_of(ball_of_rank[rank]);
}

// Whether a segment belongs into its pixel's list: part of it lies between the eye and the limit.
fn is_gathered(segment: Segment, limit: f32) -> bool {
    return segment.half > 0.0 && segment.middle + segment.half >= 0.0
        && segment.middle - segment.half <= limit;
}

// Distance along a ray to a ball's core, 0 with the eye in it; NO_LIMIT where the ray misses it.
fn core_entry(ball: u32, direction: vec3<f32>) -> f32 {
    let segment = segment_of(support_of(ball).center, core_radii[ball], direction);
    let entry = max(segment.middle - segment.half, 0.0);
    return select(NO_LIMIT, entry, is_gathered(segment, NO_LIMIT));
}
