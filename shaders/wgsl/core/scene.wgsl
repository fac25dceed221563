// What every scene has: balls with support spheres, and a threshold.

// Where a ball's field may be positive. Twin of `Support` in metaball-core.
struct Support {
    // World space, scene units.
    center: vec3<f32>,
    // Support radius R > 0, scene units.
    radius: f32,
}

// Twin of `SceneHeader` in metaball-core.
struct SceneHeader {
    // T: the field on the surface.
    threshold: f32,
    // Number of balls; arrays of them have one element even when this is 0.
    balls: u32,
}

@group(1) @binding(3) var<uniform> scene: SceneHeader;
