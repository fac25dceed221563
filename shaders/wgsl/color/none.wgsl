// A scene without colours: blending is nothing.

fn blend_start() {}

fn blend_add(ball: u32, weight: f32) {}

fn blend_write(pixel: u32) {}
