// Lights and materials, in linear light. The lights move with the camera.

#import core::view::view

// The material of scenes without colours.
const WHITE: vec3<f32> = vec3(0.80, 0.78, 0.74);
// What no method should leave: a pixel that is undecided.
const ALARM: vec3<f32> = vec3(1.0, 0.0, 0.6);

// Phong's model with a warm key light over the left shoulder, a cool fill light from the right, and
// ambient light that is brighter from above. `normal` is unit and outward, `toward_eye` unit.
fn phong(base: vec3<f32>, normal: vec3<f32>, toward_eye: vec3<f32>) -> vec3<f32> {
    let key = normalize(0.8 * view.up - 0.6 * view.right - 0.9 * view.forward);
    let fill = normalize(0.9 * view.right - 0.1 * view.up - 0.5 * view.forward);
    let key_light = 0.85 * vec3(1.0, 0.97, 0.92) * max(dot(normal, key), 0.0);
    let fill_light = 0.18 * vec3(0.75, 0.85, 1.0) * max(dot(normal, fill), 0.0);
    let ambient = mix(vec3(0.035, 0.033, 0.03), vec3(0.11, 0.12, 0.14), 0.5 + 0.5 * dot(normal, view.up));
    let mirrored = max(dot(reflect(-key, normal), toward_eye), 0.0);
    return base * (key_light + fill_light + ambient) + 0.22 * pow(mirrored, 48.0);
}

// Seen from within the solid: no surface to light.
fn from_within(base: vec3<f32>) -> vec3<f32> {
    return 0.25 * base;
}

// Behind everything: a gradient down the picture.
fn background(row: u32) -> vec3<f32> {
    let down = (f32(row) + 0.5) / f32(view.height);
    return mix(vec3(0.035, 0.045, 0.065), vec3(0.17, 0.19, 0.22), down);
}
