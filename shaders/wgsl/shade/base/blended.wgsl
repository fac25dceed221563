// The surface of a scene with colours: what the method blended.

#import core::color_record::color_of_pixel
#import core::srgb::decode

fn base_color(pixel: u32) -> vec3<f32> {
    return decode(unpack4x8unorm(color_of_pixel[pixel]).rgb);
}
