// Low-discrepancy numbers: Roberts' sequence R2, shifted for each pixel and purpose by a hash of both
// and of the seed (Cranley and Patterson 1976). The same seed gives the same picture.

#import light::path::settings

// Number `index` of a pixel's points in the unit square, for one purpose.
fn point_in_square(pixel: u32, purpose: u32, index: u32) -> vec2<f32> {
    let shift_x = hash(hash(pixel ^ hash(purpose)) ^ settings.seed);
    let shift_y = hash(shift_x);
    // The fractions 1/p and 1/p^2, p^3 = p + 1, of 2^32: the sum wraps as a fraction should.
    let x = shift_x + index * 3242174889u;
    let y = shift_y + index * 2447445414u;
    return vec2(f32(x >> 8u), f32(y >> 8u)) * 0x1p-24f;
}

// PCG's output function (Jarzynski and Olano 2020).
fn hash(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A point of the unit disc: the concentric map (Shirley and Chiu 1997).
fn on_disc(square: vec2<f32>) -> vec2<f32> {
    const QUARTER = 0.7853981634;
    let centered = 2.0 * square - 1.0;
    if abs(centered.x) > abs(centered.y) {
        let angle = QUARTER * centered.y / centered.x;
        return centered.x * vec2(cos(angle), sin(angle));
    }
    if centered.y == 0.0 {
        return vec2<f32>();
    }
    let angle = 2.0 * QUARTER - QUARTER * centered.x / centered.y;
    return centered.y * vec2(cos(angle), sin(angle));
}

// The unit vector at (x, y, z) in a frame whose third axis is `axis` (Duff et al. 2017).
fn around(axis: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let side = select(-1.0, 1.0, axis.z >= 0.0);
    let a = -1.0 / (side + axis.z);
    let b = axis.x * axis.y * a;
    let first = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    let second = vec3(b, side + axis.y * axis.y * a, -axis.y);
    return normalize(local.x * first + local.y * second + local.z * axis);
}
