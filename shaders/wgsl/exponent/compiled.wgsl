// An exponent that the shader is compiled for.

// Id 0 of the ids that metaball-core sets.
@id(0) override compiled_exponent: u32 = 2u;

// alpha of a power kernel, from 1 to 8.
fn exponent() -> u32 {
    return compiled_exponent;
}
