//! Both structures traced on the graphics card, behind [`IsoRenderer`].
//!
//! # Theory
//! The tree is built on the host and uploaded as it is ([`Node`](crate::Node),
//! [`Leaf`](crate::Leaf) and lists of indices). One invocation traces one ray with the intersection
//! test of Gourmel et al. 2010, section 3, as the CPU's [`Tracer`](crate::Tracer) does.
//!
//! # Changes versus the paper
//! *Rays can wait.* The leaf test is quadratic, and software Vulkan silently ends an invocation's
//! loops after 65,535 iterations; a watchdog may do worse. So an invocation counts its iterations,
//! and past a budget writes down where its ray stands; the next dispatch takes it up there. A frame
//! begins with one dispatch over the picture, label `trace`, and goes on with indirect ones over
//! the rays that wait, label `resume`. A frame that ends with rays waiting, or had no place for
//! one, is incomplete; [`IsoRenderer::grow`] adds room or dispatches. Hence no ray is ever cut short,
//! and a sparse scene pays with a few empty dispatches.
//!
//! *The stack cannot overflow*: the builder bounds the depth to what the shader has room for.
//!
//! # Practice
//! Pipelines are compiled at the first build and again only when a scene needs other ones: another
//! kernel, strengths or colours where there were none.

mod device_tree;
mod pipelines;
mod waiting;

use std::time::Instant;

use metaball_core::Scene;
use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RenderError, SceneBuffers, Specialization,
};

use self::device_tree::DeviceTree;
use self::pipelines::{Pipelines, Specialized};
use self::waiting::WaitingRoom;
use crate::{Options, TraceOptions, Tree};

/// Dispatches after the first that a frame begins life with.
const FIRST_RESUMES: u32 = 4;

/// Draws primary rays through a tree of the scene.
pub struct Renderer {
    name: &'static str,
    options: Options,
    trace_options: TraceOptions,
    counting: bool,
    resumes: u32,
    pipelines: Option<Pipelines>,
    built: Option<Built>,
}

/// What depends on the scene.
struct Built {
    scene: SceneBuffers,
    tree: DeviceTree,
    waiting: WaitingRoom,
}

impl Renderer {
    /// A renderer without a scene. `counting` makes shaders that count their work, which costs
    /// time.
    pub fn new(
        name: &'static str,
        options: Options,
        trace_options: TraceOptions,
        counting: bool,
    ) -> Self {
        Self {
            name,
            options,
            trace_options,
            counting,
            resumes: FIRST_RESUMES,
            pipelines: None,
            built: None,
        }
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.built = None;
        let start = Instant::now();
        let tree = Tree::build(scene, &self.options)
            .map_err(|error| RenderError::Structure { method: self.name, source: error.into() })?;
        let structure = start.elapsed();

        let start = Instant::now();
        let specialized = Specialized {
            scene: Specialization::of(scene, self.counting),
            kind: tree.kind(),
            root: tree.root(),
        };
        let pipelines = match self.pipelines.take() {
            Some(pipelines) if pipelines.specialized == specialized => pipelines,
            _ => Pipelines::new(gpu, specialized, &self.trace_options)?,
        };
        let compilation = start.elapsed();

        let scene = SceneBuffers::new(gpu, scene)?;
        let waiting = WaitingRoom::new(gpu)?;
        let device_tree = DeviceTree::new(gpu, self.name, &pipelines.layouts, &tree, &waiting)?;
        let report = BuildReport {
            structure,
            pipelines: compilation,
            upload_bytes: scene.bytes() + device_tree.bytes(),
            device_bytes: scene.bytes() + device_tree.bytes(),
            facts: vec![
                ("nodes", tree.nodes().len() as f64),
                ("leaves", tree.leaf_count() as f64),
                ("list_entries", tree.lists().len() as f64),
            ],
        };
        self.pipelines = Some(pipelines);
        self.built = Some(Built { scene, tree: device_tree, waiting });
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let targets = frame.targets();
        let bind = |pass: &mut wgpu::ComputePass<'_>| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, built.scene.bind_group(), &[]);
            pass.set_bind_group(2, built.tree.bind_group(), &[]);
        };

        built.waiting.clear(frame.encoder());
        let (columns, rows) = (frame.view().width().div_ceil(8), frame.view().height().div_ceil(8));
        frame.compute("trace", |pass| {
            pass.set_pipeline(&pipelines.trace);
            bind(pass);
            pass.dispatch_workgroups(columns, rows, 1);
        });
        built.waiting.count(frame.encoder());
        for _ in 0..self.resumes {
            frame.compute("resume", |pass| {
                pass.set_pipeline(&pipelines.resume);
                bind(pass);
                pass.dispatch_workgroups_indirect(built.waiting.arguments(), 0);
            });
        }
        Ok(())
    }

    fn frame_bytes(&self) -> u64 {
        self.built.as_ref().map_or(0, |built| built.waiting.bytes())
    }

    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &mut self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let slots = status.needed[0];
        if slots > built.waiting.slots() {
            built.waiting = WaitingRoom::with_slots(gpu, slots)?;
            built.tree.rebind(gpu, &pipelines.layouts, &built.waiting);
        } else {
            self.resumes = self.resumes.saturating_mul(2);
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use metaball_shaders::{KernelModule, Variant, compose, host_layout, struct_layout};

    use super::waiting::{PoolHead, Suspended};
    use crate::{Leaf, Node};

    #[test]
    fn host_structs_are_their_wgsl_twins() {
        for leaf_test in [&["fbvh/leaf"], &["fbvh/certified_leaf"]] {
            let variant = Variant {
                kernel: KernelModule::Power,
                strengths: false,
                colors: false,
                counting: false,
                chosen: leaf_test,
            };
            let module = compose("fbvh/trace", &variant).expect("composes");
            let twin = |name| struct_layout(&module, name).expect("used by the shader");
            let node = host_layout!(Node {
                left_min,
                left,
                left_max,
                right,
                right_min,
                axis,
                right_max,
                first_right_leaf,
            });
            assert_eq!(node, twin("Node"));
            assert_eq!(host_layout!(Leaf { min, first, max, own }), twin("Leaf"));
            let suspended = host_layout!(Suspended {
                pixel,
                place,
                stage,
                next,
                low,
                low_value,
                high,
                high_value,
                iterations,
                best_t,
                best_leaf,
                best_status,
            });
            assert_eq!(suspended, twin("Suspended"));
            let head = host_layout!(PoolHead { groups, groups_y, groups_z, waiting });
            let pool = twin("Pool");
            assert_eq!(head.members[..], pool.members[..4]);
            assert_eq!(pool.members[4], ("slots".to_owned(), head.size));
        }
    }
}
