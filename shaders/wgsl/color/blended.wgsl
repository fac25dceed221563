// A scene with colours. They are blended in linear light.

#import core::color_record::color_of_pixel
#import core::srgb::{decode, encode}

// sRGB-encoded, as `Color` of metaball-core.
@group(1) @binding(2) var<storage, read> ball_colors: array<u32>;

var<private> blended: vec3<f32>;
var<private> blended_weight: f32;

fn blend_start() {
    blended = vec3<f32>();
    blended_weight = 0.0;
}

fn blend_add(ball: u32, weight: f32) {
    blended += weight * decode(unpack4x8unorm(ball_colors[ball]).rgb);
    blended_weight += weight;
}

// Black where nothing was added.
fn blend_write(pixel: u32) {
    let linear = blended / max(blended_weight, 1e-30);
    color_of_pixel[pixel] = pack4x8unorm(vec4(encode(linear), 1.0));
}
