//! Rays through a tree on the CPU.

mod batch;
mod certified;
mod clearance;
mod clipped;
mod counter;
mod error;
mod field_tree;
mod host_tracer;
mod published;
mod secant;
mod slabs;
mod traversal;

use metaball_core::{Hit, HostTracer, Ray, RayQuery, SurfaceHit, Verdict};

use self::certified::{Crossing, PacketScratch, Polynomials, Query, Scratch};
pub use self::clipped::{ClippedScratch, ClippedTracer};
pub use self::counter::{Counter, Work};
pub use self::error::TraceError;
use self::field_tree::FieldTree;
pub use self::host_tracer::TraceScratch;
use self::published::Published;
pub use self::secant::{Reading, SecantSearch};
use crate::{Field, Tree};

/// Traces rays through a tree on the CPU. Cheap to make; shares the tree and the field it was built
/// from.
///
/// In a certified tree with lists of 32 balls or more, batches of rays make it keep a polynomial for each
/// leaf that many of them meet: some 200 bytes, and 40 for each leaf of the tree. That changes no answer, and
/// rays that come later are faster, so a tracer is worth keeping as long as its tree.
///
/// In a certified tree every answer is right or [`Verdict::Undecided`]; in a published tree it is what
/// the paper's test finds, and rays that graze the surface may miss it.
///
/// ```
/// use fbvh::{Options, Tracer, Tree};
/// use metaball_core::{Kernel, Metaball, Ray, Scene, Verdict};
///
/// // The quartic (1 − r²/4)² of a ball of support radius 2 is ¼ at r = √2.
/// let scene = Scene::new([Metaball::new([0.0; 3].into(), 2.0)], Kernel::QUARTIC, 0.25)?;
/// let tree = Tree::build(&scene, &Options::certified())?;
/// let tracer = Tracer::new(&tree, &scene);
///
/// let toward = Ray::new([0.0, 0.0, -5.0].into(), [0.0, 0.0, 1.0].into());
/// assert_eq!(tracer.first_hit(&toward).t, 5.0 - 2f32.sqrt());
/// assert_eq!(tracer.any_hit(&toward), Verdict::Hit);
///
/// let outward = Ray::new([0.0; 3].into(), [0.0, 0.0, 1.0].into());
/// assert_eq!(tracer.first_exit(&outward)?.t, 2f32.sqrt());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Tracer<'a, F> {
    tree: FieldTree<'a, F>,
    search: Search,
}

/// How leaves are searched.
#[derive(Debug)]
enum Search {
    Published(SecantSearch),
    Certified,
}

impl<'a, F: Field> Tracer<'a, F> {
    /// A tracer for a tree and the very field that it was built from: with another field answers are
    /// wrong, and where it has fewer balls calls panic.
    ///
    /// Leaves of published trees are searched as [`SecantSearch::DEFAULT`] says;
    /// [`Tracer::with_search`] changes that.
    pub fn new(tree: &'a Tree, field: &'a F) -> Self {
        let search = if tree.kind.is_published() {
            Search::Published(SecantSearch::DEFAULT)
        } else {
            Search::Certified
        };
        Self { tree: FieldTree { tree, field, polynomials: Polynomials::default() }, search }
    }

    /// The same with other options for the leaves of a published tree.
    ///
    /// # Errors
    /// [`TraceError::SecantOfCertified`] when the tree is certified: it has no such options.
    pub fn with_search(self, search: SecantSearch) -> Result<Self, TraceError> {
        match self.search {
            Search::Published(_) => Ok(Self { search: Search::Published(search), ..self }),
            Search::Certified => Err(TraceError::SecantOfCertified { found: self.tree.tree.kind }),
        }
    }

    /// Where the ray first enters the solid: the smallest t at which the field is T or more.
    /// [`Verdict::Inside`], at t = `t_min`, when the ray starts there.
    pub fn first_hit(&self, ray: &Ray) -> Hit {
        self.first_hit_counting(ray, &mut ())
    }

    /// As [`Tracer::first_hit`], with a call of the counter for each step. With `()` for a counter
    /// nothing of that is compiled.
    pub fn first_hit_counting(&self, ray: &Ray, counter: &mut impl Counter) -> Hit {
        match &self.search {
            Search::Published(options) => self.published(options).hit(ray, counter).hit,
            Search::Certified => {
                let query = self.query(Crossing::Entry, false);
                self.tree.first_crossing(&query, ray, &mut Scratch::new(), counter).hit
            }
        }
    }

