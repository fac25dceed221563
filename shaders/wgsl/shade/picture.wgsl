// What all pictures share: where they are stored, and the scale of values.

#import core::srgb::encode

// Twin of `ValueRange` in metaball-core: what the ends of a scale stand for.
struct ValueRange {
    low: f32,
    high: f32,
}

// RGBA, eight bits a channel, sRGB-encoded, row by row from the top left.
@group(1) @binding(0) var<storage, read_write> pixels: array<u32>;
@group(1) @binding(1) var<uniform> range: ValueRange;

// A pixel in linear light.
fn put_light(pixel: u32, light: vec3<f32>) {
    put_encoded(pixel, encode(light));
}

// A pixel as it is stored.
fn put_encoded(pixel: u32, encoded: vec3<f32>) {
    pixels[pixel] = pack4x8unorm(vec4(encoded, 1.0));
}

// Where a value lies between the ends of the scale, 0 to 1.
fn on_scale(value: f32) -> f32 {
    return clamp((value - range.low) / max(range.high - range.low, 1e-30), 0.0, 1.0);
}
