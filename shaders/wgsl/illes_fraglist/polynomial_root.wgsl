// The first root on [0, 1] of a polynomial of degree four or six in Bernstein form.

#import illes_fraglist::budget
#import illes_fraglist::cubic_root::NO_ROOT
#import illes_fraglist::polynomial::{degree_along_ray, is_quartic, Polynomial}
#import work::count_iterations

// Narrowest cell in which the number of roots still matters: 2^-12 of the interval. What two roots
// enclose in one is above the threshold by less than the square of it.
const NARROWEST: f32 = 0x1p-12f;

// Where the polynomial first is zero or more; NO_ROOT where it is negative throughout. Visits dyadic
// cells from the left: one whose coefficients are all negative is passed, one with a single change of
// sign holds a single root, any other is halved.
fn first_root_of_polynomial(polynomial: Polynomial) -> f32 {
    if is_negative(polynomial) {
        return NO_ROOT;
    }
    var low = 0.0;
    var width = 1.0;
    while low < 1.0 {
        budget::spend(1u);
        count_iterations(1u);
        let cell = part_of(polynomial, low, low + width);
        if cell.low.x >= 0.0 {
            return low;
        }
        if is_negative(cell) {
            low += width;
            // The next cell is as large as the grid allows.
            while width < 1.0 && fract(low / (2.0 * width)) == 0.0 {
                width *= 2.0;
                budget::spend(1u);
            }
        } else if has_one_root(cell) || (width <= NARROWEST && last(cell) >= 0.0) {
            return low + width * climb(cell);
        } else if width <= NARROWEST {
            low += width;
        } else {
            width *= 0.5;
        }
    }
    return NO_ROOT;
}

fn last(cell: Polynomial) -> f32 {
    return select(cell.high.z, cell.high.x, is_quartic());
}

fn is_negative(cell: Polynomial) -> bool {
    let rest = select(max(max(cell.high.x, cell.high.y), cell.high.z), cell.high.x, is_quartic());
    return max(max(cell.low.x, cell.low.y), max(cell.low.z, cell.low.w)) < 0.0 && rest < 0.0;
}

// Whether the coefficients, of which the first is negative, change sign once: Descartes' rule.
fn has_one_root(cell: Polynomial) -> bool {
    let low = cell.low >= vec4(0.0);
    let high = cell.high >= vec3(0.0);
    let falls = (low.y && !low.z) || (low.z && !low.w) || (low.w && !high.x);
    if is_quartic() {
        return !falls && high.x;
    }
    return !falls && !(high.x && !high.y) && !(high.y && !high.z) && high.z;
}

// The one root of a cell that rises from below zero to zero or more, by Newton's steps inside a
// shrinking bracket. The upper end is returned: there the polynomial is not negative.
fn climb(cell: Polynomial) -> f32 {
    var low = 0.0;
    var high = 1.0;
    var u = 0.5;
    for (var step = 0u; step < 40u; step++) {
        budget::spend(1u);
        count_iterations(1u);
        let line = last_line(cell, u);
        let now = mix(line.x, line.y, u);
        if now >= 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - now / max(f32(degree_along_ray()) * (line.y - line.x), 1e-30);
        // Aim a little beyond the root, so that the bracket closes from above, too.
        let aim = newton + select(-1.0, 1.0, now < 0.0) * 1e-7;
        u = select(0.5 * (low + high), aim, aim > low && aim < high);
        if high - low <= 4e-7 {
            break;
        }
    }
    return high;
}

// The last line of de Casteljau's scheme: value and slope at u.
fn last_line(p: Polynomial, u: f32) -> vec2<f32> {
    var first = p.low;
    if !is_quartic() {
        let five = mix(p.low, vec4(p.low.yzw, p.high.x), u);
        let five_high = mix(p.high.xy, p.high.yz, u);
        let four_high = mix(five_high.x, five_high.y, u);
        first = mix(five, vec4(five.yzw, five_high.x), u);
        return line_of_four(first, four_high, u);
    }
    return line_of_four(first, p.high.x, u);
}

fn line_of_four(first: vec4<f32>, last: f32, u: f32) -> vec2<f32> {
    let cubic = mix(first, vec4(first.yzw, last), u);
    let quadratic = mix(cubic.xyz, cubic.yzw, u);
    return mix(quadratic.xy, quadratic.yz, u);
}

// The polynomial on [start, end] as one on [0, 1].
fn part_of(polynomial: Polynomial, start: f32, end: f32) -> Polynomial {
    var b = array(
        polynomial.low.x, polynomial.low.y, polynomial.low.z, polynomial.low.w,
        polynomial.high.x, polynomial.high.y, polynomial.high.z,
    );
    let degree = degree_along_ray();
    // De Casteljau's scheme keeps the left part on one edge and the right part on the other.
    for (var level = 1u; level <= degree; level++) {
        for (var index = degree; index >= level; index--) {
            b[index] = mix(b[index - 1u], b[index], end);
        }
    }
    let split = start / end;
    for (var level = 1u; level <= degree; level++) {
        for (var index = 0u; index <= degree - level; index++) {
            b[index] = mix(b[index], b[index + 1u], split);
        }
    }
    budget::spend(2u * degree * degree);
    return Polynomial(vec4(b[0], b[1], b[2], b[3]), vec3(b[4], b[5], b[6]));
}
