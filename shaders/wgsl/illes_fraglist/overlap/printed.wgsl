// More separators than the array has room for: the ray goes on as printed, past separators that are
// not safe.

#import illes_fraglist::cubic_root::NO_ROOT

// Whether a ray can be searched without the array.
fn can_search() -> bool {
    return false;
}

fn search_crowd(
    head: u32,
    direction: vec3<f32>,
    limit: f32,
    position: ptr<function, f32>,
    width: ptr<function, f32>,
) -> f32 {
    return NO_ROOT;
}
