// The quartic v^2 along a chord in Bernstein form (appendix A, equation 3, with a = Q^2/R^2).

struct Curve {
    d: array<f32, 5>,
}

fn degree() -> u32 {
    return 4u;
}

// `a` is Q^2/R^2: half the chord over the radius, squared.
fn along_chord(a: f32, strength: f32) -> Curve {
    var curve = Curve();
    curve.d[2] = strength * a * a * (8.0 / 3.0);
    return curve;
}
