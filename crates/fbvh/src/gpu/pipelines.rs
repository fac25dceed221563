//! The pipelines, and what they are specialised for.

use metaball_core::gpu::{
    Binding, Gpu, RayQuery, RenderError, Specialization, bind_group_layout, compute_pipeline,
    frame_layout, free_ray_layout, scene_layout,
};
use metaball_core::{Kernel, KernelForm};

use crate::{Kind, Reading, TraceOptions};

/// What selects pipelines; when it stays the same, they stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Specialized {
    pub(super) scene: Specialization,
    pub(super) kind: Kind,
    pub(super) root: u32,
}

/// The bind group layouts, by group.
pub(super) struct Layouts {
    primary: wgpu::BindGroupLayout,
    free: wgpu::BindGroupLayout,
    scene: wgpu::BindGroupLayout,
    pub(super) tree: wgpu::BindGroupLayout,
}

/// `fbvh/trace.wgsl`, both entry points, for rays of one kind.
pub(super) struct TracePipelines {
    pub(super) trace: wgpu::ComputePipeline,
    pub(super) resume: wgpu::ComputePipeline,
}

/// The pipelines of a scene: for primary rays at once, for each query of free rays when it is
/// first asked.
pub(super) struct Pipelines {
    pub(super) specialized: Specialized,
    pub(super) layouts: Layouts,
    pub(super) primary: TracePipelines,
    free: [Option<TracePipelines>; RayQuery::ALL.len()],
    options: TraceOptions,
}

impl Pipelines {
    pub(super) fn new(
        gpu: &Gpu,
        specialized: Specialized,
        options: &TraceOptions,
    ) -> Result<Self, RenderError> {
        let scene = &specialized.scene;
        let layouts = Layouts {
            primary: frame_layout(gpu, scene),
            free: free_ray_layout(gpu, scene),
            scene: scene_layout(gpu, scene),
            tree: tree_layout(gpu),
        };
        let primary = TracePipelines::new(gpu, &specialized, &layouts, options, None)?;
        Ok(Self { specialized, layouts, primary, free: Default::default(), options: *options })
    }

    /// The pipelines of that query, made when it is first used.
    pub(super) fn answering(
        &mut self,
        gpu: &Gpu,
        query: RayQuery,
    ) -> Result<&TracePipelines, RenderError> {
        let place = &mut self.free[query as usize - 1];
        let made = match place.take() {
            Some(made) => made,
            None => TracePipelines::new(
                gpu,
                &self.specialized,
                &self.layouts,
                &self.options,
                Some(query),
            )?,
        };
        Ok(place.insert(made))
    }
}

impl TracePipelines {
    /// For primary rays, or for free rays with one query.
    fn new(
        gpu: &Gpu,
        specialized: &Specialized,
        layouts: &Layouts,
        options: &TraceOptions,
        query: Option<RayQuery>,
    ) -> Result<Self, RenderError> {
        let Specialized { scene, kind, root } = *specialized;
        let spec = scene.choosing(modules(kind, &scene, query));
        // Section 4 leaves no choice: the modified BVH is always read literally.
        let clipped = kind == Kind::Fitted && options.reading == Reading::Clipped;
        // The ids of the override constants in fbvh/leaf/published.wgsl and fbvh/trace.wgsl.
        let published = [
            ("17", f64::from(u8::from(kind == Kind::Fitted))),
            ("18", f64::from(u8::from(clipped))),
            ("19", f64::from(options.tolerance)),
            ("20", f64::from(options.max_iterations)),
        ];
        let mut constants = vec![("21", f64::from(root))];
        constants.extend(query.map(|query| (RayQuery::CONSTANT, f64::from(query as u32))));
        if kind != Kind::Certified {
            constants.extend(published);
        }
        let rays = if query.is_some() { &layouts.free } else { &layouts.primary };
        let groups = [rays, &layouts.scene, &layouts.tree];
        let pipeline = |label, entry| {
            compute_pipeline(gpu, label, "fbvh/trace", entry, &spec, &groups, &constants)
        };
        Ok(Self {
            trace: pipeline("fbvh trace", "trace")?,
            resume: pipeline("fbvh resume", "resume")?,
        })
    }
}

/// Where rays come from, and how leaves are searched.
fn modules(kind: Kind, scene: &Specialization, query: Option<RayQuery>) -> &'static [&'static str] {
    let is_quartic = scene.kernel == Kernel::QUARTIC && scene.kernel_form == KernelForm::Known;
    match (kind, query) {
        (Kind::ModifiedBvh | Kind::Fitted, None) => &["ray/primary", "fbvh/leaf/published"],
        (Kind::ModifiedBvh | Kind::Fitted, Some(_)) => &["ray/free", "fbvh/leaf/published"],
        (Kind::Certified, None) if is_quartic => &[
            "ray/primary",
            "fbvh/leaf/certified",
            "fbvh/excess/entry",
            "fbvh/polynomial_test/quartic",
        ],
        (Kind::Certified, None) => &[
            "ray/primary",
            "fbvh/leaf/certified",
            "fbvh/excess/entry",
            "fbvh/polynomial_test/none",
        ],
        (Kind::Certified, Some(RayQuery::Exit)) => {
            &["ray/free", "fbvh/leaf/certified", "fbvh/excess/exit", "fbvh/polynomial_test/none"]
        }
        (Kind::Certified, Some(_)) if is_quartic => &[
            "ray/free",
            "fbvh/leaf/certified",
            "fbvh/excess/entry",
            "fbvh/polynomial_test/quartic",
        ],
        (Kind::Certified, Some(_)) => {
            &["ray/free", "fbvh/leaf/certified", "fbvh/excess/entry", "fbvh/polynomial_test/none"]
        }
    }
}

/// Group 2: nodes, leaves, lists, and the pool of waiting rays.
fn tree_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let bindings =
        [(0, Binding::Read), (1, Binding::Read), (2, Binding::Read), (3, Binding::Write)];
    bind_group_layout(gpu, "fbvh tree", &bindings)
}
