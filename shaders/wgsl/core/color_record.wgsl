// Where blended colours are recorded, one a pixel. Exists only in scenes with colours.

// sRGB-encoded, as `Color` of metaball-core; written for hits only.
@group(0) @binding(4) var<storage, read_write> color_of_pixel: array<u32>;
