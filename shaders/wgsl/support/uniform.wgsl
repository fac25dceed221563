// A scene whose balls all have one radius: twelve bytes a ball.
#define_import_path metaball::support

#import metaball::scene::Support

// An array of three is aligned to four bytes, a vec3 to sixteen.
@group(1) @binding(0) var<storage, read> centers: array<array<f32, 3>>;
// Scene units.
@group(1) @binding(4) var<uniform> common_radius: f32;

fn support_of(ball: u32) -> Support {
    let center = centers[ball];
    return Support(vec3(center[0], center[1], center[2]), common_radius);
}
