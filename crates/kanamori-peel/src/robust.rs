//! A variant of ours that is right where section 7 gives up: coincident points, more balls over a point
//! than a list holds, thousands of balls before the surface.
//!
//! # Theory
//! What fails there is the peeling: it must distinguish one point of a ray from the next, keep all balls
//! between them, and draw as many layers as there are points. So nothing is peeled. Balls are registered
//! with tiles of the picture as in section 5.3, and each ray searches its tile's list, which is sorted by
//! distance from the eye: on an interval of a ray every ball's least and greatest contribution to the
//! field, and to its slope, are known in closed form. An interval in which the sum of the greatest stays
//! below T is passed, whichever balls begin or end there; one whose end is certainly above T with a slope
//! that is certainly positive holds one root; any other is halved. The sums have margins for the rounding
//! of all their terms, and distances are relative to a nearby origin on the ray, so that an answer is a
//! hit, a miss, or undecided: closer to T than f32 can distinguish.
//!
//! | pass | what |
//! | --- | --- |
//! | `register` | lists of balls for the tiles of the picture |
//! | `sort` | each list by distance |
//! | `search` | each ray's first hit |
//! | `resume` | the same for rays whose search exceeded the budget of one dispatch |
//!
//! # Changes versus the paper
//! All of the paper but its tiles is replaced. Peeling first, and searching only what it leaves open,
//! would cost both: the error of an f32 list of points is unknown, so each of its answers would have to
//! be searched anyway.
//!
//! # Practice
//! Any kernel. Where the surface lies within 3e-6 of v = 1 − r²/R² of the rims of supports,
//! as with the quartic at thresholds below 1e-11 of the strengths, rays are undecided. At most
//! [`INTERVAL_CAPACITY`] balls may reach one interval of a ray, and [`TILE_CAPACITY`] be over one tile of
//! 16 × 16 pixels: beyond that the frame is refused with the numbers. 24 bytes a pixel, 8 for each entry
//! of a list. A hit is the field's root to within the rounding of t from the nearby origin, and where the
//! field is nearly flat to 2⁻²⁰ of the least radius there.

mod buffers;

use std::time::{Duration, Instant};

use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, SceneBuffers, Shader,
    Specialization, TileBinning, frame_layout, scene_layout,
};

#[cfg(test)]
pub(crate) use self::buffers::{Entry, State};
use self::buffers::{SearchBuffers, search_layout};

/// The most balls whose supports may reach one interval of a ray: one walk along them must stay within
/// the iterations of software Vulkan. `INTERVAL_CAPACITY` of `shaders/wgsl/kanamori_robust/search.wgsl`.
pub const INTERVAL_CAPACITY: u32 = 8_192;

/// The most balls over a tile of 16 × 16 pixels, bounded by the iterations that sorting them takes.
/// `TILE_CAPACITY` of `shaders/wgsl/kanamori_robust/lists.wgsl`.
pub const TILE_CAPACITY: u32 = 131_072;

/// Entries of all tiles that the first buffers hold: 2 MB.
const FIRST_ENTRIES: u32 = 1 << 18;

/// Draws primary rays by registering balls with tiles and searching intervals.
pub struct Renderer {
    name: &'static str,
    counting: bool,
    /// Entries of all tiles that the next frame's buffers hold.
    entries: u32,
    /// Dispatches of the search after the first.
    resumes: u32,
    pipelines: Option<Pipelines>,
    scene: Option<(SceneBuffers, u32)>,
    buffers: Option<SearchBuffers>,
}

struct Pipelines {
    specialization: Specialization,
    search_layout: wgpu::BindGroupLayout,
    binning: TileBinning,
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
            buffers: None,
        }
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.scene = None;
        RenderError::check_positive(self.name, scene)?;
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
        let buffers = match self.buffers.take() {
            Some(buffers) if buffers.fit(size, self.entries) => buffers,
            _ => SearchBuffers::new(frame.gpu(), &pipelines.search_layout, size, self.entries)?,
        };
        let buffers = self.buffers.insert(buffers);
        buffers.clear(frame.encoder());

        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, scene.bind_group(), &[]);
            pass.set_bind_group(2, &buffers.bind_group, &[]);
        };
        frame.compute("register", |pass| {
            bind(pass);
            pipelines.binning.record(pass, *balls);
        });
        frame.compute("sort", |pass| {
            bind(pass);
            pass.set_pipeline(&pipelines.sort);
            pass.dispatch_workgroups(buffers.tiles(), 1, 1);
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

    fn frame_bytes(&self) -> u64 {
        self.buffers.as_ref().map_or(0, SearchBuffers::bytes)
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
        let search_layout = gpu.checked(|| search_layout(gpu))?;
        let (frame, scene) = (frame_layout(gpu, spec), scene_layout(gpu, spec));
        let groups = [&frame, &scene, &search_layout];
        let shader = |module| Shader::new(gpu, module, module, spec);
        let register = shader("kanamori_robust/register")?;
        let search = shader("kanamori_robust/search")?;
        let compute =
            |shader: &Shader, entry| shader.compute(gpu, entry, entry, spec, &groups, &[]);
        Ok(Self {
            specialization,
            binning: TileBinning::new(gpu, "register", &register, spec, &groups)?,
            sort: compute(&register, "sort_entries")?,
            search: compute(&search, "search")?,
            search_layout,
        })
    }
}
