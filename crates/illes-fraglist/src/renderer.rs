//! The renderer: sort, cores, gather, cast.

use std::time::{Duration, Instant};

use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, Specialization, Targets,
};
use metaball_core::{Scene, View};

use crate::balls::Balls;
use crate::canvas::{Canvas, Capacities};
use crate::lists::ListStats;
use crate::options::{Gather, Options, TILE_CAPACITY};
use crate::pipelines::Pipelines;

/// Entries of all tiles that the first canvas holds: 1 MB.
const FIRST_ENTRIES: u32 = 1 << 18;

/// Draws primary rays by fragment lists.
pub struct Renderer {
    name: &'static str,
    options: Options,
    counting: bool,
    /// Iterations after which a ray waits; `None`: what the shader has.
    budget: Option<u32>,
    /// What the next canvas holds at most.
    capacities: Capacities,
    /// Dispatches of the cast after the first.
    resumes: u32,
    pipelines: Option<Pipelines>,
    balls: Option<Balls>,
    canvas: Option<Canvas>,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(name: &'static str, options: Options, counting: bool) -> Self {
        let entries = match options.gather {
            Gather::Raster => None,
            Gather::Tiles => Some(FIRST_ENTRIES),
        };
        Self {
            name,
            options,
            counting,
            budget: None,
            capacities: Capacities { nodes: options.first_nodes, entries },
            resumes: 0,
            pipelines: None,
            balls: None,
            canvas: None,
        }
    }

    /// What the lists of the last frame were like; `None` before the first.
    ///
    /// # Errors
    /// When the device fails.
    pub fn list_stats(&self, gpu: &Gpu) -> Result<Option<ListStats>, RenderError> {
        self.canvas.as_ref().map(|canvas| canvas.lists.stats(gpu)).transpose()
    }

    /// How many balls are in each pixel's list, row by row from the top left. Draws a frame of its own
    /// up to the lists, again where the pool was too small; nothing is cast.
    ///
    /// # Errors
    /// When there is no scene, or the lists exceed what the adapter binds.
    pub fn list_lengths(
        &mut self,
        gpu: &Gpu,
        targets: &Targets,
        view: &View,
    ) -> Result<Vec<u32>, RenderError> {
        loop {
            let mut frame = Frame::begin(gpu, targets, view)?;
            self.record_lists(&mut frame)?;
            let status = frame.finish()?.status;
            if status.is_complete() {
                let canvas = self.canvas.as_ref();
                let canvas = canvas.ok_or(RenderError::NotBuilt { method: self.name })?;
                return canvas.lists.lengths(gpu);
            }
            self.grow(gpu, &status)?;
        }
    }

    /// The same with another budget of iterations, after which a ray waits for the next dispatch.
    #[cfg(test)]
    pub(crate) fn with_budget(self, iterations: u32) -> Self {
        Self { budget: Some(iterations), ..self }
    }

    /// Dispatches of the last frame's cast after the first.
    #[cfg(test)]
    pub(crate) fn resumes(&self) -> u32 {
        self.resumes
    }

    /// The balls of the last frame in their order.
    #[cfg(test)]
    pub(crate) fn order(&self, gpu: &Gpu) -> Result<Option<Vec<u32>>, RenderError> {
        self.balls.as_ref().map(|balls| balls.order(gpu)).transpose()
    }

    /// The passes up to the lists.
    fn record_lists(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(balls)) = (&self.pipelines, &self.balls) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let (gpu, targets) = (frame.gpu(), frame.targets());
        let canvas = match self.canvas.take() {
            Some(canvas) if canvas.fits(targets, self.capacities) => canvas,
            _ => Canvas::new(gpu, &pipelines.layouts, targets, self.capacities)?,
        };
        let canvas = self.canvas.insert(canvas);

        match (&pipelines.sort, &balls.sort_buffers) {
            (Some(radix), Some(buffers)) => radix.record(frame, balls.scene.bind_group(), buffers),
            _ => {
                // With the transfer, as in the paper's table 1.
                let camera = frame.view().camera();
                frame.cpu("sort", || balls.sort(gpu, camera))?;
            }
        }
        canvas.clear(frame.encoder());
        pipelines.gather.record(frame, balls, canvas);
        Ok(())
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.balls = None;
        RenderError::check_positive(self.name, scene)?;
        let piece = self.options.piece;
        if let Some(reason) = piece.refusal(scene.kernel()) {
            return Err(RenderError::Unsupported { method: self.name, reason });
        }
        let start = Instant::now();
        let specialized = Specialization::of(scene, self.counting).choosing(self.options.modules());
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialized == specialized => pipelines,
            _ => Pipelines::new(gpu, specialized, &self.options, self.budget)?,
        };
        let compilation = start.elapsed();

        let balls = Balls::new(gpu, scene, &pipelines.layouts, self.options.sort)?;
        let report = BuildReport {
            // The order of the balls is the only structure, and belongs to the frame.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: balls.upload_bytes(),
            device_bytes: balls.device_bytes(),
            facts: Vec::new(),
        };
        self.pipelines = Some(pipelines);
        self.balls = Some(balls);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        self.record_lists(frame)?;
        let (Some(pipelines), Some(balls), Some(canvas)) =
            (&self.pipelines, &self.balls, &self.canvas)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        pipelines.cast.record(frame, balls, canvas, self.resumes);
        Ok(())
    }

    fn frame_bytes(&self) -> u64 {
        self.canvas.as_ref().map_or(0, Canvas::bytes)
    }

    /// Slot 0 is list nodes, 1 the length of a list that is too long, 2 the entries of all tiles, 3
    /// those of a tile that has too many.
    fn grow(&mut self, _gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let [nodes, longest, entries, fullest] = status.needed;
        let refuse = |reason| Err(RenderError::Unsupported { method: self.name, reason });
        if fullest > 0 {
            return refuse(format!(
                "needed at most {TILE_CAPACITY} balls over a tile, found {fullest}"
            ));
        }
        let entries_fit = self.capacities.entries.is_none_or(|capacity| capacity >= entries);
        if nodes <= self.capacities.nodes && entries_fit {
            if longest > 0 {
                return refuse(format!(
                    "needed at most {} balls along a ray before its core, found more",
                    longest - 1
                ));
            }
            self.resumes = (2 * self.resumes).max(1);
        }
        self.capacities.nodes = self.capacities.nodes.max(nodes);
        self.capacities.entries = self.capacities.entries.map(|capacity| capacity.max(entries));
        Ok(true)
    }
}
