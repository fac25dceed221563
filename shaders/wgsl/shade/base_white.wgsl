// The surface of a scene without colours.
#define_import_path metaball::base

#import metaball::light::WHITE

fn base_color(pixel: u32) -> vec3<f32> {
    return WHITE;
}
