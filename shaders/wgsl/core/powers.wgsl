// Powers of a depth, in the order of multiplications of `Kernel::value_at_depth`.

// v^n for n from 0 to 15, by repeated squaring.
fn power(v: f32, n: u32) -> f32 {
    let squared = v * v;
    let fourth = squared * squared;
    var product = select(1.0, v, (n & 1u) != 0u);
    product *= select(1.0, squared, (n & 2u) != 0u);
    product *= select(1.0, fourth, (n & 4u) != 0u);
    product *= select(1.0, fourth * fourth, (n & 8u) != 0u);
    return product;
}
