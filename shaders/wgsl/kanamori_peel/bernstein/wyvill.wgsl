// Wyvill's polynomial of degree six (appendix A, equations 4 and 5).

struct Curve {
    d: array<f32, 7>,
}

fn degree() -> u32 {
    return 6u;
}

fn along_chord(a: f32, strength: f32) -> Curve {
    let scaled = strength * a * a;
    var curve = Curve();
    curve.d[2] = scaled * (16.0 / 27.0);
    curve.d[3] = scaled * (8.0 * a + 5.0) * (8.0 / 45.0);
    curve.d[4] = curve.d[2];
    return curve;
}
