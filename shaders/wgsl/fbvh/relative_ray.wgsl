// A ray seen from beside a leaf, so that distance from its origin o costs no digits.
//
// The point o' = o + base * direction beside the leaf is formed relative to the leaf's centre c as
// (o - c) + base * direction, two large numbers that nearly cancel. Every part of it is made
// exact: c and the bulk of o lie on one coarse grid, so that their difference is exact;
// direction and base are each cut into two numbers of twelve bits, so that their products are.
// Nothing here depends on the order of operations beyond what is written: there is no compensation
// to be optimised away.

#import ray::Ray

struct Frame {
    // c, world space: the leaf's, or the start of a ray that starts in it.
    center: vec3<f32>,
    // o' - c.
    origin: vec3<f32>,
    // The two parts of the ray's t at o'.
    base_high: f32,
    base_low: f32,
    // Where the ray enters and leaves the leaf's box, in t from o'; empty where it does not.
    enter: f32,
    leave: f32,
    // Whether the ray starts in the box, as far as rounding lets one tell.
    starts: bool,
    // Whether it certainly does.
    starts_within: bool,
    // Whether the ray itself ends before it leaves the box.
    ends: bool,
    // How far rounding can misplace `origin`.
    misplaced: f32,
    // How far past the box's faces the stretch reaches: what rounding may do to a point of the ray.
    slack: f32,
}

// The ray's t at a local t.
fn at(frame: Frame, t: f32) -> f32 {
    return frame.base_high + (frame.base_low + t);
}

const UNIT: f32 = 0x1p-23f;

fn upper_bits(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) & vec3(0xfffff000u));
}

fn local_frame(ray: Ray, inverse: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> Frame {
    // A grid of 2^-21 to 2^-22 of the way from the origin to the leaf; where they are one point, finer
    // than all floats of its size.
    let middle = 0.5 * low + 0.5 * high;
    let way = max(abs(middle - ray.origin), 0x1p-20f * abs(middle));
    let reach = max(max(way.x, way.y), max(way.z, 1e-30));
    let grid = bitcast<f32>(bitcast<u32>(reach) & 0x7f800000u) * 0x1p-21f;
    // A ray that starts in the leaf is seen from its start, which is no rounding away.
    let starts_within = all(low <= ray.origin) && all(ray.origin <= high);
    let center = select(floor(middle / grid) * grid, ray.origin, starts_within);
    let start_high = floor(ray.origin / grid) * grid;
    let start_low = ray.origin - start_high;

    let base = dot(center - ray.origin, ray.direction);
    let base_parts = upper_bits(vec3(base, 0.0, 0.0));
    let base_high = base_parts.x;
    let base_low = upper_bits(vec3(base - base_high, 0.0, 0.0)).x;
    let direction_high = upper_bits(ray.direction);
    let direction_low = ray.direction - direction_high;
    let bulk = (start_high - center) + direction_high * base_high;
    let middling = direction_low * base_high + direction_high * base_low;
    let rest = direction_low * base_low + start_low;
    let origin = (bulk + middling) + rest;

    // Faces are moved out by what rounding may do to the ray's points, not the stretch's ends: along a
    // ray in the plane of a face no length would make up for it.
    let extent = high - low;
    let size = max(max(extent.x, extent.y), extent.z) + length(origin);
    let slack = UNIT * (8.0 * size + 2.0 * length(middling));
    let to_low = ((low - center) - origin - slack) * inverse;
    let to_high = ((high - center) - origin + slack) * inverse;
    let near = min(to_low, to_high);
    let far = max(to_low, to_high);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    let start = -base_high - base_low;
    let limit = (ray.t_max - base_high) - base_low;
    let last = min(leave, limit);

    let misplaced = UNIT * (4.0 * length(origin) + 2.0 * length(middling));
    return Frame(
        center, origin, base_high, base_low,
        max(enter, start), last, enter <= start && start <= last, starts_within, limit <= leave,
        misplaced, slack,
    );
}
