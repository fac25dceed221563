// Where a ball's support lies on the picture.

#import core::cover::cover_sphere

// Twin of `Placed` in kanamori-peel.
struct Placed {
    // Corners of a rectangle in clip space, -1 to 1; equal where the ball is not to be drawn.
    low: vec2<f32>,
    high: vec2<f32>,
    // 1 where the support holds the eye.
    around: u32,
}

fn place_sphere(to_center: vec3<f32>, radius: f32) -> Placed {
    let cover = cover_sphere(to_center, radius);
    let around = select(0u, 1u, dot(to_center, to_center) < radius * radius);
    return Placed(cover.low, cover.high, around);
}

fn is_drawn(placed: Placed) -> bool {
    return placed.low.x < placed.high.x;
}
