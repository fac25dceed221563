// A scene whose balls all have strength 1.
#define_import_path metaball::strength

fn strength(ball: u32) -> f32 {
    return 1.0;
}
