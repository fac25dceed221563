// The environment as an equirectangular image: columns go around the second axis, from -z over +x;
// rows from the zenith to the nadir.

#import light::path::settings

// Linear light, row by row; the fourth number is 0.
@group(2) @binding(4) var<storage, read> panorama: array<vec4<f32>>;

const TURN: f32 = 6.2831853072;

fn environment(direction: vec3<f32>) -> vec3<f32> {
    let around = atan2(direction.x, -direction.z) / TURN + 0.5;
    let down = acos(clamp(direction.y, -1.0, 1.0)) / (0.5 * TURN);
    let x = around * f32(settings.columns) - 0.5;
    let y = clamp(down * f32(settings.rows) - 0.5, 0.0, f32(settings.rows) - 1.0);
    let upper = mix(texel(x, y, 0.0, 0.0), texel(x, y, 1.0, 0.0), fract(x));
    let lower = mix(texel(x, y, 0.0, 1.0), texel(x, y, 1.0, 1.0), fract(x));
    return mix(upper, lower, fract(y));
}

fn texel(x: f32, y: f32, right: f32, down: f32) -> vec3<f32> {
    let columns = i32(settings.columns);
    let column = u32((i32(floor(x) + right) + columns) % columns);
    let row = min(u32(floor(y) + down), settings.rows - 1u);
    return panorama[row * settings.columns + column].rgb;
}

// Mean light from above a surface, as its normal weighs it: six directions stand for all.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>();
    var weights = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        for (var side = -1.0; side <= 1.0; side += 2.0) {
            var direction = vec3<f32>();
            direction[axis] = side;
            let weight = 0.2 + max(dot(direction, normal), 0.0);
            sum += weight * environment(direction);
            weights += weight;
        }
    }
    return sum / weights;
}
