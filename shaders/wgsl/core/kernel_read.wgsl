// The kernel of the scene, for shaders that are not compiled for one.

// Twin of `KernelRead` in metaball-core.
struct KernelRead {
    // POWER, WYVILL or PERLIN.
    family: u32,
    // alpha of a power kernel, from 1 to 8; 1 of the others.
    exponent: u32,
}

const POWER: u32 = 0u;
const WYVILL: u32 = 1u;
const PERLIN: u32 = 2u;

@group(1) @binding(4) var<uniform> kernel_read: KernelRead;
