//! A variant that is never wrong where section 7 gives up: coincident points, more balls over a point
//! than a list holds, thousands of balls before the surface.
//!
//! # Theory
//! What gives up is the peeling: it must tell one point of a ray from the next, keep all balls between
//! them, and pass as many layers as there are points. So nothing is peeled. Balls are registered with
//! tiles of the picture as in section 5.3, and each ray searches its tile's list, which is sorted by
//! the eye's distance: on an interval of a ray every ball's least and greatest share of the field, and
//! of its slope, are known in closed form. An interval in which the sum of the greatest stays below T
//! is passed, whoever enters or leaves there; one whose end is certainly above T with a slope that is
//! certainly positive holds one root; any other is halved. The sums have room for the rounding of all
//! that went into them, and distances are kept from a point near by (`core/beside.wgsl`), so that an
//! answer is a hit, a miss, or undecided: closer to T than f32 can tell.
//!
//! | pass | what |
//! | --- | --- |
//! | `register` | lists of balls for the tiles of the picture |
//! | `sort` | each list by distance |
//! | `search` | each ray's first hit |
//! | `resume` | the same for rays that ran out of work for one dispatch |
//!
//! Peeling first and searching what it could not settle would cost both: an f32 list of points does
//! not know by how much it errs, so every answer of it would have to be searched anyway.
//!
//! # Practice
//! Any kernel, Perlin's too. Where the surface lies within 3e-6 of v = 1 − r²/R² of the rims, as with
//! the quartic at thresholds below 1e-11 of the strengths, rays come back undecided. At most [`INTERVAL_CAPACITY`]
//! balls may reach one interval of a ray, and 131,072 one tile of 16 × 16 pixels: beyond that the frame is
//! refused with the numbers. 24 bytes a pixel, 8 for each entry of a list.

mod room;

use std::time::{Duration, Instant};

use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, SceneBuffers, Shader,
    Specialization, frame_layout, scene_layout,
};

#[cfg(test)]
pub(crate) use self::room::{Entry, State};
use self::room::{Room, room_layout};

/// The most balls whose supports may reach one interval of a ray: one walk along them must stay within
/// the iterations of software Vulkan. `MOST_WINDOW` of `kanamori_robust/search.wgsl`.
pub const INTERVAL_CAPACITY: u32 = 8_192;

/// The most balls over a tile of 16 × 16 pixels, bounded by the iterations that sorting them takes.
/// `MOST_ENTRIES` of `kanamori_robust/lists.wgsl`.
pub const TILE_CAPACITY: u32 = 131_072;

/// How far from the root a hit may be, in parts of the least support radius there, rounding aside: an
/// interval that is shorter is not halved further. `SHORT` of `kanamori_robust/search.wgsl`.
pub const ROOT_TOLERANCE: f64 = 1.0 / (1 << 20) as f64;

/// Entries of all tiles that a renderer begins with: 2 MB.
const FIRST_ENTRIES: u32 = 1 << 18;

/// Balls of a workgroup of `kanamori_robust/register.wgsl`, and workgroups of a row of a dispatch.
const BALLS_OF_GROUP: u32 = 64;
const GROUPS_OF_ROW: u32 = 32_768;

/// Draws primary rays by registering balls with tiles and searching intervals.
pub struct Renderer {
    name: &'static str,
    counting: bool,
    entries: u32,
    /// Dispatches of the search after the first.
    resumes: u32,
    pipelines: Option<Pipelines>,
    scene: Option<(SceneBuffers, u32)>,
    room: Option<Room>,
}

struct Pipelines {
    specialization: Specialization,
    room_layout: wgpu::BindGroupLayout,
    count: wgpu::ComputePipeline,
    place: wgpu::ComputePipeline,
    fill: wgpu::ComputePipeline,
    sort: wgpu::ComputePipeline,
    search: wgpu::ComputePipeline,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(name: &'static str, counting: bool) -> Self {
        Self {
            name,
            counting,
            entries: FIRST_ENTRIES,
            resumes: 0,
            pipelines: None,
            scene: None,
            room: None,
        }
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.scene = None;
        let start = Instant::now();
        let specialization = Specialization::of(scene, self.counting);
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialization == specialization => pipelines,
            _ => Pipelines::new(gpu, specialization)?,
        };
        let compilation = start.elapsed();
        self.pipelines = Some(pipelines);

