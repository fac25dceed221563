// A ray seen from a point of its own, so that distance from the eye costs no digits.
//
// The point eye + base * direction is formed relative to a grid point c near it as
// (eye - c) + base * direction, two large numbers that nearly cancel. Every part of it is made exact:
// c and the bulk of the eye lie on one coarse grid, so that their difference is exact; direction and
// base are each cut into two numbers of twelve bits, so that their products are. There is no
// compensation to be optimised away.

#import core::view::{view, Ray}

const UNIT: f32 = 0x1p-23f;

struct Beside {
    // c, world space.
    center: vec3<f32>,
    // The point less c.
    origin: vec3<f32>,
    // How far off `origin` can be, scene units.
    misplaced: f32,
}

// The view from t = `base`.
fn beside(ray: Ray, base: f32) -> Beside {
    let rough = view.eye + base * ray.direction;
    // A grid of 2^-21 to 2^-22 of the way from the eye, and no finer than the coordinates themselves.
    let way = max(largest(rough - view.eye), 0.25 * max(largest(rough), largest(view.eye)));
    let grid = bitcast<f32>(bitcast<u32>(max(way, 1e-30)) & 0x7f800000u) * 0x1p-21f;
    let center = floor(rough / grid) * grid;
    let eye_high = floor(view.eye / grid) * grid;
    let eye_low = view.eye - eye_high;

    let base_high = upper_bits(vec3(base)).x;
    let base_low = base - base_high;
    let direction_high = upper_bits(ray.direction);
    let direction_low = ray.direction - direction_high;
    let bulk = (eye_high - center) + direction_high * base_high;
    let middling = direction_low * base_high + direction_high * base_low;
    let origin = (bulk + middling) + (direction_low * base_low + eye_low);
    return Beside(center, origin, UNIT * (4.0 * length(origin) + 2.0 * length(middling)));
}

// From the point to a place in the world.
fn offset_to(here: Beside, place: vec3<f32>) -> vec3<f32> {
    return (place - here.center) - here.origin;
}

fn upper_bits(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) & vec3(0xfffff000u));
}

fn largest(x: vec3<f32>) -> f32 {
    return max(max(abs(x.x), abs(x.y)), abs(x.z));
}
