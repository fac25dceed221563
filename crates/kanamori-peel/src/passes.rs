//! The passes of a frame, one method each.

use metaball_core::gpu::{Frame, RenderAttachments, Targets};

use crate::balls::Balls;
use crate::layers::Layers;
use crate::options::Options;
use crate::pipelines::Pipelines;
use crate::tiles::{PeeledTile, TileBuffers};

/// What the passes of a frame work with.
pub(crate) struct Passes<'a> {
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) balls: &'a Balls,
    pub(crate) tiles: &'a TileBuffers,
    pub(crate) layers: &'a Layers,
    pub(crate) options: &'a Options,
}

impl Passes<'_> {
    /// Rectangles, culling by kernel spheres, and the balls around the eye.
    pub(crate) fn arrange(&self, frame: &mut Frame<'_>) {
        let (pipelines, balls) = (self.pipelines, self.balls);
        let targets = frame.targets();
        frame.compute("place", |pass| {
            self.bind_compute(pass, targets, &balls.arranging);
            pass.set_pipeline(&pipelines.place);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
        });
        let vertices = 0..self.options.outline.vertices();
        // Without culling the depth stays empty, and ends no ray.
        let kernels = RenderAttachments { colors: &[], depth: Some(self.layers.kernels()) };
        frame.render("kernel spheres", kernels, |pass| {
            if self.options.culling {
                self.bind(pass, targets);
                pass.set_pipeline(&pipelines.kernels);
                pass.draw(vertices.clone(), 0..balls.count);
            }
        });
        if self.options.culling {
            let depth = Some(self.layers.kernels_done());
            frame.render("seen", RenderAttachments { colors: &[], depth }, |pass| {
                self.bind(pass, targets);
                pass.set_bind_group(3, &self.layers.seeing, &[]);
                pass.set_pipeline(&pipelines.see);
                pass.draw(vertices, 0..balls.count);
            });
        }
        frame.compute("arrange", |pass| {
            self.bind_compute(pass, targets, &balls.arranging);
            pass.set_pipeline(&pipelines.count);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
            pass.set_pipeline(&pipelines.total);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&pipelines.spread);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
        });
    }

    /// The tiles' balls.
    pub(crate) fn register(&self, frame: &mut Frame<'_>) {
        let (pipelines, targets) = (self.pipelines, frame.targets());
        frame.compute("register", |pass| {
            self.bind_compute(pass, targets, &self.tiles.registering);
            pass.set_pipeline(&pipelines.tally);
            pass.dispatch_workgroups(self.balls.workgroups(), 1, 1);
            pass.set_pipeline(&pipelines.assign);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&pipelines.fill);
            pass.dispatch_workgroups(self.balls.workgroups(), 1, 1);
        });
    }

    /// What the tiles draw in the next layer.
    pub(crate) fn turn(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        frame.compute("turn", |pass| {
            self.bind_compute(pass, targets, &self.tiles.turning);
            pass.set_pipeline(&self.pipelines.turn);
            pass.dispatch_workgroups(1, 1, 1);
        });
    }

    /// The layer's points, tile by tile in one pass.
    pub(crate) fn peel(&self, frame: &mut Frame<'_>, layer: u32, tiles: &[PeeledTile]) {
        let targets = frame.targets();
        let attachments = RenderAttachments {
            colors: &[self.layers.points(layer)],
            depth: Some(self.layers.point_depth(layer)),
        };
        frame.render("peel", attachments, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.peeling(layer), &[]);
            pass.set_pipeline(&self.pipelines.peel);
            for tile in tiles.iter().filter(|tile| layer < tile.most_layers) {
                let [x, y, width, height] = tile.scissor;
                pass.set_scissor_rect(x, y, width, height);
                pass.draw_indirect(&self.tiles.draws, tile.draw);
            }
        });
    }

    /// The search of the layer's intervals, and the lists after it.
    pub(crate) fn test(&self, frame: &mut Frame<'_>, layer: u32) {
        let targets = frame.targets();
        let colors = self.layers.lists_after(layer);
        let depth = Some(self.layers.point_depth_after());
        frame.render("test", RenderAttachments { colors: &colors, depth }, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.testing(layer), &[]);
            pass.set_pipeline(&self.pipelines.test);
            pass.draw(0..4, 0..self.options.tiles * self.options.tiles);
        });
    }

    /// Rays that no layer answered.
    pub(crate) fn account(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        let (columns, rows) = targets.workgroups();
        frame.compute("account", |pass| {
            self.bind_compute(pass, targets, &self.tiles.drawing);
            pass.set_pipeline(&self.pipelines.account);
            pass.dispatch_workgroups(columns, rows, 1);
        });
    }

    fn bind_compute(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        targets: &Targets,
        group: &wgpu::BindGroup,
    ) {
        pass.set_bind_group(0, targets.bind_group(), &[]);
        pass.set_bind_group(1, self.balls.scene.bind_group(), &[]);
        pass.set_bind_group(2, group, &[]);
    }

    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, targets: &Targets) {
        pass.set_bind_group(0, targets.bind_group(), &[]);
        pass.set_bind_group(1, self.balls.scene.bind_group(), &[]);
        pass.set_bind_group(2, &self.tiles.drawing, &[]);
    }
}
