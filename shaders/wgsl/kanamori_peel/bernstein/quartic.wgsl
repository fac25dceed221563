// The quartic v^2 (appendix A, equation 3).

struct Curve {
    d: array<f32, 5>,
}

fn degree() -> u32 {
    return 4u;
}

fn along_chord(a: f32, strength: f32) -> Curve {
    var curve = Curve();
    curve.d[2] = strength * a * a * (8.0 / 3.0);
    return curve;
}
