// The transfer functions of sRGB (IEC 61966-2-1).

// Linear light from encoded channels in [0, 1].
fn decode(encoded: vec3<f32>) -> vec3<f32> {
    let low = encoded / 12.92;
    let high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return select(high, low, encoded <= vec3(0.04045));
}

// Encoded channels from linear light, clamped to [0, 1].
fn encode(linear: vec3<f32>) -> vec3<f32> {
    let light = clamp(linear, vec3(0.0), vec3(1.0));
    let low = light * 12.92;
    let high = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    return select(high, low, light <= vec3(0.0031308));
}
