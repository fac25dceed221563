// The balls alone, each as the sphere in which it reaches the threshold by itself (Kanamori et al.
// 2008, figure 11 left). A rectangle a ball bounds it on the picture; a fragment intersects its ray.

#import core::cover::covering_corner
#import core::make_ray::direction_through
#import core::srgb::{decode, encode}
#import core::view::view
#import shade::light::{phong, from_within, background}

// Twin of `CoreSphere` in metaball-core.
struct CoreSphere {
    // World space, scene units.
    center: vec3<f32>,
    // Positive.
    radius: f32,
    // Colour in linear light.
    color: vec3<f32>,
    // A length of the scene's size, the same for all: where stored depth is one half.
    half_depth: f32,
}

@group(1) @binding(0) var<storage, read> spheres: array<CoreSphere>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) sphere: u32,
}

struct Shaded {
    @location(0) color: vec4<f32>,
    // 1 at the eye, 0 infinitely far: floats are densest where distances are largest.
    @builtin(frag_depth) depth: f32,
}

@vertex
fn bound_sphere(@builtin(vertex_index) vertex: u32, @builtin(instance_index) sphere: u32) -> Corner {
    let here = spheres[sphere];
    return Corner(covering_corner(here.center, here.radius, vertex), sphere);
}

@fragment
fn shade_sphere(corner: Corner) -> Shaded {
    let sphere = spheres[corner.sphere];
    let direction = direction_through(vec2<u32>(corner.position.xy));
    let offset = sphere.center - view.eye;
    let along = dot(offset, direction);
    // The ray's nearest point to the centre first: no difference of large squares.
    let across = offset - along * direction;
    let squared = sphere.radius * sphere.radius - dot(across, across);
    if squared < 0.0 {
        discard;
    }
    let half_chord = sqrt(squared);
    let t = along - half_chord;
    if along + half_chord < 0.0 {
        discard;
    }
    if t < 0.0 {
        return Shaded(vec4(encode(from_within(sphere.color)), 1.0), 1.0);
    }
    let normal = normalize(t * direction - offset);
    let light = phong(sphere.color, normal, -direction);
    return Shaded(vec4(encode(light), 1.0), sphere.half_depth / (sphere.half_depth + t));
}

@vertex
fn cover_picture(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return vec4(2.0 * vec2(f32(vertex & 1u), f32(vertex >> 1u)) - 1.0, 0.0, 1.0);
}

@fragment
fn shade_background(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4(encode(background(u32(position.y))), 1.0);
}
