// Culling by kernel spheres (section 5.2): first their nearest distances as depth, then a flag for
// every ball whose support some ray enters before that.

#import core::view::{pixel_at, rays, view}
#import kanamori_peel::arranged::{kernel_radii, placed}
#import kanamori_peel::chord::chord_of
#import kanamori_peel::frame::{from_depth, to_depth}
#import kanamori_peel::outline::outline
#import support::support_of

@group(2) @binding(4) var<storage, read_write> seen: array<u32>;
@group(3) @binding(0) var kernel_depth: texture_depth_2d;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) ball: u32,
}

@vertex
fn bound_ball(@builtin(vertex_index) vertex: u32, @builtin(instance_index) ball: u32) -> Corner {
    return corner_of(ball, vertex);
}

// The outline of a support holds that of the kernel sphere.
@vertex
fn bound_kernel(@builtin(vertex_index) vertex: u32, @builtin(instance_index) ball: u32) -> Corner {
    if kernel_radii[ball] <= 0.0 {
        return Corner(vec4(0.0, 0.0, 0.5, 1.0), ball);
    }
    return corner_of(ball, vertex);
}

fn corner_of(ball: u32, vertex: u32) -> Corner {
    let support = support_of(ball);
    let to_center = support.center - view.eye;
    return Corner(outline(vertex, placed[ball], to_center, support.radius), ball);
}

@fragment
fn kernel_sphere(corner: Corner) -> @builtin(frag_depth) f32 {
    let ray = rays[pixel_at(vec2<u32>(corner.position.xy))];
    let to_center = support_of(corner.ball).center - view.eye;
    let chord = chord_of(to_center, kernel_radii[corner.ball], ray.direction);
    let half = sqrt(max(chord.half_squared, 0.0));
    if chord.half_squared <= 0.0 || chord.middle + half <= 0.0 {
        discard;
    }
    return to_depth(max(chord.middle - half, 0.0));
}

@fragment
fn mark_seen(corner: Corner) {
    if seen[corner.ball] == 1u {
        return;
    }
    let position = vec2<u32>(corner.position.xy);
    let ray = rays[pixel_at(position)];
    let support = support_of(corner.ball);
    let chord = chord_of(support.center - view.eye, support.radius, ray.direction);
    let half = sqrt(max(chord.half_squared, 0.0));
    let stop = min(from_depth(textureLoad(kernel_depth, position, 0)), ray.t_max);
    if chord.half_squared > 0.0 && chord.middle + half > 0.0 && chord.middle - half <= stop {
        seen[corner.ball] = 1u;
    }
}
