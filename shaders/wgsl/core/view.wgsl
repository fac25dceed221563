// The view of a frame, and its primary rays.

// Twin of `ViewUniform` in metaball-core. The camera's axes are unit vectors in world space.
struct View {
    // Start of all primary rays, world space, scene units.
    eye: vec3<f32>,
    // Pixels across.
    width: u32,
    right: vec3<f32>,
    // Pixels down.
    height: u32,
    up: vec3<f32>,
    // Half a pixel's height at unit distance.
    half_pixel: f32,
    forward: vec3<f32>,
}

// The points `view.eye + t * direction`, 0 <= t <= t_max. The direction is unit to rounding and is
// never normalised again, so that t means the same to every method and to the reference. Twin of
// `PackedRay` in metaball-core.
struct PrimaryRay {
    direction: vec3<f32>,
    // Where something opaque ends the ray; NO_LIMIT where nothing does.
    t_max: f32,
}

// The greatest finite f32.
const NO_LIMIT: f32 = 0x1.fffffep+127f;

@group(0) @binding(0) var<uniform> view: View;
// One ray a pixel, row by row from the top left.
@group(0) @binding(1) var<storage, read> rays: array<PrimaryRay>;

// Whether an invocation of a dispatch over the picture has a pixel.
fn in_picture(position: vec2<u32>) -> bool {
    return position.x < view.width && position.y < view.height;
}

// Index of the pixel at a column and row, counted from the top left.
fn pixel_at(position: vec2<u32>) -> u32 {
    return position.y * view.width + position.x;
}

// The position of an invocation in a workgroup of 8 by 8: eight in turn are a block of 4 by 2 pixels, which
// diverge less than a row of eight.
fn in_blocks(index: u32) -> vec2<u32> {
    let block = index / 8u;
    return vec2(4u * (block % 2u) + index % 4u, 2u * (block / 2u) + index / 4u % 2u);
}
