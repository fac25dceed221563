//! The method behind [`IsoRenderer`].

use std::time::{Duration, Instant};

use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderAttachments, RenderError,
    Specialization,
};

use crate::Options;
use crate::balls::{Balls, MOST_BALLS};
use crate::layers::Layers;
use crate::pipelines::Pipelines;

/// Layers that a frame begins life with.
const FIRST_LAYERS: u32 = 64;

/// The most layers: two points for each of the most balls.
const MOST_LAYERS: u32 = 2 * MOST_BALLS as u32 + 1;

/// Draws primary rays by depth peeling.
pub struct Renderer {
    name: &'static str,
    options: Options,
    counting: bool,
    layer_limit: u32,
    pipelines: Option<Pipelines>,
    balls: Option<Balls>,
    layers: Option<Layers>,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(name: &'static str, options: Options, counting: bool) -> Self {
        Self {
            name,
            options,
            counting,
            layer_limit: FIRST_LAYERS,
            pipelines: None,
            balls: None,
            layers: None,
        }
    }

    /// How many balls the last frame drew; those that culling left out or that are not in the
    /// picture are not among them. Waits for the device.
    ///
    /// # Errors
    /// When there is no scene, or the device fails.
    pub fn balls_drawn(&self, gpu: &Gpu) -> Result<u32, RenderError> {
        let balls = self.balls.as_ref();
        balls.ok_or(RenderError::NotBuilt { method: self.name })?.drawn(gpu)
    }

    /// Rectangles of the last frame.
    #[cfg(test)]
    pub(crate) fn placed(&self) -> Option<&wgpu::Buffer> {
        self.balls.as_ref().map(|balls| &balls.placed)
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.balls = None;
        self.options.check(gpu, self.name)?;
        if scene.len() > MOST_BALLS {
            let found = scene.len();
            let reason = format!("needed at most {MOST_BALLS} balls, found {found}");
            return Err(RenderError::Unsupported { method: self.name, reason });
        }
        let start = Instant::now();
        let specialization = Specialization::of(scene, self.counting);
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialization == specialization => pipelines,
            _ => Pipelines::new(gpu, self.name, specialization, &self.options)?,
        };
        let compilation = start.elapsed();

        let balls = Balls::new(gpu, scene, &pipelines.layouts)?;
        let report = BuildReport {
            // The method has no structure.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: balls.scene.bytes() + balls.own_upload_bytes(),
            device_bytes: balls.scene.bytes() + balls.own_bytes(),
            facts: Vec::new(),
        };
        self.layers = None;
        self.pipelines = Some(pipelines);
        self.balls = Some(balls);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(balls)) = (&self.pipelines, &self.balls) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let gpu = frame.gpu();
        let size = (frame.view().width(), frame.view().height());
        let layers = match self.layers.take() {
            Some(layers) if layers.size == size => layers,
            _ => Layers::new(gpu, size, self.options.targets(), &pipelines.layouts)?,
        };
        let drawing = Drawing { pipelines, balls, layers: &layers };
        let view = frame.view();
        balls.begin(gpu, view, frame.encoder())?;
        drawing.arrange(frame, self.options.culling);
        drawing.begin(frame);
        for layer in 0..self.layer_limit {
            balls.take_draws(frame.encoder());
            drawing.peel(frame, layer);
            drawing.test(frame, layer);
        }
        drawing.account(frame);
        self.layers = Some(layers);
        Ok(())
    }

    /// Twice as many layers.
    fn grow(&mut self, _: &Gpu, _: &FrameStatus) -> Result<bool, RenderError> {
        if self.layer_limit == MOST_LAYERS {
            return Ok(false);
        }
        self.layer_limit = self.layer_limit.saturating_mul(2).min(MOST_LAYERS);
        Ok(true)
    }
}

/// The passes of a frame.
struct Drawing<'a> {
    pipelines: &'a Pipelines,
    balls: &'a Balls,
    layers: &'a Layers,
}

impl Drawing<'_> {
    /// Rectangles, culling by kernel spheres, and the lists of balls.
    fn arrange(&self, frame: &mut Frame<'_>, culling: bool) {
        let (pipelines, balls) = (self.pipelines, self.balls);
        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, balls.scene.bind_group(), &[]);
            pass.set_bind_group(2, &balls.arranging, &[]);
        };
        frame.compute("place", |pass| {
            bind(pass);
            pass.set_pipeline(&pipelines.place);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
        });
        // Without culling the depth stays empty, and ends no ray.
        let kernels = RenderAttachments { colors: &[], depth: Some(self.layers.kernels()) };
        frame.render("kernel spheres", kernels, |pass| {
            if culling {
                self.bind(pass, targets);
                pass.set_pipeline(&pipelines.kernels);
                pass.draw(0..4, 0..balls.count);
            }
        });
        if culling {
            let depth = Some(self.layers.kernels_done());
            frame.render("seen", RenderAttachments { colors: &[], depth }, |pass| {
                self.bind(pass, targets);
                pass.set_bind_group(3, &self.layers.seeing, &[]);
                pass.set_pipeline(&pipelines.see);
                pass.draw(0..4, 0..balls.count);
            });
        }
        frame.compute("arrange", |pass| {
            bind(pass);
            pass.set_pipeline(&pipelines.count);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
            pass.set_pipeline(&pipelines.total);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&pipelines.spread);
            pass.dispatch_workgroups(balls.workgroups(), 1, 1);
        });
    }

    /// The lists that rays begin with.
    fn begin(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        self.layers.clear_tiles(frame.encoder(), 0);
        let colors = self.layers.written_before(0);
        frame.render("begin", RenderAttachments { colors: &colors, depth: None }, |pass| {
            self.bind(pass, targets);
            // The flags after layer 1 are those before layer 0; nothing else is read.
            pass.set_bind_group(3, self.layers.testing(1), &[]);
            pass.set_pipeline(&self.pipelines.begin);
            pass.draw(0..4, 0..1);
        });
    }

    /// The layer's points.
    fn peel(&self, frame: &mut Frame<'_>, layer: u32) {
        let targets = frame.targets();
        let attachments = RenderAttachments {
            colors: &[self.layers.points()],
            depth: Some(self.layers.point_depth()),
        };
        frame.render("peel", attachments, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.peeling(layer), &[]);
            pass.set_pipeline(&self.pipelines.peel);
            pass.draw_indirect(&self.balls.arguments, 0);
        });
    }

    /// The search of the layer's intervals, and the lists after it.
    fn test(&self, frame: &mut Frame<'_>, layer: u32) {
        let targets = frame.targets();
        self.layers.clear_tiles(frame.encoder(), layer + 1);
        let colors = self.layers.written_before(layer + 1);
        frame.render("test", RenderAttachments { colors: &colors, depth: None }, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.testing(layer), &[]);
            pass.set_pipeline(&self.pipelines.test);
            pass.draw_indirect(&self.balls.arguments, 16);
        });
    }

    /// The count of rays that no layer answered.
    fn account(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        let (columns, rows) = targets.workgroups();
        frame.compute("account", |pass| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_pipeline(&self.pipelines.account);
            pass.dispatch_workgroups(columns, rows, 1);
        });
    }

    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, targets: &metaball_core::gpu::Targets) {
        pass.set_bind_group(0, targets.bind_group(), &[]);
        pass.set_bind_group(1, self.balls.scene.bind_group(), &[]);
        pass.set_bind_group(2, &self.balls.drawing, &[]);
    }
}
