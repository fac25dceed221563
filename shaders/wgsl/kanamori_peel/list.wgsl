// The list of active balls of a ray (section 4.2), and the search of one interval with them.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at, outward_normal}
#import core::hit
#import core::scene::scene
#import core::view::{view, PrimaryRay}
#import kanamori_peel::arranged::kernel_radii
#import kanamori_peel::bernstein::{along_chord, Curve, degree}
#import kanamori_peel::bezier::{LOST, NO_ROOT, part}
#import kanamori_peel::chord::chord_of
#import kanamori_peel::clipping::first_root
#import kanamori_peel::longest::LONGEST
#import strength::strength
#import support::support_of
#import work::{count_balls, count_leaf_test, count_search_end}

// Outcomes of a search that are no distances.
const NOTHING_FOUND: f32 = -1.0;
const SEARCH_LOST: f32 = -2.0;

var<private> listed: array<u32, LONGEST>;
var<private> listed_count: u32;

// Removes a ball that is on the list, and adds one that is not. False where the list is full.
fn toggle(ball: u32, capacity: u32) -> bool {
    for (var k = 0u; k < listed_count; k++) {
        if listed[k] == ball {
            listed_count--;
            listed[k] = listed[listed_count];
            return true;
        }
    }
    if listed_count == capacity {
        return false;
    }
    listed[listed_count] = ball;
    listed_count++;
    return true;
}

// The first t of [low, high] at which the active balls reach the threshold.
fn search(ray: PrimaryRay, low: f32, high: f32) -> f32 {
    if listed_count == 0u {
        return NOTHING_FOUND;
    }
    count_balls(listed_count);
    if listed_count == 1u {
        return search_single(ray, low, high);
    }
    return search_multiple(ray, low, high);
}

// One ball alone: its kernel sphere.
fn search_single(ray: PrimaryRay, low: f32, high: f32) -> f32 {
    let ball = listed[0];
    let radius = kernel_radii[ball];
    let chord = chord_of(support_of(ball).center - view.eye, radius, ray.direction);
    let half = sqrt(max(chord.half_squared, 0.0));
    let enter = max(chord.middle - half, low);
    let is_met = radius > 0.0 && chord.half_squared >= 0.0;
    return select(NOTHING_FOUND, enter, is_met && enter <= min(chord.middle + half, high));
}

// Several balls: the sum of their curves over the interval, by Bézier clipping.
fn search_multiple(ray: PrimaryRay, low: f32, high: f32) -> f32 {
    count_leaf_test();
    var sum = Curve();
    for (var i = 0u; i <= degree(); i++) {
        sum.d[i] = -scene.threshold;
    }
    let middle = 0.5 * (low + high);
    for (var k = 0u; k < listed_count; k++) {
        let support = support_of(listed[k]);
        let chord = chord_of(support.center - view.eye, support.radius, ray.direction);
        let half = sqrt(max(chord.half_squared, 0.0));
        // A ball whose end was missed, behind a coincident point, stays on the list and adds nothing.
        if abs(middle - chord.middle) < half {
            let a = chord.half_squared / (support.radius * support.radius);
            let ends = (vec2(low, high) - chord.middle + half) / (2.0 * half);
            let within = clamp(ends, vec2(0.0), vec2(1.0));
            add(&sum, along_chord(a, strength(listed[k])), within);
        }
    }
    let root = first_root(sum);
    count_search_end();
    if root == NO_ROOT {
        return NOTHING_FOUND;
    }
    return select(mix(low, high, root), SEARCH_LOST, root == LOST);
}

// Adds the part of a ball's curve between two parameters of its chord.
fn add(sum: ptr<function, Curve>, curve: Curve, ends: vec2<f32>) {
    let restricted = part(curve, ends.x, ends.y);
    for (var i = 0u; i <= degree(); i++) {
        (*sum).d[i] += restricted.d[i];
    }
}

// Writes a hit, with normal and colour from the active balls.
fn write_surface(pixel: u32, ray: PrimaryRay, t: f32) {
    var slope = vec3(0.0);
    blend_start();
    for (var k = 0u; k < listed_count; k++) {
        let ball = listed[k];
        let support = support_of(ball);
        let offset = offset_at(view.eye - support.center, ray.direction, t);
        let v = depth_below_rim(offset, support.radius);
        slope += gradient(ball, v, offset, support.radius);
        blend_add(ball, contribution(ball, v));
    }
    blend_write(pixel);
    let normal = outward_normal(slope, ray.direction);
    hit::write_hit(pixel, t, normal, select(hit::INSIDE, hit::HIT, t > 0.0));
}

// Section 7: with more balls over a point than the list holds, the support itself is drawn.
fn write_support(pixel: u32, ray: PrimaryRay, t: f32, ball: u32) {
    let support = support_of(ball);
    blend_start();
    blend_add(ball, 1.0);
    blend_write(pixel);
    let offset = offset_at(view.eye - support.center, ray.direction, t);
    let status = select(hit::INSIDE, hit::HIT, t > 0.0);
    hit::write_hit(pixel, t, normalize(offset), status + hit::FALLBACK);
}
