// Where work is recorded, one record a pixel. Exists only while counting.

// Twin of `Work` in metaball-core; zeros when the frame begins.
struct Work {
    // Nodes of a structure visited.
    nodes: u32,
    // Intersection tests between the ray and a leaf, layer or interval.
    leaf_tests: u32,
    // Balls visited.
    balls: u32,
    // Evaluations of one ball's kernel.
    evaluations: u32,
    // Steps of a root finder.
    iterations: u32,
    // Peeled layers, or entries of a list.
    layers: u32,
    // Interior nodes on the longest path from a tree's root that was followed.
    depth: u32,
    // Most steps of a root finder in one search.
    longest_search: u32,
}

@group(0) @binding(5) var<storage, read_write> work_of_pixel: array<Work>;
