// A generated surrounding: a clear sky over a studio floor, brightest at the horizon. The second axis
// points to the zenith.
#define_import_path metaball::effects::environment

fn environment(direction: vec3<f32>) -> vec3<f32> {
    let up = direction.y;
    let zenith = vec3(0.08, 0.17, 0.36);
    let horizon = vec3(0.50, 0.55, 0.60);
    let floor_near = vec3(0.045, 0.045, 0.05);
    let sky = mix(horizon, zenith, pow(clamp(up, 0.0, 1.0), 0.55));
    let ground = mix(0.7 * horizon, floor_near, pow(clamp(-up, 0.0, 1.0), 0.35));
    // The horizon is soft: no edge to be seen through a lens.
    return mix(ground, sky, smoothstep(-0.12, 0.12, up));
}

// Mean light from above a surface, as its normal weighs it; between the sky's and the floor's.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    return mix(vec3(0.10, 0.105, 0.11), vec3(0.24, 0.31, 0.42), 0.5 + 0.5 * normal.y);
}
