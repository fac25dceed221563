// The first root of a cubic on [0, 1].

#import illes_fraglist::budget
#import work::count_iterations

const NO_ROOT: f32 = -1.0;

// Where the cubic with these Bernstein coefficients first is zero or more; NO_ROOT where it is
// negative throughout. Section 6: the monotone case, nearly the only one, is seen from the
// coefficients; otherwise the extremes cut the interval into monotone parts.
fn first_root_of_cubic(b: vec4<f32>) -> f32 {
    if b.x >= 0.0 {
        return 0.0;
    }
    if max(max(b.y, b.z), b.w) < 0.0 {
        return NO_ROOT;
    }
    if b.x <= b.y && b.y <= b.z && b.z <= b.w {
        return climb(b, 0.0, 1.0);
    }
    let ends = vec3(extremes(b), 1.0);
    var low = 0.0;
    for (var part = 0u; part < 3u; part++) {
        let high = ends[part];
        if value(b, high) >= 0.0 {
            return climb(b, low, high);
        }
        low = high;
    }
    return NO_ROOT;
}

// The roots of the derivative in rising order, clamped to [0, 1]; both 1 where there are none.
fn extremes(b: vec4<f32>) -> vec2<f32> {
    let slopes = b.yzw - b.xyz;
    // The derivative's third as a u² + 2 h u + c.
    let a = slopes.x - 2.0 * slopes.y + slopes.z;
    let h = slopes.y - slopes.x;
    let c = slopes.x;
    let discriminant = h * h - a * c;
    if discriminant <= 0.0 {
        return vec2(1.0);
    }
    let q = -(h + select(-1.0, 1.0, h >= 0.0) * sqrt(discriminant));
    // No root of the quadratic lies in (0, 1) where its divisor is the smaller in size.
    let first = select(1.0, c / q, abs(c) < abs(q));
    let second = select(1.0, q / a, abs(q) < abs(a));
    let inside = clamp(vec2(first, second), vec2(0.0), vec2(1.0));
    return vec2(min(inside.x, inside.y), max(inside.x, inside.y));
}

// The root in a part where the cubic rises from below zero to zero or more, by Newton's steps
// inside a shrinking bracket. The upper end is returned: there the cubic is not negative.
fn climb(b: vec4<f32>, start: f32, end: f32) -> f32 {
    var low = start;
    var high = end;
    var u = 0.5 * (low + high);
    for (var step = 0u; step < 40u; step++) {
        budget::spend(1u);
        count_iterations(1u);
        let now = value(b, u);
        if now >= 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - now / max(slope(b, u), 1e-30);
        // Aim a little beyond the root, so that the bracket closes from above, too.
        let aim = newton + select(-1.0, 1.0, now < 0.0) * 1e-7;
        u = select(0.5 * (low + high), aim, aim > low && aim < high);
        if high - low <= 4e-7 {
            break;
        }
    }
    return high;
}

fn value(b: vec4<f32>, u: f32) -> f32 {
    let first = mix(b.xyz, b.yzw, u);
    let second = mix(first.xy, first.yz, u);
    return mix(second.x, second.y, u);
}

fn slope(b: vec4<f32>, u: f32) -> f32 {
    let first = mix(b.xyz, b.yzw, u);
    let second = mix(first.xy, first.yz, u);
    return 3.0 * (second.y - second.x);
}
