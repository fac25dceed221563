//! Measuring fragment lists on a scene, variants in turn.

use std::collections::BTreeMap;
use std::time::Duration;

use anyhow::Context;
use bench_scenes::BenchScene;
use illes_fraglist::{Gather, Options, Renderer, Sort};
use metaball_core::View;
use metaball_core::gpu::{Gpu, IsoRenderer, Targets};
use serde::{Deserialize, Serialize};

use harness::canvas::Canvas;
use harness::measure::{PreparedRenderer, time_all, views};
use harness::record::Samples;
use harness::renderer;
use harness::stats::{quantile, sorted};

/// What is measured side by side: name, gathering, sorting.
pub const VARIANTS: [(&str, Gather, Sort); 3] = [
    ("illes", Gather::Raster, Sort::Host),
    ("illes, sorted on the adapter", Gather::Raster, Sort::Adapter),
    ("illes-compute", Gather::Tiles, Sort::Host),
];

/// Milliseconds of the phases of table 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Phases {
    /// The whole frame. Ours is wall time, from the start of encoding to the fence, and has the pass
    /// that makes the rays and all waiting in it.
    pub total: f64,
    /// By effective distance, with the transfer of the order.
    pub sort: f64,
    /// Core depth. In compute it is part of `gather`.
    pub depth: f64,
    /// Lists of pixels; in compute with the lists of tiles.
    pub gather: f64,
    /// Along the rays. The paper's has shading in it, ours only the normals.
    pub cast: f64,
}

/// A variant measured on a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ListRun {
    /// What was loaded.
    pub scene: String,
    /// Number of balls.
    pub balls: usize,
    /// One of [`VARIANTS`].
    #[serde(rename = "setting")]
    pub variant: String,
    /// Milliseconds of each frame.
    pub frame_ms: Samples,
    /// Medians.
    pub phases: Phases,
    /// Median milliseconds of each pass.
    pub passes: BTreeMap<String, f64>,
    /// Pixels that had more separators than the array has capacity for.
    pub fallback_pixels: u64,
    /// Lists of the first frame.
    pub lists: Lists,
    /// What it all took.
    pub memory: Memory,
}

/// Lists of a picture: how many balls each ray meets before a core.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lists {
    /// Nodes of all lists; eight bytes each in the pool.
    pub nodes: u64,
    /// Pixels whose list is not empty; all that follows is over these.
    pub pixels: u64,
    /// Mean length.
    pub mean: f64,
    /// Half are longer.
    pub median: f64,
    /// One in ten is longer.
    pub p90: f64,
    /// One in a hundred is longer.
    pub p99: f64,
    /// The longest.
    pub max: f64,
}

/// Bytes of the buffers and textures that were made, once all frames were drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// The scene, its order, and what sorting takes.
    pub scene_bytes: u64,
    /// The method's own for the picture: core depth, progress, heads, and the pool.
    pub frame_bytes: u64,
    /// What all methods share: rays and hits.
    pub target_bytes: u64,
}

impl Memory {
    /// All of it.
    pub fn total(&self) -> u64 {
        self.scene_bytes + self.frame_bytes + self.target_bytes
    }
}

impl Lists {
    fn new(lengths: &[u32]) -> Self {
        let present: Vec<_> =
            lengths.iter().filter(|&&length| length > 0).map(|&length| f64::from(length)).collect();
        let nodes = lengths.iter().map(|&length| u64::from(length)).sum::<u64>();
        let rising = sorted(present);
        let at = |share| quantile(&rising, share).unwrap_or(0.0);
        Self {
            nodes,
            pixels: rising.len() as u64,
            mean: nodes as f64 / rising.len().max(1) as f64,
            median: at(0.5),
            p90: at(0.9),
            p99: at(0.99),
            max: at(1.0),
        }
    }
}

