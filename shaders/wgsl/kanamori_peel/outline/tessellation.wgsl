// A polyhedron around it, what section 5.1 replaces: 128 triangles, of which the
// faces away from the eye are drawn. Every ray that meets the ball leaves the polyhedron through one
// of these, wherever the eye is.

#import core::hit::unfold
#import core::view::view
#import kanamori_peel::placed::{is_drawn, Placed}

// Squares on a side of the unfolded octahedron, and vertices of a ball, two triangles a square; the
// latter's twin is `Outline::vertices` in kanamori-peel.
const STEPS: u32 = 8u;
const VERTICES: u32 = 6u * STEPS * STEPS;

// With corners at unit distance the nearest faces are at 0.9428; a hundredth more keeps them clear of
// the ball.
const REACH: f32 = 1.01 / 0.9428;
// Parts of a pixel that the ball is widened by.
const PIXEL_MARGIN: f32 = 0.05;
// In ball radii: what is nearer to the eye's plane is cut off. Faces are a hundredth of a radius from
// the ball, so where the ray is within 89 degrees of the view's middle none that matters is cut.
const NEAR: f32 = 1e-4;

fn outline(vertex: u32, placed: Placed, to_center: vec3<f32>, radius: f32) -> vec4<f32> {
    if !is_drawn(placed) {
        return vec4(0.0, 0.0, 0.5, 1.0);
    }
    let pixel = 2.0 * view.half_pixel * length(to_center);
    let reach = REACH * (1.00001 * radius + PIXEL_MARGIN * pixel);
    let point = to_center + reach * unfold(unfolded_corner(vertex));
    let half = view.half_pixel * vec2(f32(view.width), f32(view.height));
    let ahead = dot(point, view.forward);
    let aside = vec2(dot(point, view.right), dot(point, view.up)) / half;
    return vec4(aside, ahead - NEAR * radius, ahead);
}

// A corner of a triangle on the square [-1, 1]^2. Squares are cut along the octahedron's edges, and
// turn the same way everywhere.
fn unfolded_corner(vertex: u32) -> vec2<f32> {
    let square = vec2(vertex / 6u % STEPS, vertex / 6u / STEPS);
    let is_right = square >= vec2(STEPS / 2u);
    // Bit k is the coordinate of corner k.
    let falling = vec2(0x32u, 0x2cu);
    let rising = vec2(0x13u, 0x32u);
    let bits = select(rising, falling, is_right.x == is_right.y) >> vec2(vertex % 6u);
    return 2.0 * vec2<f32>(square + (bits & vec2(1u))) / f32(STEPS) - 1.0;
}
