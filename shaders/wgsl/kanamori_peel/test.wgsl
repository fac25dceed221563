// Passes over the picture: the isosurface test of a layer's interval with the update of the lists
// (sections 4.2 and 4.3), and what becomes of rays that no layer answered.

#import core::hit
#import core::status::report_unfinished
#import core::view::{in_picture, pixel_at, rays, PrimaryRay, NO_LIMIT}
#import kanamori_peel::arranged::{arranged, tiles}
#import kanamori_peel::frame::from_depth
#import kanamori_peel::list
#import kanamori_peel::tiles::{corner_of_tile, tile_of}
#import work::{count_layers, write_work}

// Whether kernel spheres were drawn, see kanamori_peel::arrange.
@id(32) override culling: bool = true;
// K: the longest list. With the two numbers before it, it fills the targets at most.
@id(35) override capacity: u32 = 14u;

// Set for each tile that has a ray without an answer after this layer.
@group(2) @binding(7) var<storage, read_write> rays_left: array<u32>;

// The lists before this layer; t and ball of the points that this layer found, or else the last one; and
// the nearest kernel spheres.
@group(3) @binding(0) var lists: texture_2d_array<f32>;
@group(3) @binding(1) var points: texture_2d<f32>;
@group(3) @binding(2) var kernel_depth: texture_depth_2d;

// A list as the targets keep it, in order: t of the last point, the number of balls, the balls. What a
// pipeline has no target for goes nowhere.
struct Lists {
    @location(0) first: vec4<f32>,
    @location(1) second: vec4<f32>,
    @location(2) third: vec4<f32>,
    @location(3) fourth: vec4<f32>,
    @location(4) fifth: vec4<f32>,
    @location(5) sixth: vec4<f32>,
    @location(6) seventh: vec4<f32>,
    @location(7) eighth: vec4<f32>,
}

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) tile: u32,
}

// The far end is what the next layer's points are nearer than.
@vertex
fn cover_tile(@builtin(vertex_index) vertex: u32, @builtin(instance_index) tile: u32) -> Corner {
    if tiles[tile].is_live == 0u {
        return Corner(vec4(0.0, 0.0, 0.5, 1.0), tile);
    }
    return Corner(corner_of_tile(tile, vertex), tile);
}

@fragment
fn test_layer(corner: Corner) -> Lists {
    let position = vec2<u32>(corner.position.xy);
    let pixel = pixel_at(position);
    if hit::is_answered(pixel) {
        return nothing();
    }
    let ray = rays[pixel];
    if arranged.around > capacity {
        list::write_support(pixel, ray, 0.0, arranged.around_balls[0]);
        return nothing();
    }
    var last = 0.0;
    if tiles[corner.tile].layers == 1u {
        begin();
    } else {
        last = restore(position);
    }
    count_layers(1u);
    let point = textureLoad(points, position, 0).xy;
    let next = test_interval(position, pixel, ray, last, point);
    write_work(pixel);
    if next == NO_LIMIT {
        return nothing();
    }
    rays_left[corner.tile] = 1u;
    return stored(next);
}

// Searches the interval from the last point to the layer's. Returns the latter, or NO_LIMIT when the
// ray has its answer.
fn test_interval(
    position: vec2<u32>,
    pixel: u32,
    ray: PrimaryRay,
    last: f32,
    point: vec2<f32>,
) -> f32 {
    let kernel = from_depth(textureLoad(kernel_depth, position, 0));
    // A point that this layer did not find is that of the layer before.
    let next = select(NO_LIMIT, point.x, point.x > last);
    let end = max(min(min(next, kernel), ray.t_max), last);
    // In the single case the kernel spheres that were drawn are the surface (section 5.2).
    var t = list::NOTHING_FOUND;
    if !(culling && list::listed_count == 1u) {
        t = list::search(ray, last, end);
    }
    if t == list::SEARCH_LOST {
        hit::write_hit(pixel, last, -ray.direction, hit::UNDECIDED);
        return NO_LIMIT;
    }
    // A kernel sphere that no point lies in front of is a hit by itself.
    if t == list::NOTHING_FOUND && kernel < NO_LIMIT && kernel <= min(next, ray.t_max) {
        t = kernel;
    }
    if t != list::NOTHING_FOUND {
        list::write_surface(pixel, ray, t);
        return NO_LIMIT;
    }
    if next >= ray.t_max {
        hit::write_miss(pixel);
        return NO_LIMIT;
    }
    let ball = u32(point.y);
    if !list::toggle(ball, capacity) {
        list::write_support(pixel, ray, next, ball);
        return NO_LIMIT;
    }
    return next;
}

// Rays that no layer answered: those of tiles without balls miss, and others are left.
@compute @workgroup_size(8, 8)
fn account(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    if tiles[tile_of(id.xy)].balls == 0u {
        hit::write_miss(pixel);
    } else if !hit::is_answered(pixel) {
        report_unfinished();
    }
}

// The paper's eye is outside all supports. Here a ray begins with the balls around the eye.
fn begin() {
    list::listed_count = arranged.around;
    for (var k = 0u; k < list::listed_count; k++) {
        list::listed[k] = arranged.around_balls[k];
    }
}

// Restores a ray's list; returns the t of its last point.
fn restore(position: vec2<u32>) -> f32 {
    let head = textureLoad(lists, position, 0, 0);
    list::listed_count = u32(head.y);
    list::listed[0] = u32(head.z);
    list::listed[1] = u32(head.w);
    for (var k = 2u; k < list::listed_count; k += 4u) {
        let four = textureLoad(lists, position, (k + 2u) / 4u, 0);
        for (var i = 0u; i < 4u; i++) {
            list::listed[k + i] = u32(four[i]);
        }
    }
    return head.x;
}

// What the targets have stays.
fn nothing() -> Lists {
    discard;
    return Lists();
}

// The list as it is now, after a point with this t.
fn stored(last: f32) -> Lists {
    return Lists(
        vec4(last, f32(list::listed_count), ball_at(0u), ball_at(1u)),
        four_from(2u), four_from(6u), four_from(10u), four_from(14u),
        four_from(18u), four_from(22u), four_from(26u),
    );
}

fn four_from(k: u32) -> vec4<f32> {
    return vec4(ball_at(k), ball_at(k + 1u), ball_at(k + 2u), ball_at(k + 3u));
}

fn ball_at(k: u32) -> f32 {
    if k >= list::listed_count {
        return 0.0;
    }
    return f32(list::listed[k]);
}
