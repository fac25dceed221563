//! The method behind [`IsoRenderer`].

use std::time::{Duration, Instant};

use glam::Vec3;
use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderAttachments, RenderError,
    Specialization, Targets,
};

use crate::balls::{Balls, MOST_BALLS};
use crate::layers::Layers;
use crate::pipelines::Pipelines;
use crate::tiles::{Grid, TileRoom, register, supports};
use crate::{Options, Registration};

/// Layers that a frame begins life with.
const FIRST_LAYERS: u32 = 64;

/// Room for registrations that a scene begins with, a ball.
const FIRST_REGISTRATIONS: u32 = 4;

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
    /// For the host's registration.
    supports: Vec<(Vec3, f32)>,
    tiles: Option<TileRoom>,
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
            supports: Vec::new(),
            tiles: None,
            layers: None,
        }
    }

    /// Registrations that there is room for.
    #[cfg(test)]
    pub(crate) fn registration_room(&self) -> Option<u32> {
        self.tiles.as_ref().map(|tiles| tiles.room)
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
        let room = FIRST_REGISTRATIONS.saturating_mul(balls.count.max(1));
        let tiles =
            TileRoom::new(gpu, &balls, &pipelines.layouts, self.options.registration, room)?;
        let report = BuildReport {
            // The method has no structure.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: balls.scene.bytes() + balls.own_upload_bytes(),
            device_bytes: balls.scene.bytes() + balls.own_bytes() + tiles.bytes(),
            facts: Vec::new(),
        };
        self.supports = match self.options.registration {
            Registration::Host => supports(scene),
            Registration::Device => Vec::new(),
        };
        self.layers = None;
        self.tiles = Some(tiles);
        self.pipelines = Some(pipelines);
        self.balls = Some(balls);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(balls), Some(tiles)) =
            (&self.pipelines, &self.balls, &mut self.tiles)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let (gpu, view) = (frame.gpu(), frame.view());
        let size = (view.width(), view.height());
        let layers = match self.layers.take() {
            Some(layers) if layers.size == size => layers,
            _ => Layers::new(gpu, size, self.options.targets(), &pipelines.layouts)?,
        };
        let grid = Grid::new(self.options.tiles, [view.width(), view.height()]);
        if self.options.registration == Registration::Host {
            let (of_tiles, registered) =
                frame.cpu("register", || register(&self.supports, view, &grid));
            if registered.len() > tiles.room as usize {
                let room = registered.len().next_power_of_two().min(u32::MAX as usize) as u32;
                *tiles = TileRoom::new(gpu, balls, &pipelines.layouts, Registration::Host, room)?;
            }
            tiles.fill(gpu, &of_tiles, &registered)?;
        }

        let drawing = Drawing { pipelines, balls, tiles, layers: &layers, options: &self.options };
        balls.begin(gpu, view, frame.encoder())?;
        drawing.arrange(frame);
        if self.options.registration == Registration::Device {
            drawing.register(frame);
        }
        drawing.begin(frame);
        for layer in 0..self.layer_limit {
            drawing.turn(frame);
            drawing.peel(frame, layer, &grid);
            drawing.test(frame, layer);
        }
        drawing.account(frame);
        self.layers = Some(layers);
        Ok(())
    }

    fn frame_bytes(&self) -> u64 {
        self.layers.as_ref().map_or(0, Layers::bytes)
    }

    /// `balls in view`, and `balls drawn` of them; `culled`, the share of the former that is not
    /// among the latter (section 5.2); and `registrations`, in which a ball counts once for each of
    /// its tiles (section 5.3).
    fn frame_facts(&self, gpu: &Gpu) -> Result<Vec<(&'static str, f64)>, RenderError> {
        let (Some(balls), Some(tiles)) = (&self.balls, &self.tiles) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let arranged = balls.arranged(gpu)?;
        let [in_view, drawn] = [arranged.in_view, arranged.drawn].map(f64::from);
        Ok(vec![
            ("balls in view", in_view),
            ("balls drawn", drawn),
            ("culled", 1.0 - drawn / in_view.max(1.0)),
            ("registrations", f64::from(tiles.registrations(gpu)?)),
        ])
    }

    /// As much room as the tiles' balls take, or twice as many layers.
    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let (Some(pipelines), Some(balls), Some(tiles)) =
            (&self.pipelines, &self.balls, &mut self.tiles)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let [registrations, ..] = status.needed;
        if registrations > tiles.room {
            let room = registrations.checked_next_power_of_two().unwrap_or(registrations);
            *tiles =
                TileRoom::new(gpu, balls, &pipelines.layouts, self.options.registration, room)?;
            return Ok(true);
        }
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
    tiles: &'a TileRoom,
    layers: &'a Layers,
    options: &'a Options,
}

impl Drawing<'_> {
    /// Rectangles, culling by kernel spheres, and the balls around the eye.
    fn arrange(&self, frame: &mut Frame<'_>) {
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
    fn register(&self, frame: &mut Frame<'_>) {
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

    /// The lists that rays begin with.
    fn begin(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        self.tiles.begin(frame.encoder());
        let colors = self.layers.written_before(0);
        frame.render("begin", RenderAttachments { colors: &colors, depth: None }, |pass| {
            self.bind(pass, targets);
            // Nothing of group 3 is read: that of layer 1 has none of the targets.
            pass.set_bind_group(3, self.layers.testing(1), &[]);
            pass.set_pipeline(&self.pipelines.begin);
            pass.draw(0..4, 0..1);
        });
    }

    /// What the tiles draw in the next layer.
    fn turn(&self, frame: &mut Frame<'_>) {
        let targets = frame.targets();
        frame.compute("turn", |pass| {
            self.bind_compute(pass, targets, &self.tiles.turning);
            pass.set_pipeline(&self.pipelines.turn);
            pass.dispatch_workgroups(1, 1, 1);
        });
    }

    /// The layer's points, tile by tile in one pass.
    fn peel(&self, frame: &mut Frame<'_>, layer: u32, grid: &Grid) {
        let targets = frame.targets();
        let attachments = RenderAttachments {
            colors: &[self.layers.points()],
            depth: Some(self.layers.point_depth()),
        };
        frame.render("peel", attachments, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.peeling(layer), &[]);
            pass.set_pipeline(&self.pipelines.peel);
            for (draw, [x, y, width, height]) in grid.scissors() {
                pass.set_scissor_rect(x, y, width, height);
                pass.draw_indirect(&self.tiles.draws, draw);
            }
        });
    }

    /// The search of the layer's intervals, and the lists after it.
    fn test(&self, frame: &mut Frame<'_>, layer: u32) {
        let targets = frame.targets();
        let colors = self.layers.written_before(layer + 1);
        frame.render("test", RenderAttachments { colors: &colors, depth: None }, |pass| {
            self.bind(pass, targets);
            pass.set_bind_group(3, self.layers.testing(layer), &[]);
            pass.set_pipeline(&self.pipelines.test);
            pass.draw(0..4, 0..self.options.tiles * self.options.tiles);
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
