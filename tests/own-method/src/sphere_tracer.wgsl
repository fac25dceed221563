// Sphere tracing (Hart 1996): where the field is below T by more than its slope can make up for within a
// step, the step is safe. The slope's bound is local: only balls that reach the step add to it.
//
// A ball adds q k(1 - r^2/R^2), whose slope along any direction is at most 2 q k'/R at its steepest.

#import color::{blend_add, blend_start, blend_write}
#import core::field::{contribution, depth_below_rim, gradient, offset_at, outward_normal}
#import core::hit::{write_hit, write_miss, HIT, INSIDE, UNDECIDED}
#import core::scene::scene
#import core::view::{in_picture, pixel_at, rays, view}
#import kernel::steepest_slope
#import strength::strength
#import support::support_of
#import work::{count_balls, count_evaluations, count_iterations, write_work}

// No step is longer, scene units, except where no ball reaches it.
@id(16) override reach: f32;
// A hit is where the field is below T by this part of T.
@id(17) override tolerance: f32;
// Balls that a ray evaluates before it gives up and says so: software Vulkan ends loops silently.
@id(18) override budget: u32;

// What is known of the field at a point.
struct Field {
    value: f32,
    // Nowhere steeper within reach, 1/scene unit.
    slope: f32,
    // To the nearest support that does not reach here, scene units.
    gap: f32,
}

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    let ray = rays[pixel];
    var t = 0.0;
    var spent = 0u;
    loop {
        let field = field_at(ray.direction, t);
        let below = scene.threshold - field.value;
        spent += scene.balls;
        if below <= tolerance * scene.threshold {
            surface(pixel, ray.direction, t, select(HIT, INSIDE, t == 0.0 && below <= 0.0));
            break;
        }
        if spent >= budget {
            surface(pixel, ray.direction, t, UNDECIDED);
            break;
        }
        let step = select(min(below / field.slope, reach), field.gap, field.slope == 0.0);
        // The next float at least.
        t = max(t + step, t * (1.0 + 0x1p-22f));
        if t > ray.t_max {
            write_miss(pixel);
            break;
        }
    }
    write_work(pixel);
}

fn field_at(direction: vec3<f32>, t: f32) -> Field {
    var field = Field(0.0, 0.0, 0x1.fffffep+126f);
    for (var ball = 0u; ball < scene.balls; ball++) {
        let support = support_of(ball);
        let offset = offset_at(view.eye - support.center, direction, t);
        let gap = length(offset) - support.radius;
        if gap < reach {
            field.value += contribution(ball, depth_below_rim(offset, support.radius));
            field.slope += 2.0 * strength(ball) * steepest_slope(0.0, 1.0) / support.radius;
        } else {
            field.gap = min(field.gap, gap);
        }
    }
    count_iterations(scene.balls);
    count_balls(scene.balls);
    count_evaluations(1u);
    return field;
}

fn surface(pixel: u32, direction: vec3<f32>, t: f32, status: u32) {
    var rise = vec3<f32>();
    blend_start();
    for (var ball = 0u; ball < scene.balls; ball++) {
        let support = support_of(ball);
        let offset = offset_at(view.eye - support.center, direction, t);
        let v = depth_below_rim(offset, support.radius);
        if v > 0.0 {
            rise += gradient(ball, v, offset, support.radius);
            blend_add(ball, contribution(ball, v));
        }
    }
    blend_write(pixel);
    write_hit(pixel, t, outward_normal(rise, direction), status);
}
