//! The trees traced on the GPU, behind [`IsoRenderer`].
//!
//! # Theory
//! The tree is built on the host and uploaded as it is ([`Node`](crate::Node),
//! [`Leaf`](crate::Leaf) and lists of indices). One invocation traces one ray as the CPU's
//! [`Tracer`](crate::Tracer) does: leaves of published trees by the intersection test of Gourmel et al.
//! 2010, section 3, those of certified trees by bounds that no root escapes.
//!
//! # Changes versus the paper
//! *Rays can be suspended.* The leaf test is quadratic, and software Vulkan silently ends the loops of
//! eight invocations after 65,535 iterations in all; a watchdog may do worse. So an invocation counts
//! its own iterations, and past a budget stores the state of its ray; the next dispatch resumes it. A
//! frame begins with one dispatch over all rays, label `trace`, and continues with indirect ones over
//! the suspended rays, label `resume`. A frame that ends with suspended rays, or whose pool overflowed,
//! is incomplete; [`IsoRenderer::grow`] adds capacity or dispatches. Hence no ray is ever cut short, and
//! a sparse scene costs a few empty dispatches.
//!
//! *The stack cannot overflow*: the builder bounds the depth by the size of the shader's stack.
//!
//! # Secondary rays
//! Free rays ([`RayTracer`]) run through the same shader; `shaders/wgsl/ray/free.wgsl` hands them out,
//! and `shaders/wgsl/fbvh/excess/exit.wgsl` replaces `shaders/wgsl/fbvh/excess/entry.wgsl` where the exit
//! from the solid is sought. How far from a hit they start is derived in `crates/fbvh/src/trace/clearance.rs`; an
//! answer carries it ([`PackedHit::clearance`](metaball_core::PackedHit::clearance)).
//!
//! # Practice
//! Pipelines are compiled at the first build and again only when a scene needs other ones: another
//! kernel, strengths or colours where there were none.

mod pipelines;
mod suspended;
mod tree_buffers;

use std::time::Instant;

use metaball_core::gpu::{
    BuildReport, Frame, FrameStatus, Gpu, IsoRenderer, RayBatch, RayTracer, RenderError,
    SceneBuffers, Specialization,
};
use metaball_core::{RayQuery, Scene};

use self::pipelines::{Pipelines, Specialized, TracePipelines};
use self::suspended::SuspendedPool;
use self::tree_buffers::TreeBuffers;
use crate::{Options, SecantSearch, TraceError, Tree};

/// Dispatches after the first that a frame has until it grows.
const FIRST_RESUMES: u32 = 4;

/// Dispatches after which a frame is given up as incomplete: seconds even if they were empty.
const MOST_RESUMES: u32 = 1 << 16;

/// Draws primary rays through a tree of the scene, and answers queries of free rays.
pub struct Renderer {
    name: &'static str,
    options: Options,
    /// How leaves of a published tree are searched.
    search: Option<SecantSearch>,
    counting: bool,
    resumes: u32,
    pipelines: Option<Pipelines>,
    built: Option<Built>,
}

/// What depends on the scene.
struct Built {
    scene: SceneBuffers,
    tree: TreeBuffers,
    suspended: SuspendedPool,
}

impl Renderer {
    /// A renderer without a scene, with a name for reports and errors. `counting` makes shaders that
    /// count their work, which costs time.
    ///
    /// Leaves of published trees are searched as [`SecantSearch::DEFAULT`] says;
    /// [`Renderer::with_search`] changes that.
    pub fn new(name: &'static str, options: Options, counting: bool) -> Self {
        Self {
            name,
            options,
            search: options.kind().is_published().then_some(SecantSearch::DEFAULT),
            counting,
            resumes: FIRST_RESUMES,
            pipelines: None,
            built: None,
        }
    }

    /// The same with other options for the leaves of a published tree. Pipelines are compiled anew.
    ///
    /// # Errors
    /// [`TraceError::SecantOfCertified`] when the tree is certified: it has no such options.
    pub fn with_search(self, search: SecantSearch) -> Result<Self, TraceError> {
        if self.search.is_none() {
            return Err(TraceError::SecantOfCertified { found: self.options.kind() });
        }
        Ok(Self { search: Some(search), pipelines: None, built: None, ..self })
    }

    fn check(&self, query: RayQuery) -> Result<(), TraceError> {
        match self.options.kind() {
            found if query == RayQuery::Exit && found.is_published() => {
                Err(TraceError::ExitOfPublished { found })
            }
            _ => Ok(()),
        }
    }
}

impl IsoRenderer for Renderer {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError> {
        self.built = None;
        RenderError::check_positive(self.name, scene)?;
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
            _ => Pipelines::new(gpu, specialized, self.search)?,
        };
        let compilation = start.elapsed();

