// The field along a ray as a polynomial in Bernstein form, of degree four or six.
//
// Along a ray v = 1 - r²/R² is a parabola, with three Bernstein coefficients on an interval; those of
// its square and cube follow by the product rule of Bernstein polynomials.

// The kernel: the sum of these weights times v, v² and v³.
@id(50) override once_weight: f32 = 0.0;
@id(51) override twice_weight: f32 = 1.0;
@id(52) override thrice_weight: f32 = 0.0;

// 4 or 6.
@id(53) override degree: u32 = 4u;

// Overrides cannot be imported; these can.
fn degree_along_ray() -> u32 {
    return degree;
}

fn is_quartic() -> bool {
    return degree == 4u;
}

// Coefficients in order: low.xyzw, high.xyz. At degree four the last two are not used.
struct Polynomial {
    low: vec4<f32>,
    high: vec3<f32>,
}

fn constant(value: f32) -> Polynomial {
    return Polynomial(vec4(value), vec3(value));
}

// Adds a ball's field on an interval that its chord covers. `depth` is v at the chord's midpoint,
// `ends` the interval's ends counted from there, in radii; `q` is the strength.
fn add_kernel(sum: ptr<function, Polynomial>, depth: f32, ends: vec2<f32>, q: f32) {
    // The Bernstein coefficients of the parabola v.
    let a = max(depth - ends.x * ends.x, 0.0);
    let b = depth - ends.x * ends.y;
    let c = max(depth - ends.y * ends.y, 0.0);
    // The parabola and its square, as degree four.
    let once = array(a, 0.5 * (a + b), (a + 4.0 * b + c) / 6.0, 0.5 * (b + c), c);
    let twice = array(a * a, a * b, (a * c + 2.0 * b * b) / 3.0, b * c, c * c);
    let low = vec4(
        once_weight * once[0] + twice_weight * twice[0],
        once_weight * once[1] + twice_weight * twice[1],
        once_weight * once[2] + twice_weight * twice[2],
        once_weight * once[3] + twice_weight * twice[3],
    );
    let last = once_weight * once[4] + twice_weight * twice[4];
    if is_quartic() {
        (*sum).low += q * low;
        (*sum).high += q * vec3(last, 0.0, 0.0);
        return;
    }
    // Raised to degree six, and the cube.
    let raised = array(
        low.x,
        (low.x + 2.0 * low.y) / 3.0,
        (low.x + 8.0 * low.y + 6.0 * low.z) / 15.0,
        (low.y + 3.0 * low.z + low.w) / 5.0,
        (6.0 * low.z + 8.0 * low.w + last) / 15.0,
        (2.0 * low.w + last) / 3.0,
        last,
    );
    let cubes = vec2(a * a * a, c * c * c);
    let second = vec2(a * a * b, b * c * c);
    let third = vec2(a * (a * c + 4.0 * b * b), c * (a * c + 4.0 * b * b)) / 5.0;
    let middle = b * (2.0 * b * b + 3.0 * a * c) / 5.0;
    let front = vec4(cubes.x, second.x, third.x, middle);
    let back = vec3(third.y, second.y, cubes.y);
    (*sum).low += q * (vec4(raised[0], raised[1], raised[2], raised[3]) + thrice_weight * front);
    (*sum).high += q * (vec3(raised[4], raised[5], raised[6]) + thrice_weight * back);
}
