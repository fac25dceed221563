// The rectangle around it (section 5.1, appendix B): a strip of two triangles.

#import core::cover::{corner_of_cover, Cover}
#import kanamori_peel::placed::Placed

// Twin of `Outline::vertices` in kanamori-peel.
const VERTICES: u32 = 4u;

fn outline(vertex: u32, placed: Placed, to_center: vec3<f32>, radius: f32) -> vec4<f32> {
    return corner_of_cover(Cover(placed.low, placed.high), vertex);
}
