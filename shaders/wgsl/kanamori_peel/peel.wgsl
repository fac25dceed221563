// One layer of depth peeling (section 4.1): of all supports, the nearest point beyond the last one
// at which the ray enters or leaves.

#import core::hit::is_answered
#import core::view::{pixel_at, rays, view}
#import kanamori_peel::arranged::{placed, registered, tiles}
#import kanamori_peel::chord::chord_of
#import kanamori_peel::frame::to_depth
#import kanamori_peel::outline::{outline, VERTICES}
#import support::support_of

// Nothing lies nearer to an eye outside a support than this.
const NEAREST: f32 = 1e-30;

// The active balls; t of the last point is the first number of the first layer.
@group(3) @binding(0) var lists: texture_2d_array<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) to_center: vec3<f32>,
    @location(1) @interpolate(flat) radius: f32,
    @location(2) @interpolate(flat) ball: u32,
    @location(3) @interpolate(flat) around: u32,
    // Of the layer, from 1.
    @location(4) @interpolate(flat) layer: u32,
}

struct Point {
    // t and the ball's index.
    @location(0) point: vec2<f32>,
    @builtin(frag_depth) depth: f32,
}

// The tile's number is in the first vertex, see kanamori_peel::turn.
@vertex
fn bound_ball(@builtin(vertex_index) vertex: u32, @builtin(instance_index) index: u32) -> Corner {
    let tile = tiles[vertex / VERTICES];
    let ball = registered[tile.first + index];
    let support = support_of(ball);
    let to_center = support.center - view.eye;
    let here = placed[ball];
    let position = outline(vertex % VERTICES, here, to_center, support.radius);
    return Corner(position, to_center, support.radius, ball, here.around, tile.layers);
}

// Section 5.1: only the nearer of the two faces beyond the last point. A ball that the ray only
// touches has no chord and is left out. Of points with one t the depth test keeps the one drawn first,
// that of the lowest index, and the others are missed (section 7, figure 9a).
@fragment
fn next_point(corner: Corner) -> Point {
    let position = vec2<u32>(corner.position.xy);
    let pixel = pixel_at(position);
    if is_answered(pixel) {
        return no_point();
    }
    var last = 0.0;
    if corner.layer > 1u {
        last = textureLoad(lists, position, 0, 0).x;
    }
    let ray = rays[pixel];
    let chord = chord_of(corner.to_center, corner.radius, ray.direction);
    let half = sqrt(max(chord.half_squared, 0.0));
    // Which side of a support the eye is on is decided once for all rays; rounding must not undo it.
    let is_around = corner.around != 0u;
    let enter = max(chord.middle - half, NEAREST);
    let leave = select(chord.middle + half, max(chord.middle + half, NEAREST), is_around);
    let t = select(leave, enter, !is_around && enter > last);
    let has_chord = is_around || chord.half_squared > 0.0 && enter < leave;
    if !has_chord || t <= last {
        return no_point();
    }
    return Point(vec2(t, f32(corner.ball)), to_depth(t));
}

fn no_point() -> Point {
    discard;
    return Point();
}
