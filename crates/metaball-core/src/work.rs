//! Work counters: what a pixel cost, apart from time.

use std::fmt;

use bytemuck::{Pod, Zeroable};

/// What one pixel cost, 32 bytes: WGSL's `Work` of `shaders/wgsl/core/work_record.wgsl`. Exists only while
/// counting.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct Work {
    /// Nodes of a structure visited.
    pub nodes: u32,
    /// Intersection tests between the ray and a leaf, layer or interval.
    pub leaf_tests: u32,
    /// Balls tested against the ray.
    pub balls: u32,
    /// Evaluations of one ball's kernel.
    pub evaluations: u32,
    /// Steps of a root finder.
    pub iterations: u32,
    /// Peeled layers or list entries visited.
    pub layers: u32,
    /// Depth of the deepest node visited: interior nodes between it and a tree's root. Bounded by `depth` in
    /// the statistics of the tree; 0 from methods without a tree.
    pub depth: u32,
    /// Most steps of a root finder in one search; 0 from methods that do not mark where a search ends. A
    /// maximum, which cannot be summed over the picture, so it is no [`WorkKind`].
    pub longest_search: u32,
}

/// A counter of [`Work`], by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum WorkKind {
    /// [`Work::nodes`].
    Nodes = 0,
    /// [`Work::leaf_tests`].
    LeafTests = 1,
    /// [`Work::balls`].
    Balls = 2,
    /// [`Work::evaluations`].
    Evaluations = 3,
    /// [`Work::iterations`].
    Iterations = 4,
    /// [`Work::layers`].
    Layers = 5,
    /// [`Work::depth`].
    Depth = 6,
}

impl WorkKind {
    /// Every counter.
    pub const ALL: [Self; 7] = [
        Self::Nodes,
        Self::LeafTests,
        Self::Balls,
        Self::Evaluations,
        Self::Iterations,
        Self::Layers,
        Self::Depth,
    ];

    /// The counter's value.
    pub fn of(self, work: &Work) -> u32 {
        match self {
            Self::Nodes => work.nodes,
            Self::LeafTests => work.leaf_tests,
            Self::Balls => work.balls,
            Self::Evaluations => work.evaluations,
            Self::Iterations => work.iterations,
            Self::Layers => work.layers,
            Self::Depth => work.depth,
        }
    }
}

impl fmt::Display for WorkKind {
    /// The name that tables use, such as `leaf tests`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Nodes => "nodes",
            Self::LeafTests => "leaf tests",
            Self::Balls => "balls",
            Self::Evaluations => "evaluations",
            Self::Iterations => "iterations",
            Self::Layers => "layers",
            Self::Depth => "depth",
        })
    }
}
