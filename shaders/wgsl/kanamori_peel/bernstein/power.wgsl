// The power kernel v^n: v = 4a s(1-s), so v^n has one coefficient, that of the middle,
// (4a)^n / (2n over n). The quartic has a module of its own.

#import exponent::exponent

// Enough for the greatest exponent, 8.
struct Curve {
    d: array<f32, 17>,
}

fn degree() -> u32 {
    return 2u * exponent();
}

fn along_chord(a: f32, strength: f32) -> Curve {
    // (2n over n) is the product of (n + k)/k for k from 1 to n.
    var middle = strength;
    for (var k = 1u; k <= exponent(); k++) {
        middle *= 4.0 * a * f32(k) / f32(exponent() + k);
    }
    var curve = Curve();
    curve.d[exponent()] = middle;
    return curve;
}
