// A scene whose balls all have one radius, which the shader is compiled for.

#import core::scene::Support

// Scene units. Of the ids that metaball-core sets.
@id(3) override compiled_radius: f32;

// Centre and radius of each ball. Twelve bytes a ball would be three loads.
@group(1) @binding(0) var<storage, read> supports: array<vec4<f32>>;

fn support_of(ball: u32) -> Support {
    return Support(supports[ball].xyz, compiled_radius);
}
