// First hits on the core sphere of ball 0, in closed form.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at}
#import core::hit::{write_hit, write_miss, HIT, INSIDE}
#import core::scene::scene
#import core::status::{report_needed, report_unfinished}
#import support::support_of
#import core::view::{in_picture, pixel_at, rays, view}
#import work::{count_balls, count_evaluations, write_work}

@id(16) override core_radius: f32;
// Rows of the picture that are drawn.
@id(17) override capacity: u32;
// Factor of the normal: a canary turns it over.
@id(18) override outward: f32 = 1.0;

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    if invocation.y >= capacity {
        report_unfinished();
        report_needed(1u, invocation.y + 1u);
        return;
    }
    if scene.balls == 0u {
        write_miss(pixel);
        return;
    }
    count_balls(1u);

    let ball = support_of(0u);
    let ray = rays[pixel];
    let eye_offset = view.eye - ball.center;
    if length(eye_offset) <= core_radius {
        write_hit(pixel, 0.0, normalize(eye_offset), INSIDE);
        return;
    }
    let along = -dot(eye_offset, ray.direction);
    let nearest = offset_at(eye_offset, ray.direction, along);
    let squared = core_radius * core_radius - dot(nearest, nearest);
    let t = along - sqrt(max(squared, 0.0));
    if squared < 0.0 || t < 0.0 || t > ray.t_max {
        write_miss(pixel);
        write_work(pixel);
        return;
    }
    count_evaluations(1u);
    let offset = offset_at(eye_offset, ray.direction, t);
    let v = depth_below_rim(offset, ball.radius);
    blend_start();
    blend_add(0u, contribution(0u, v));
    blend_write(pixel);
    write_hit(pixel, t, -outward * normalize(gradient(0u, v, offset, ball.radius)), HIT);
    write_work(pixel);
}