        let buffers = SceneBuffers::new(gpu, scene)?;
        let report = BuildReport {
            // The lists belong to the frame.
            structure: Duration::ZERO,
            pipelines: compilation,
            upload_bytes: buffers.bytes(),
            device_bytes: buffers.bytes(),
            facts: Vec::new(),
        };
        self.scene = Some((buffers, scene.len() as u32));
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some((scene, balls))) = (&self.pipelines, &self.scene) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let size = (frame.view().width(), frame.view().height());
        let room = match self.room.take() {
            Some(room) if room.fits(size, self.entries) => room,
            _ => Room::new(frame.gpu(), &pipelines.room_layout, size, self.entries)?,
        };
        let room = self.room.insert(room);
        room.clear(frame.encoder());

        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, scene.bind_group(), &[]);
            pass.set_bind_group(2, &room.bind_group, &[]);
        };
        let groups = balls.div_ceil(BALLS_OF_GROUP).max(1);
        let (columns, rows) = (groups.min(GROUPS_OF_ROW), groups.div_ceil(GROUPS_OF_ROW));
        frame.compute("register", |pass| {
            bind(pass);
            pass.set_pipeline(&pipelines.count);
            pass.dispatch_workgroups(columns, rows, 1);
            pass.set_pipeline(&pipelines.place);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&pipelines.fill);
            pass.dispatch_workgroups(columns, rows, 1);
        });
        frame.compute("sort", |pass| {
            bind(pass);
            pass.set_pipeline(&pipelines.sort);
            pass.dispatch_workgroups(room.tiles(), 1, 1);
        });
        let (columns, rows) = targets.workgroups();
        for dispatch in 0..=self.resumes {
            frame.compute(if dispatch == 0 { "search" } else { "resume" }, |pass| {
                bind(pass);
                pass.set_pipeline(&pipelines.search);
                pass.dispatch_workgroups(columns, rows, 1);
            });
        }
        Ok(())
    }

    /// Slot 0 is the entries of all tiles, 1 those of a tile that has too many, 2 the balls of an
    /// interval that too many reach.
    fn grow(&mut self, _: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let [entries, longest, window, _] = status.needed;
        let refuse = |reason| Err(RenderError::Unsupported { method: self.name, reason });
        if longest > 0 {
            return refuse(format!(
                "needed at most {TILE_CAPACITY} balls over a tile, found {longest}"
            ));
        }
        if entries > self.entries {
            self.entries = entries;
            return Ok(true);
        }
        if window > 0 {
            return refuse(format!(
                "needed at most {INTERVAL_CAPACITY} balls that reach one interval of a ray, found more"
            ));
        }
        self.resumes = (2 * self.resumes).max(1);
        Ok(true)
    }
}

impl Pipelines {
    fn new(gpu: &Gpu, specialization: Specialization) -> Result<Self, RenderError> {
        let spec = &specialization;
        let room_layout = gpu.checked(|| room_layout(gpu))?;
        let (frame, scene) = (frame_layout(gpu, spec), scene_layout(gpu, spec));
        let groups = [&frame, &scene, &room_layout];
        let shader = |module| Shader::new(gpu, module, module, spec);
        let register = shader("kanamori_robust/register")?;
        let registering = |entry| register.compute(gpu, entry, entry, spec, &groups, &[]);
        Ok(Self {
            specialization,
            count: registering("count_entries")?,
            place: registering("place_tiles")?,
            fill: registering("fill_entries")?,
            sort: registering("sort_entries")?,
            search: shader("kanamori_robust/search")?.compute(
                gpu,
                "search",
                "search",
                spec,
                &groups,
                &[],
            )?,
            room_layout,
        })
    }
}