impl Phases {
    fn new(frame_ms: f64, passes: &BTreeMap<String, f64>) -> Self {
        let sum = |labels: &[&str]| labels.iter().filter_map(|label| passes.get(*label)).sum();
        Self {
            total: frame_ms,
            sort: sum(&["cpu:sort", "sort"]),
            depth: sum(&["cores"]),
            gather: sum(&["bin", "gather"]),
            cast: sum(&["cast", "resume"]),
        }
    }

    /// The phases, each with its name; the total is none.
    pub fn named(&self) -> [(&'static str, f64); 4] {
        [("sort", self.sort), ("depth", self.depth), ("gather", self.gather), ("cast", self.cast)]
    }
}

/// A renderer of a variant.
pub fn renderer((name, gather, sort): (&'static str, Gather, Sort)) -> Renderer {
    Renderer::new(name, Options { gather, sort, ..Options::default() }, false)
}

/// Measures all variants on a scene, so many frames in turn, each from a camera of its own near the
/// given one. One that fails has its reason instead of a run.
///
/// # Errors
/// When the pictures are too large for the adapter.
pub fn measure(
    gpu: &Gpu,
    bench: &BenchScene,
    size: (u32, u32),
    frames: usize,
    mut stage: impl FnMut(&str),
) -> anyhow::Result<Vec<anyhow::Result<ListRun>>> {
    let scene = &bench.scene;
    let views = views(&bench.camera, &[], &scene.bounds(), size, frames.max(1))?;
    let targets = Targets::new(gpu, size.0, size.1, scene.colors().is_some(), false)?;
    let mut renderers = Vec::new();
    let mut prepared = Vec::new();
    for variant in VARIANTS {
        stage(variant.0);
        prepared.push(prepare(gpu, bench, variant, &targets, &views[0]).map(
            |(renderer, lists)| {
                renderers.push(renderer);
                lists
            },
        ));
    }
    stage("timing");
    let canvas = Canvas::on_adapter(gpu, &targets);
    let timings = time_all(canvas, &mut renderers, &views, Duration::MAX, || ());
    let mut timed = renderers.into_iter().zip(timings);
    let run = |((variant, ..), lists): ((&str, Gather, Sort), anyhow::Result<Lists>)| {
        let about = || format!("{}, {variant}", bench.name);
        let lists = lists.with_context(about)?;
        let (renderer, timing) = timed.next().context("a timing for each renderer")?;
        let timing = timing.with_context(about)?;
        let scene_bytes = renderer.build.device_bytes;
        Ok(ListRun {
            scene: bench.name.clone(),
            balls: scene.len(),
            variant: variant.to_owned(),
            phases: Phases::new(timing.frame_ms.median, &timing.passes),
            frame_ms: timing.frame_ms,
            passes: timing.passes,
            fallback_pixels: renderer.hits.iter().filter(|hit| hit.fallback).count() as u64,
            lists,
            memory: Memory {
                scene_bytes,
                frame_bytes: renderer.device_bytes() - scene_bytes,
                target_bytes: targets.bytes(),
            },
        })
    };
    Ok(VARIANTS.into_iter().zip(prepared).map(run).collect())
}

fn prepare<'s>(
    gpu: &Gpu,
    bench: &'s BenchScene,
    variant: (&'static str, Gather, Sort),
    targets: &Targets,
    view: &View,
) -> anyhow::Result<(PreparedRenderer<'s>, Lists)> {
    let mut renderer = renderer(variant);
    renderer.build(gpu, &bench.scene)?;
    let lists = Lists::new(&renderer.list_lengths(gpu, targets, view)?);
    let canvas = Canvas::on_adapter(gpu, targets);
    let renderer = renderer::Renderer::Adapter(Box::new(renderer));
    Ok((PreparedRenderer::prepare(canvas, renderer, &bench.scene, view)?, lists))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_lists_are_left_out() {
        let lists = Lists::new(&[0, 1, 0, 3, 5, 7]);
        assert_eq!((lists.nodes, lists.pixels, lists.mean), (16, 4, 4.0));
        assert_eq!((lists.median, lists.max), (4.0, 7.0));
        assert_eq!(Lists::new(&[0]).mean, 0.0);
    }
}
