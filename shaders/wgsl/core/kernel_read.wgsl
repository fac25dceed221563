// The kernel of the scene, for shaders that are not compiled for one.

// Twin of `KernelRead` in metaball-core.
struct KernelRead {
    // One of the families below.
    family: u32,
    // alpha of a power kernel, from 1 to 8; 1 of the others.
    exponent: u32,
    // c and 1/(e^c - 1) of a Gaussian; 0 of the others.
    gaussian_exponent: f32,
    gaussian_scale: f32,
}

const POWER: u32 = 0u;
const WYVILL: u32 = 1u;
// From here on, but for the Gaussian, formulas of profile::rim::Place.
const PERLIN: u32 = 2u;
const CUBIC_SPLINE: u32 = 3u;
const QUINTIC_SPLINE: u32 = 4u;
const WENDLAND_C2: u32 = 5u;
const WENDLAND_C4: u32 = 6u;
const WENDLAND_C6: u32 = 7u;
const GAUSSIAN: u32 = 8u;

@group(1) @binding(4) var<uniform> kernel_read: KernelRead;
