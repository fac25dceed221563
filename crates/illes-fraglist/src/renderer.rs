//! The renderer: sort, cores, gather, cast.

use std::time::{Duration, Instant};

use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, SceneBuffers, Specialization,
    Targets,
};
use metaball_core::{Scene, Support, View};

use crate::canvas::{Canvas, ListStats, Rooms};
use crate::options::{Gather, Options, TILE_CAPACITY};
use crate::pipelines::{GatherPasses, Pipelines};
use crate::radix::SortRoom;
use crate::sort::by_effective_distance;

/// Entries of tiles that a renderer begins with: 1 MB.
const FIRST_ENTRIES: u32 = 1 << 18;

/// Draws primary rays by fragment lists.
pub struct Renderer {
    name: &'static str,
    options: Options,
    counting: bool,
    /// What a picture must have room for.
    rooms: Rooms,
    /// Dispatches of the cast after the first.
    resumes: u32,
    pipelines: Option<Pipelines>,
    built: Option<Built>,
    canvas: Option<Canvas>,
}

/// What depends on the scene.
pub(crate) struct Built {
    pub(crate) scene: SceneBuffers,
    /// Kept to be sorted for each frame.
    supports: Vec<Support>,
    ball_of_rank: wgpu::Buffer,
    /// Where balls are sorted on the device.
    sort_room: Option<SortRoom>,
    pub(crate) bind_group: wgpu::BindGroup,
    upload_bytes: u64,
    device_bytes: u64,
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
            rooms: Rooms { nodes: options.first_nodes, entries },
            resumes: 0,
            pipelines: None,
            built: None,
            canvas: None,
        }
    }

    /// What the lists of the last frame were like; `None` before the first.
    ///
    /// # Errors
    /// When the device fails.
    pub fn list_stats(&self, gpu: &Gpu) -> Result<Option<ListStats>, RenderError> {
        self.canvas.as_ref().map(|canvas| canvas.stats(gpu)).transpose()
    }

    /// How many balls are in each pixel's list, row by row from the top left. Draws a frame of its own
    /// up to the lists, again where the pool was too small; nothing is cast.
    ///
    /// # Errors
    /// When there is no scene, or no room for the lists.
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
                return canvas
                    .ok_or(RenderError::NotBuilt { method: self.name })?
                    .list_lengths(gpu);
            }
            self.grow(gpu, &status)?;
        }
    }

    /// The balls of the last frame in their order.
    #[cfg(test)]
    pub(crate) fn order(&self, gpu: &Gpu) -> Result<Option<Vec<u32>>, RenderError> {
        self.built.as_ref().map(|built| gpu.read(&built.ball_of_rank)).transpose()
    }

    /// The passes up to the lists.
    fn record_lists(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let (gpu, targets) = (frame.gpu(), frame.targets());
        let canvas = match self.canvas.take() {
            Some(canvas) if canvas.fits(targets, self.rooms) => canvas,
            _ => Canvas::new(gpu, &pipelines.layouts, targets, self.rooms)?,
        };
        let canvas = self.canvas.insert(canvas);

        match (&pipelines.radix, &built.sort_room) {
            (Some(radix), Some(room)) => radix.record(frame, built.scene.bind_group(), room),
            _ => {
                // With the transfer, as in the paper's table 1.
                let camera = frame.view().camera();
                frame.cpu("sort", || {
                    let order = by_effective_distance(&built.supports, camera);
                    let bytes = bytemuck::cast_slice(&order);
                    gpu.checked(|| gpu.queue.write_buffer(&built.ball_of_rank, 0, bytes))
                })?;
            }
        }
        canvas.clear(frame.encoder());
        match (&pipelines.gather, &canvas.tiles) {
            (GatherPasses::Raster(passes), _) => passes.record(frame, built, canvas),
            (GatherPasses::Tiles(passes), Some(tiles)) => passes.record(frame, built, tiles),
            (GatherPasses::Tiles(_), None) => unreachable!("rooms has entries for tiles"),
        }
        Ok(())
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.built = None;
        let piece = self.options.piece;
        if let Some(reason) = piece.refusal(scene.kernel()) {
            return Err(RenderError::Unsupported { method: self.name, reason });
        }
        let start = Instant::now();
        let specialized = Specialization::of(scene, self.counting).choosing(piece.modules());
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialized == specialized => pipelines,
            _ => Pipelines::new(gpu, specialized, &self.options)?,
        };
        let compilation = start.elapsed();

        let built = Built::new(gpu, scene, &pipelines)?;
        let report = BuildReport {
            // The order of the balls is the only structure, and belongs to the frame.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: built.upload_bytes,
            device_bytes: built.device_bytes,
            facts: Vec::new(),
        };
        self.pipelines = Some(pipelines);
        self.built = Some(built);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        self.record_lists(frame)?;
        let (Some(pipelines), Some(built), Some(canvas)) =
            (&self.pipelines, &self.built, &self.canvas)
        else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let targets = frame.targets();
        let (columns, rows) = targets.workgroups();
        for dispatch in 0..=self.resumes {
            let label = if dispatch == 0 { "cast" } else { "resume" };
            frame.compute(label, |pass| {
                pass.set_pipeline(&pipelines.cast);
                pass.set_bind_group(0, targets.bind_group(), &[]);
                pass.set_bind_group(1, built.scene.bind_group(), &[]);
                pass.set_bind_group(2, &built.bind_group, &[]);
                pass.set_bind_group(3, &canvas.bind_group, &[]);
                pass.dispatch_workgroups(columns, rows, 1);
            });
        }
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
        let has_entries = self.rooms.entries.is_none_or(|room| room >= entries);
        if nodes <= self.rooms.nodes && has_entries {
            if longest > 0 {
                return refuse(format!(
                    "needed at most {} balls along a ray before its core, found more",
                    longest - 1
                ));
            }
            self.resumes = (2 * self.resumes).max(1);
        }
        self.rooms.nodes = self.rooms.nodes.max(nodes);
        self.rooms.entries = self.rooms.entries.map(|room| room.max(entries));
        Ok(true)
    }
}

impl Built {
    /// Number of balls.
    pub(crate) fn len(&self) -> u32 {
        self.supports.len() as u32
    }

    fn new(gpu: &Gpu, scene: &Scene, pipelines: &Pipelines) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let core_radii: Vec<f32> = scene
            .balls()
            .map(|ball| {
                let radius = scene.kernel().core_radius(&ball, scene.threshold());
                radius.map_or(0.0, |radius| radius as f32)
            })
            .collect();
        let buffers = SceneBuffers::new(gpu, scene)?;
        let core_radii = gpu.upload("illes core radii", &core_radii, none)?;
        let ball_of_rank = gpu.storage("illes order", 4 * scene.len() as u64, none)?;
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let bind_group = gpu.checked(|| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("illes balls"),
                layout: &pipelines.layouts.balls,
                entries: &[
                    entry(0, ball_of_rank.as_entire_binding()),
                    entry(1, core_radii.as_entire_binding()),
                ],
            })
        })?;
        let balls = scene.len() as u32;
        let radix = pipelines.radix.as_ref();
        let sort_room = radix.map(|radix| radix.room(gpu, balls, &ball_of_rank)).transpose()?;
        let upload_bytes = buffers.bytes() + core_radii.size();
        let device_bytes =
            upload_bytes + ball_of_rank.size() + sort_room.as_ref().map_or(0, SortRoom::bytes);
        Ok(Self {
            scene: buffers,
            supports: scene.supports().to_vec(),
            ball_of_rank,
            sort_room,
            bind_group,
            upload_bytes,
            device_bytes,
        })
    }
}
