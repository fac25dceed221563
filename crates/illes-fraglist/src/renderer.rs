//! The renderer: sort, cores, gather, cast.

use std::time::{Duration, Instant};

use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderAttachments, RenderError,
    SceneBuffers, Specialization,
};
use metaball_core::{NO_LIMIT, Scene, Support};

use crate::canvas::{Canvas, ListStats};
use crate::options::Options;
use crate::pipelines::{Layouts, Pipelines};
use crate::sort::by_effective_distance;

/// Draws primary rays by fragment lists.
pub struct Renderer {
    name: &'static str,
    options: Options,
    counting: bool,
    /// List nodes that the pool must have.
    nodes: u32,
    /// Dispatches of the cast after the first.
    resumes: u32,
    pipelines: Option<Pipelines>,
    built: Option<Built>,
    canvas: Option<Canvas>,
}

/// What depends on the scene.
struct Built {
    scene: SceneBuffers,
    /// Kept to be sorted for each frame.
    supports: Vec<Support>,
    ball_of_rank: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    bytes: u64,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(name: &'static str, options: Options, counting: bool) -> Self {
        Self {
            name,
            options,
            counting,
            nodes: options.first_nodes,
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

    /// Bytes on the device that the last frame's size takes, list nodes included.
    pub fn canvas_bytes(&self) -> u64 {
        self.canvas.as_ref().map_or(0, Canvas::bytes)
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

        let built = Built::new(gpu, scene, &pipelines.layouts)?;
        let report = BuildReport {
            // The order of the balls is the only structure, and belongs to the frame.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: built.bytes,
            device_bytes: built.bytes,
            facts: Vec::new(),
        };
        self.pipelines = Some(pipelines);
        self.built = Some(built);
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let (gpu, targets) = (frame.gpu(), frame.targets());
        let canvas = match self.canvas.take() {
            Some(canvas) if canvas.fits(targets, self.nodes) => canvas,
            _ => Canvas::new(gpu, &pipelines.layouts, targets, self.nodes)?,
        };
        let canvas = self.canvas.insert(canvas);

        let camera = frame.view().camera();
        let order = frame.cpu("sort", || by_effective_distance(&built.supports, camera));
        gpu.checked(|| {
            gpu.queue.write_buffer(&built.ball_of_rank, 0, bytemuck::cast_slice(&order));
        })?;
        canvas.clear(frame.encoder());

        let balls = order.len() as u32;
        frame.render("cores", core_attachments(canvas).as_attachments(), |pass| {
            pass.set_pipeline(&pipelines.cores);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, &built.bind_group, &[]);
            pass.draw(0..4, 0..balls);
        });
        let gather_attachments = RenderAttachments {
            colors: &[],
            depth: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &canvas.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
        };
        frame.render("gather", gather_attachments, |pass| {
            pass.set_pipeline(&pipelines.gather);
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, &built.bind_group, &[]);
            pass.set_bind_group(3, &canvas.bind_group, &[]);
            pass.draw(0..4, 0..balls);
        });
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

    /// Slot 0 is list nodes, slot 1 the length of a list that is too long.
    fn grow(&mut self, _gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let [nodes, longest, ..] = status.needed;
        if nodes > self.nodes {
            self.nodes = nodes;
        } else if longest > 0 {
            let reason = format!(
                "needed at most {} balls along a ray before its core, found {longest} or more",
                longest - 1
            );
            return Err(RenderError::Unsupported { method: self.name, reason });
        } else {
            self.resumes = (2 * self.resumes).max(1);
        }
        Ok(true)
    }
}

impl Built {
    fn new(gpu: &Gpu, scene: &Scene, layouts: &Layouts) -> Result<Self, RenderError> {
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
                layout: &layouts.balls,
                entries: &[
                    entry(0, ball_of_rank.as_entire_binding()),
                    entry(1, core_radii.as_entire_binding()),
                ],
            })
        })?;
        let bytes = buffers.bytes() + core_radii.size() + ball_of_rank.size();
        let supports = scene.supports().to_vec();
        Ok(Self { scene: buffers, supports, ball_of_rank, bind_group, bytes })
    }
}

/// Targets of the pass that draws cores, cleared to none.
struct CoreAttachments<'a> {
    colors: [Option<wgpu::RenderPassColorAttachment<'a>>; 1],
    depth: wgpu::RenderPassDepthStencilAttachment<'a>,
}

fn core_attachments(canvas: &Canvas) -> CoreAttachments<'_> {
    let far = wgpu::Color { r: f64::from(NO_LIMIT), ..wgpu::Color::BLACK };
    CoreAttachments {
        colors: [Some(wgpu::RenderPassColorAttachment {
            view: &canvas.core,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(far), store: wgpu::StoreOp::Store },
        })],
        depth: wgpu::RenderPassDepthStencilAttachment {
            view: &canvas.depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        },
    }
}

impl CoreAttachments<'_> {
    fn as_attachments(&self) -> RenderAttachments<'_> {
        RenderAttachments { colors: &self.colors, depth: Some(self.depth.clone()) }
    }
}
