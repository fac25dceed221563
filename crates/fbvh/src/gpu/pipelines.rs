//! The two pipelines, and what they are specialised for.

use metaball_core::gpu::{
    Gpu, RenderError, Specialization, compute_pipeline, frame_layout, scene_layout,
};

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
    frame: wgpu::BindGroupLayout,
    scene: wgpu::BindGroupLayout,
    pub(super) tree: wgpu::BindGroupLayout,
}

/// `fbvh/trace.wgsl`, both entry points.
pub(super) struct Pipelines {
    pub(super) specialized: Specialized,
    pub(super) layouts: Layouts,
    pub(super) trace: wgpu::ComputePipeline,
    pub(super) resume: wgpu::ComputePipeline,
}

impl Pipelines {
    pub(super) fn new(
        gpu: &Gpu,
        specialized: Specialized,
        options: &TraceOptions,
    ) -> Result<Self, RenderError> {
        let Specialized { scene, kind, root } = specialized;
        let scene = scene.choosing(match kind {
            Kind::ModifiedBvh | Kind::Fitted => &["fbvh/leaf"],
            Kind::Certified => &["fbvh/certified_leaf"],
        });
        let layouts = Layouts {
            frame: frame_layout(gpu, &scene),
            scene: scene_layout(gpu, &scene),
            tree: tree_layout(gpu),
        };
        // Section 4 leaves no choice: the modified BVH is always read literally.
        let clipped = kind == Kind::Fitted && options.reading == Reading::Clipped;
        // The ids of the override constants in fbvh/leaf.wgsl and fbvh/trace.wgsl.
        let published = [
            ("17", f64::from(u8::from(kind == Kind::Fitted))),
            ("18", f64::from(u8::from(clipped))),
            ("19", f64::from(options.tolerance)),
            ("20", f64::from(options.max_iterations)),
        ];
        let mut constants = vec![("21", f64::from(root))];
        if kind != Kind::Certified {
            constants.extend(published);
        }
        let groups = [&layouts.frame, &layouts.scene, &layouts.tree];
        let pipeline = |label, entry| {
            compute_pipeline(gpu, label, "fbvh/trace", entry, &scene, &groups, &constants)
        };
        let trace = pipeline("fbvh trace", "trace")?;
        let resume = pipeline("fbvh resume", "resume")?;
        Ok(Self { specialized, trace, resume, layouts })
    }
}

/// Group 2: nodes, leaves, lists, and the pool of waiting rays.
fn tree_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("fbvh tree"),
        entries: &[storage(0, true), storage(1, true), storage(2, true), storage(3, false)],
    })
}