        let scene = SceneBuffers::new(gpu, scene)?;
        let suspended = SuspendedPool::new(gpu)?;
        let buffers = TreeBuffers::new(gpu, self.name, &pipelines.layouts, &tree, &suspended)?;
        let report = BuildReport {
            structure,
            pipelines: compilation,
            upload_bytes: scene.bytes() + buffers.bytes(),
            device_bytes: scene.bytes() + buffers.bytes(),
            facts: vec![
                ("nodes", tree.nodes().len() as f64),
                ("leaves", tree.leaf_count() as f64),
                ("list_entries", tree.lists().len() as f64),
            ],
        };
        self.pipelines = Some(pipelines);
        self.built = Some(Built { scene, tree: buffers, suspended });
        Ok(report)
    }

    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let labels = ("trace", "resume");
        record(frame, built, &pipelines.primary, &Rays::OfView, labels, self.resumes);
        Ok(())
    }

    fn frame_bytes(&self) -> u64 {
        self.built.as_ref().map_or(0, |built| built.suspended.bytes())
    }

    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let (Some(pipelines), Some(built)) = (&self.pipelines, &mut self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let capacity = status.needed[0];
        if capacity > built.suspended.capacity() {
            built.suspended = SuspendedPool::with_capacity(gpu, capacity)?;
            built.tree.rebind(gpu, &pipelines.layouts, &built.suspended);
            return Ok(true);
        }
        let can_grow = self.resumes < MOST_RESUMES;
        self.resumes = (2 * self.resumes).min(MOST_RESUMES);
        Ok(can_grow)
    }

    fn ray_tracer(&mut self) -> Option<&mut dyn RayTracer> {
        Some(self)
    }
}

impl RayTracer for Renderer {
    fn answers(&self, query: RayQuery) -> bool {
        self.check(query).is_ok()
    }

    fn encode_answers(
        &mut self,
        frame: &mut Frame<'_>,
        batch: &RayBatch,
        query: RayQuery,
    ) -> Result<(), RenderError> {
        self.check(query).map_err(|error| RenderError::Unsupported {
            method: self.name,
            reason: error.to_string(),
        })?;
        let (Some(pipelines), Some(built)) = (&mut self.pipelines, &self.built) else {
            return Err(RenderError::NotBuilt { method: self.name });
        };
        let answering = pipelines.answering(frame.gpu(), query)?;
        let labels = match query {
            RayQuery::FirstHit => ("first hits", "resume first hits"),
            RayQuery::AnyHit => ("any hits", "resume any hits"),
            RayQuery::Exit => ("exits", "resume exits"),
        };
        batch.encode_list(frame, query, labels.0)?;
        record(frame, built, answering, &Rays::Listed(batch), labels, self.resumes);
        Ok(())
    }
}

/// Which rays are traced.
enum Rays<'a> {
    /// One a pixel.
    OfView,
    /// Those on the list of a batch.
    Listed(&'a RayBatch),
}

/// One dispatch over all rays, and indirect ones over those that are suspended.
fn record(
    frame: &mut Frame<'_>,
    built: &Built,
    pipelines: &TracePipelines,
    rays: &Rays<'_>,
    (first, next): (&'static str, &'static str),
    resumes: u32,
) {
    let group = match rays {
        Rays::OfView => frame.targets().bind_group(),
        Rays::Listed(batch) => batch.bind_group(),
    };
    let bind = |pass: &mut wgpu::ComputePass<'_>| {
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, built.scene.bind_group(), &[]);
        pass.set_bind_group(2, built.tree.bind_group(), &[]);
    };
    built.suspended.clear(frame.encoder());
    let (across, down) = frame.targets().workgroups();
    frame.compute(first, |pass| {
        pass.set_pipeline(&pipelines.trace);
        bind(pass);
        match rays {
            Rays::OfView => pass.dispatch_workgroups(across, down, 1),
            Rays::Listed(batch) => batch.list().dispatch(pass),
        }
    });
    built.suspended.count(frame.encoder());
    for _ in 0..resumes {
        frame.compute(next, |pass| {
            pass.set_pipeline(&pipelines.resume);
            bind(pass);
            pass.dispatch_workgroups_indirect(built.suspended.arguments(), 0);
        });
    }
}

#[cfg(test)]
mod tests {
    use metaball_shaders::{KernelModule, Variant, compose, host_layout, struct_layout};

    use super::suspended::{PoolHead, Suspended};
    use crate::{Leaf, Node};

    #[test]
    fn host_structs_are_their_wgsl_twins() {
        let choices: [&[&str]; 2] = [
            &["ray/primary", "fbvh/leaf/published"],
            &["ray/free", "fbvh/leaf/certified", "fbvh/excess/exit", "fbvh/polynomial_test/none"],
        ];
        for chosen in choices {
            let variant = Variant {
                kernel: KernelModule::Power,
                radii: false,
                strengths: false,
                colors: false,
                counting: false,
                chosen,
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
                reference,
                search,
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
