// Puts each ball into the lists of all pixels whose rays meet its support before the core (section 5,
// gathering). Drawn farthest first, so that lists are nearest first where the device keeps the draw
// order; illes_fraglist::order does the rest.

#import core::cover::covering_corner
#import core::scene::scene
#import core::view::{pixel_at, rays}
#import illes_fraglist::balls::{is_gathered, segment_of, support_of_rank}
#import illes_fraglist::lists

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) rank: u32,
}

@vertex
fn bound_support(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    let rank = scene.balls - 1u - instance;
    let support = support_of_rank(rank);
    return Corner(covering_corner(support.center, support.radius, vertex), rank);
}

@fragment
fn gather(corner: Corner) {
    let position = vec2<u32>(corner.position.xy);
    let pixel = pixel_at(position);
    let ray = rays[pixel];
    let support = support_of_rank(corner.rank);
    let limit = min(lists::core_distance_at(position), ray.t_max);
    if is_gathered(segment_of(support.center, support.radius, ray.direction), limit) {
        lists::prepend(pixel, corner.rank);
    }
}
