// Coordinates relative to an origin near a part of a ray, so that distance from the ray's start costs no
// digits.
//
// The origin o' = o + base * direction on a ray from o is formed relative to a point c near it, as
// (o - c) + base * direction, two large numbers that nearly cancel. Every part of it is made exact: c and
// the bulk of o lie on one coarse grid, so that their difference is exact; direction and base are each
// cut into two numbers of twelve bits, so that their products are. Nothing here depends on the order of
// operations beyond what is written: there is no compensation to be optimised away.

const UNIT: f32 = 0x1p-23f;

struct NearbyOrigin {
    // c, world space.
    center: vec3<f32>,
    // o' - c.
    offset: vec3<f32>,
    // How far rounding can misplace `offset`, scene units.
    misplaced: f32,
}

// The width of the grid for an origin near a point: 2^-21 to 2^-22 of the way there from the ray's start;
// where they are one point, finer than all floats of its size.
fn grid_width(start: vec3<f32>, point: vec3<f32>) -> f32 {
    let way = max(abs(point - start), 0x1p-20f * abs(point));
    let reach = max(max(way.x, way.y), max(way.z, 1e-30));
    return bitcast<f32>(bitcast<u32>(reach) & 0x7f800000u) * 0x1p-21f;
}

fn on_grid(point: vec3<f32>, grid: f32) -> vec3<f32> {
    return floor(point / grid) * grid;
}

// The origin at t = `base` of a ray. `center` is near it, and on the grid or the ray's start.
fn nearby_origin(
    start: vec3<f32>,
    direction: vec3<f32>,
    base: f32,
    center: vec3<f32>,
    grid: f32,
) -> NearbyOrigin {
    let start_high = on_grid(start, grid);
    let start_low = start - start_high;
    let base_high = upper_bits(vec3(base)).x;
    let base_low = base - base_high;
    let direction_high = upper_bits(direction);
    let direction_low = direction - direction_high;
    let bulk = (start_high - center) + direction_high * base_high;
    let middling = direction_low * base_high + direction_high * base_low;
    let offset = (bulk + middling) + (direction_low * base_low + start_low);
    return NearbyOrigin(center, offset, UNIT * (4.0 * length(offset) + 2.0 * length(middling)));
}

// From the origin to a point in the world.
fn relative_to(origin: NearbyOrigin, point: vec3<f32>) -> vec3<f32> {
    return (point - origin.center) - origin.offset;
}

// The upper twelve bits of each significand.
fn upper_bits(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) & vec3(0xfffff000u));
}
