// As printed: the ray continues past separators that are not safe.

#import illes_fraglist::cubic_root::NO_ROOT

fn can_search() -> bool {
    return false;
}

fn search_without_array(
    head: u32,
    direction: vec3<f32>,
    limit: f32,
    position: ptr<function, f32>,
    width: ptr<function, f32>,
) -> f32 {
    return NO_ROOT;
}
