//! Core depth and lists in compute, by way of tiles of the picture: not published.

use metaball_core::gpu::{Frame, Gpu, RenderError, Shader, Specialization, TileBinning};

use crate::balls::Balls;
use crate::canvas::Tiles;
use crate::layouts::Layouts;

/// `shaders/wgsl/illes_fraglist/bin.wgsl` and `shaders/wgsl/illes_fraglist/collect.wgsl`.
pub(crate) struct TileGather {
    binning: TileBinning,
    collect: wgpu::ComputePipeline,
}

impl TileGather {
    pub(super) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let Layouts { frame, scene, balls, tiles, .. } = layouts;
        let groups = [frame, scene, balls, tiles];
        let bin = Shader::new(gpu, "illes bin", "illes_fraglist/bin", spec)?;
        let collect = Shader::new(gpu, "illes collect", "illes_fraglist/collect", spec)?;
        Ok(Self {
            binning: TileBinning::new(gpu, "illes bin", &bin, spec, &groups)?,
            collect: collect.compute(gpu, "illes collect", "collect", spec, &groups, &[])?,
        })
    }

    /// The passes `bin` and `gather`.
    pub(super) fn record(&self, frame: &mut Frame<'_>, balls: &Balls, tiles: &Tiles) {
        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, balls.scene.bind_group(), &[]);
            pass.set_bind_group(2, &balls.bind_group, &[]);
            pass.set_bind_group(3, &tiles.bind_group, &[]);
        };
        frame.compute("bin", |pass| {
            bind(pass);
            self.binning.record(pass, balls.len());
        });
        let (columns, rows) = targets.workgroups();
        frame.compute("gather", |pass| {
            bind(pass);
            pass.set_pipeline(&self.collect);
            pass.dispatch_workgroups(columns, rows, 1);
        });
    }
}
