// An exponent that the shader is compiled for.

// Id 0 of the ids that metaball-core sets.
@id(0) override compiled_exponent: u32 = 2u;

fn exponent() -> u32 {
    return compiled_exponent;
}
