//! Rays through a solid that is cut to a region.

mod host_tracer;

use std::borrow::Cow;

use metaball_core::{Clip, Hit, Ray, Verdict};
use rayon::prelude::*;

pub use self::host_tracer::ClippedScratch;
use super::{TraceError, Tracer};
use crate::Field;

/// A [`Tracer`] of the solid that a [`Clip`] leaves of the tree's: cut faces are filled, and hits on them
/// have the face's normal. Every query is as the tracer has it; what is found is as certain.
///
/// ```
/// use fbvh::{ClippedTracer, Options, Tracer, Tree};
/// use metaball_core::{Clip, Kernel, Metaball, Ray, Scene, Verdict};
///
/// let scene = Scene::new([Metaball::new([0.0; 3].into(), 2.0)], Kernel::QUARTIC, 0.25)?;
/// let tree = Tree::build(&scene, &Options::certified())?;
/// let front = Clip::default().and_plane([0.0, 0.0, -1.0].into(), 0.5)?;
/// let tracer = ClippedTracer::new(Tracer::new(&tree, &scene), front)?;
///
/// // z ≥ −0.5 is kept of a ball whose surface has the radius √2.
/// let toward = |x| Ray::new([x, 0.0, -5.0].into(), [0.0, 0.0, 1.0].into());
/// let hit = tracer.first_hit(&toward(0.0));
/// assert_eq!((hit.verdict, hit.t, hit.normal), (Verdict::Hit, 4.5, [0.0, 0.0, -1.0].into()));
/// assert_eq!(tracer.any_hit(&toward(1.4)), Verdict::Hit);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct ClippedTracer<'a, F> {
    tracer: Tracer<'a, F>,
    clip: Clip,
}

impl<'a, F: Field> ClippedTracer<'a, F> {
    /// Cuts the tracer's solid. A region that is all of space costs nothing.
    ///
    /// # Errors
    /// [`TraceError::ClipOfPublished`] when something is cut and the tree is not certified.
    pub fn new(tracer: Tracer<'a, F>, clip: Clip) -> Result<Self, TraceError> {
        let found = tracer.tree.tree.kind;
        if found.is_published() && !clip.is_all() {
            return Err(TraceError::ClipOfPublished { found });
        }
        Ok(Self { tracer, clip })
    }

    /// [`Tracer::first_hit`] of the cut solid. [`Verdict::Inside`] when the ray starts in that; on a cut
    /// face it is a hit.
    pub fn first_hit(&self, ray: &Ray) -> Hit {
        let section = self.clip.section(ray);
        section.first_hit(self.tracer.first_hit(&section.ray))
    }

    /// [`Tracer::first_hits`] of the cut solid.
    pub fn first_hits(&self, rays: &[Ray]) -> Vec<Hit> {
        let hits = self.tracer.first_hits(&self.sections(rays));
        self.closed(rays, hits)
    }

    /// [`Tracer::picture_hits`] of the cut solid.
    pub fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit> {
        let hits = self.tracer.picture_hits(&self.sections(rays), width);
        self.closed(rays, hits)
    }

    /// [`Tracer::any_hit`] of the cut solid.
    pub fn any_hit(&self, ray: &Ray) -> Verdict {
        let section = self.clip.section(ray);
        section.any_hit(self.tracer.any_hit(&section.ray))
    }

    /// [`Tracer::any_hits`] of the cut solid.
    pub fn any_hits(&self, rays: &[Ray]) -> Vec<Verdict> {
        let found = self.tracer.any_hits(&self.sections(rays));
        self.each(rays, found, |ray, found| self.clip.section(ray).any_hit(found))
    }

    /// [`Tracer::first_exit`] of the cut solid: out of it by the surface or by a face, whichever is first.
    ///
    /// # Errors
    /// As [`Tracer::first_exit`].
    pub fn first_exit(&self, ray: &Ray) -> Result<Hit, TraceError> {
        let section = self.clip.section(ray);
        Ok(section.first_exit(ray, self.tracer.first_exit(&section.ray)?))
    }

    /// [`Tracer::first_exits`] of the cut solid.
    ///
    /// # Errors
    /// As [`Tracer::first_exit`].
    pub fn first_exits(&self, rays: &[Ray]) -> Result<Vec<Hit>, TraceError> {
        let found = self.tracer.first_exits(&self.sections(rays))?;
        Ok(self.each(rays, found, |ray, found| self.clip.section(ray).first_exit(ray, found)))
    }

    /// The rays' parts in the region.
    fn sections<'b>(&self, rays: &'b [Ray]) -> Cow<'b, [Ray]> {
        if self.clip.is_all() {
            return Cow::Borrowed(rays);
        }
        Cow::Owned(rays.par_iter().map(|ray| self.clip.section(ray).ray).collect())
    }

    /// First hits of sections as hits of the cut solid.
    fn closed(&self, rays: &[Ray], hits: Vec<Hit>) -> Vec<Hit> {
        self.each(rays, hits, |ray, hit| match hit.verdict {
            Verdict::Inside => self.clip.section(ray).first_hit(hit),
            _ => hit,
        })
    }

    /// What is found along sections, made an answer about the cut solid where something is cut.
    fn each<T: Copy + Send + Sync>(
        &self,
        rays: &[Ray],
        mut found: Vec<T>,
        answer: impl Fn(&Ray, T) -> T + Sync,
    ) -> Vec<T> {
        if !self.clip.is_all() {
            let answers = found.par_iter_mut().zip(rays);
            answers.for_each(|(found, ray)| *found = answer(ray, *found));
        }
        found
    }
}
