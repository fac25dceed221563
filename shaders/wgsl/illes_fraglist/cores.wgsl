// The nearest core along each ray: the sphere in which a ball alone reaches the threshold (section 5,
// "lay down depth"). Drawn nearest first, so that later ones are hidden.

#import core::cover::covering_corner
#import core::view::{pixel_at, rays, NO_LIMIT}
#import illes_fraglist::balls::{ball_of_rank, core_entry, core_radii}
#import support::support_of

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) ball: u32,
}

struct Nearest {
    // Distance along the ray, scene units; 0 with the eye in the core.
    @location(0) t: f32,
    // 1 at the eye, 0 infinitely far. For the depth test alone: t is not read back from it.
    @builtin(frag_depth) depth: f32,
}

@vertex
fn bound_core(@builtin(vertex_index) vertex: u32, @builtin(instance_index) rank: u32) -> Corner {
    let ball = ball_of_rank[rank];
    let radius = core_radii[ball];
    if radius == 0.0 {
        return Corner(vec4(0.0, 0.0, 0.5, 1.0), ball);
    }
    return Corner(covering_corner(support_of(ball).center, radius, vertex), ball);
}

@fragment
fn draw_core(corner: Corner) -> Nearest {
    let direction = rays[pixel_at(vec2<u32>(corner.position.xy))].direction;
    let t = core_entry(corner.ball, direction);
    if t == NO_LIMIT {
        discard;
    }
    // Any length of the scene's size that is the same for all.
    let unit = support_of(0u).radius;
    return Nearest(t, unit / (unit + t));
}
