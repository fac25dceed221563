// A ray in a leaf's box, relative to an origin near the leaf.

#import core::nearby_origin::{grid_width, nearby_origin, on_grid, NearbyOrigin, UNIT}
#import core::ray::Ray

// All distances along the ray count from its point at t = `base`, the nearby origin.
struct RelativeRay {
    // Near the leaf's middle; the start itself of a ray that starts in the leaf.
    origin: NearbyOrigin,
    base: f32,
    // Where the ray enters and leaves the leaf's box; empty where it does not.
    enter: f32,
    leave: f32,
    // Whether the ray starts in the box, give or take rounding.
    starts: bool,
    // Whether it certainly does.
    starts_within: bool,
    // Whether the ray itself ends before it leaves the box.
    ends: bool,
    // How far past the box's faces `enter` and `leave` reach: what rounding may do to a point of the ray.
    slack: f32,
}

// The ray's t at a relative one.
fn t_at(relative: RelativeRay, t: f32) -> f32 {
    return relative.base + t;
}

fn relative_ray(ray: Ray, inverse: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> RelativeRay {
    let middle = 0.5 * low + 0.5 * high;
    let grid = grid_width(ray.origin, middle);
    // For a ray that starts in the leaf the origin is its start, which no rounding moves.
    let starts_within = all(low <= ray.origin) && all(ray.origin <= high);
    let center = select(on_grid(middle, grid), ray.origin, starts_within);
    let base = dot(center - ray.origin, ray.direction);
    let origin = nearby_origin(ray.origin, ray.direction, base, center, grid);

    // Faces are moved out by what rounding may do to the ray's points, not the ends of the interval: along
    // a ray in the plane of a face no length would make up for it.
    let extent = high - low;
    let size = max(max(extent.x, extent.y), extent.z);
    let slack = origin.misplaced + UNIT * (8.0 * size + 4.0 * length(origin.offset));
    let to_low = ((low - center) - origin.offset - slack) * inverse;
    let to_high = ((high - center) - origin.offset + slack) * inverse;
    let near = min(to_low, to_high);
    let far = max(to_low, to_high);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    let limit = ray.t_max - base;
    let last = min(leave, limit);
    return RelativeRay(
        origin, base,
        max(enter, -base), last, enter <= -base && -base <= last, starts_within, limit <= leave,
        slack,
    );
}
