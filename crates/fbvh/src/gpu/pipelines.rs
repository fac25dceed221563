//! The pipelines, and what they are specialised for.

use metaball_core::RayQuery;
use metaball_core::gpu::{
    Binding, Gpu, RenderError, Specialization, bind_group_layout, compute_pipeline, frame_layout,
    free_ray_layout, scene_layout,
};
use metaball_core::{Kernel, KernelForm};

use crate::{Kind, Reading, SecantSearch};

/// What pipelines depend on; while it stays the same, they stay.
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

/// Both entry points of `shaders/wgsl/fbvh/trace.wgsl`, for one source of rays.
pub(super) struct TracePipelines {
    pub(super) trace: wgpu::ComputePipeline,
    pub(super) resume: wgpu::ComputePipeline,
}

/// The pipelines of a scene: for primary rays at once, for each query of free rays when it is first
/// used.
pub(super) struct Pipelines {
    pub(super) specialized: Specialized,
    pub(super) layouts: Layouts,
    pub(super) primary: TracePipelines,
    free: [Option<TracePipelines>; RayQuery::ALL.len()],
    search: Option<SecantSearch>,
}

impl Pipelines {
    pub(super) fn new(
        gpu: &Gpu,
        specialized: Specialized,
        search: Option<SecantSearch>,
    ) -> Result<Self, RenderError> {
        let scene = &specialized.scene;
        let layouts = Layouts {
            primary: frame_layout(gpu, scene),
            free: free_ray_layout(gpu, scene),
            scene: scene_layout(gpu, scene),
            tree: tree_layout(gpu),
        };
        let primary = TracePipelines::new(gpu, &specialized, &layouts, search, None)?;
        Ok(Self { specialized, layouts, primary, free: Default::default(), search })
    }

    /// The pipelines of that query, made when it is first used.
    pub(super) fn answering(
        &mut self,
        gpu: &Gpu,
        query: RayQuery,
    ) -> Result<&TracePipelines, RenderError> {
        let slot = &mut self.free[query as usize - 1];
        let made = match slot.take() {
            Some(made) => made,
            None => TracePipelines::new(
                gpu,
                &self.specialized,
                &self.layouts,
                self.search,
                Some(query),
            )?,
        };
        Ok(slot.insert(made))
    }
}

impl TracePipelines {
    /// For primary rays, or for free rays with one query.
    fn new(
        gpu: &Gpu,
        specialized: &Specialized,
        layouts: &Layouts,
        search: Option<SecantSearch>,
        query: Option<RayQuery>,
    ) -> Result<Self, RenderError> {
        let Specialized { scene, kind, root } = *specialized;
        let spec = scene.choosing(modules(kind, &scene, query));
        // The ids of the override constants in shaders/wgsl/fbvh/trace.wgsl and, of published trees, in
        // shaders/wgsl/fbvh/leaf/published.wgsl.
        let mut constants = vec![("21", f64::from(root))];
        constants.extend(query.map(|query| (RayQuery::CONSTANT, f64::from(query as u32))));
        constants.extend(search.into_iter().flat_map(|search| secant_constants(kind, &search)));
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

/// The override constants of a published leaf's search.
fn secant_constants(kind: Kind, search: &SecantSearch) -> [(&'static str, f64); 4] {
    // Section 4 leaves no choice: the modified BVH is always read literally.
    let clipped = kind == Kind::Fitted && search.reading == Reading::Clipped;
    [
        ("17", f64::from(u8::from(kind == Kind::Fitted))),
        ("18", f64::from(u8::from(clipped))),
        ("19", f64::from(search.tolerance)),
        ("20", f64::from(search.max_iterations)),
    ]
}

/// The shader modules for the source of rays and the search of leaves.
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

/// Group 2: nodes, leaves, lists, and the pool of suspended rays.
fn tree_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let bindings =
        [(0, Binding::Read), (1, Binding::Read), (2, Binding::Read), (3, Binding::Write)];
    bind_group_layout(gpu, "fbvh tree", &bindings)
}
