// A scene whose balls have radii of their own.
#define_import_path metaball::support

#import metaball::scene::Support

@group(1) @binding(0) var<storage, read> supports: array<Support>;

fn support_of(ball: u32) -> Support {
    return supports[ball];
}
