//! Host structs against their WGSL twins.

use metaball_shaders::{KernelModule, StructLayout, Variant, compose, host_layout, struct_layout};

use crate::balls::{Arranged, Peeling, Placed};
use crate::tiles::Tile;

/// A struct as a module of the method has it.
fn twin(module: &str, name: &str) -> StructLayout {
    let variant = Variant {
        kernel: KernelModule::Wyvill,
        radii: true,
        strengths: true,
        colors: true,
        counting: true,
        chosen: &[
            "kanamori_peel/bernstein/wyvill",
            "kanamori_peel/clipping/short_stack",
            "kanamori_peel/longest/four_targets",
            "kanamori_peel/outline/rectangle",
        ],
    };
    let module = compose(module, &variant).unwrap_or_else(|error| panic!("{error}"));
    struct_layout(&module, name).expect("the module uses the struct")
}

#[test]
fn placed_balls() {
    let host = host_layout!(Placed { low, high, around });
    assert_eq!(twin("kanamori_peel/arrange", "Placed"), host);
    assert_eq!(twin("kanamori_peel/peel", "Placed"), host);
}

#[test]
fn constants_of_a_frame() {
    let host = host_layout!(Peeling { depth_scale });
    assert_eq!(twin("kanamori_peel/test", "Peeling"), host);
    assert_eq!(twin("kanamori_peel/kernels", "Peeling"), host);
}

#[test]
fn arranged_balls() {
    let host = host_layout!(Arranged { in_view, drawn, around, around_balls });
    assert_eq!(twin("kanamori_peel/arrange", "Arranged"), host);
    assert_eq!(twin("kanamori_peel/test", "Arranged"), host);
}

#[test]
fn tiles() {
    let host = host_layout!(Tile { first, balls, is_live, layers });
    for module in ["register", "turn", "peel", "test"] {
        assert_eq!(twin(&format!("kanamori_peel/{module}"), "Tile"), host, "{module}");
    }
}
