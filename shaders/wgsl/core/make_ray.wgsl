// Directions of primary rays.

#import core::view::view

// The unit direction through the middle of the pixel at a column and row from the top left. Twice
// the distance from the picture's middle is a whole number of pixels, so nothing cancels.
fn direction_through(position: vec2<u32>) -> vec3<f32> {
    let across = 2 * i32(position.x) + 1 - i32(view.width);
    let upwards = i32(view.height) - 1 - 2 * i32(position.y);
    let x = f32(across) * view.half_pixel;
    let y = f32(upwards) * view.half_pixel;
    let toward = view.forward + x * view.right + y * view.up;
    return toward / sqrt(dot(toward, toward));
}
