// The surface of a scene without colours.

#import shade::light::WHITE

fn base_color(pixel: u32) -> vec3<f32> {
    return WHITE;
}