    /// First hits of many rays, in their order, on rayon's current pool. Fastest where neighbours in
    /// the slice are neighbours in space: through a certified tree rays go in packets of eight. Each
    /// hit is that of [`Tracer::first_hit`], to the last bit.
    pub fn first_hits(&self, rays: &[Ray]) -> Vec<Hit> {
        self.in_parallel(RayQuery::FirstHit, rays, |found| found.hit)
    }

    /// [`Tracer::first_hits`] of a picture's rays, which lie row by row, `width` to a row: through a
    /// certified tree they go in blocks of pixels, which are closer neighbours than rows.
    pub fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit> {
        match self.search {
            Search::Certified if width > 0 => {
                let query = self.query(Crossing::Entry, false);
                batch::in_blocks(rays, width, PacketScratch::new, |rays, scratch, answers| {
                    self.tree.first_crossings(&query, rays, scratch, answers);
                })
            }
            _ => self.first_hits(rays),
        }
    }

    /// Whether there is solid anywhere on the ray, as for shadow and occlusion rays:
    /// [`Verdict::Inside`] where the ray starts in it, [`Verdict::Hit`] where it reaches it. Ends at
    /// the first certainty, without searching for the root.
    ///
    /// In a published tree the paper's bracket decides: it ends at a point inside.
    pub fn any_hit(&self, ray: &Ray) -> Verdict {
        match &self.search {
            Search::Published(options) => self.published(options).any(ray).hit.verdict,
            Search::Certified => {
                let query = self.query(Crossing::Entry, true);
                self.tree.first_crossing(&query, ray, &mut Scratch::new(), &mut ()).hit.verdict
            }
        }
    }

    /// [`Tracer::any_hit`] of many rays, in their order, on rayon's current pool.
    pub fn any_hits(&self, rays: &[Ray]) -> Vec<Verdict> {
        self.in_parallel(RayQuery::AnyHit, rays, |found| found.hit.verdict)
    }

    /// Where a ray that starts inside first leaves the solid: the smallest t at which the field falls
    /// below T, with the normal out of the solid.
    ///
    /// The convention is that of the shaders, `RayQuery::Exit` of `metaball_core::gpu`: a ray that
    /// starts outside is at its exit already, [`Verdict::Inside`] the space beyond the solid at t = `t_min`;
    /// [`Verdict::Miss`] is a ray that ends inside.
    ///
    /// # Errors
    /// [`TraceError::ExitOfPublished`] when the tree is not certified: the paper's test is for rays
    /// that start outside.
    pub fn first_exit(&self, ray: &Ray) -> Result<Hit, TraceError> {
        self.check_exits()?;
        let query = self.query(Crossing::Exit, false);
        Ok(self.tree.first_exit(&query, ray, &mut Scratch::new()).hit)
    }

    /// [`Tracer::first_exit`] of many rays, in their order, on rayon's current pool.
    ///
    /// # Errors
    /// As [`Tracer::first_exit`].
    pub fn first_exits(&self, rays: &[Ray]) -> Result<Vec<Hit>, TraceError> {
        self.check_exits()?;
        Ok(self.in_parallel(RayQuery::Exit, rays, |found| found.hit))
    }

    fn check_exits(&self) -> Result<(), TraceError> {
        match self.search {
            Search::Published(_) => Err(TraceError::ExitOfPublished { found: self.tree.tree.kind }),
            Search::Certified => Ok(()),
        }
    }

    fn published<'b>(&'b self, options: &'b SecantSearch) -> Published<'b, F> {
        Published { tree: &self.tree, options }
    }

    fn query(&self, crossing: Crossing, any: bool) -> Query {
        let field = self.tree.field;
        Query { kernel: field.kernel(), threshold: f64::from(field.threshold()), crossing, any }
    }

    /// Answers of many rays, in their order.
    fn in_parallel<T: Copy + Send + Sync>(
        &self,
        query: RayQuery,
        rays: &[Ray],
        read: impl Fn(&SurfaceHit) -> T + Sync,
    ) -> Vec<T> {
        let scratch = || (self.scratch(), Vec::new());
        batch::in_runs(rays, read(&SurfaceHit::MISS), scratch, |rays, (scratch, found), answers| {
            found.resize(rays.len(), SurfaceHit::MISS);
            self.answer(query, rays, scratch, found);
            for (answer, found) in answers.iter_mut().zip(found) {
                *answer = read(found);
            }
        })
    }
}
