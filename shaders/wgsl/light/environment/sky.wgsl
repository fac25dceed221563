// A generated environment: a clear sky over a studio floor, brightest at the horizon. The second axis
// points to the zenith.

fn environment(direction: vec3<f32>) -> vec3<f32> {
    let up = direction.y;
    let zenith = vec3(0.11, 0.23, 0.47);
    let horizon = vec3(0.66, 0.73, 0.80);
    let floor_near = vec3(0.090, 0.088, 0.085);
    let sky = mix(horizon, zenith, pow(clamp(up, 0.0, 1.0), 0.55));
    let ground = mix(0.65 * horizon, floor_near, pow(clamp(-up, 0.0, 1.0), 0.35));
    // The horizon is soft: no edge to be seen through a lens.
    return mix(ground, sky, smoothstep(-0.12, 0.12, up));
}

// Mean light from above a surface, as its normal weighs it: of the sky it is 0.22 horizon and 0.78 zenith,
// of the ground 0.15 and 0.85, as the powers above weigh them by the cosine.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    return mix(vec3(0.141, 0.146, 0.150), vec3(0.229, 0.338, 0.541), 0.5 + 0.5 * normal.y);
}
