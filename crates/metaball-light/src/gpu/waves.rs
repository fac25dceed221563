//! A sample as a sequence of waves: the method answers a batch of rays, and a pass takes the answers and makes
//! the next batch.

use metaball_core::RayQuery;
use metaball_core::gpu::{Frame, IsoRenderer, RayTracer, RenderError, Targets};

use super::buffers::Buffers;
use super::passes::Passes;
use crate::Effects;

/// What a sample is made with.
pub(crate) struct Waves<'a> {
    pub(crate) effects: &'a Effects,
    pub(crate) targets: &'a Targets,
    pub(crate) buffers: &'a Buffers,
    pub(crate) passes: &'a Passes,
    /// Shadow and occlusion rays of a surface point, at most.
    pub(crate) rays_per_surface: u32,
}

/// Whether the method answers every query of these effects.
pub(crate) fn is_followed_by(effects: &Effects, renderer: &mut dyn IsoRenderer) -> bool {
    let answers_all =
        |tracer: &mut dyn RayTracer| effects.queries().iter().all(|&query| tracer.answers(query));
    renderer.ray_tracer().is_some_and(answers_all)
}

impl Waves<'_> {
    /// Records a sample of any effects, whose every ray the method traces.
    pub(crate) fn encode(
        &self,
        renderer: &mut dyn IsoRenderer,
        frame: &mut Frame<'_>,
    ) -> Result<(), RenderError> {
        let method = renderer.name();
        let needed = self.effects.queries();
        let tracer = renderer.ray_tracer().ok_or_else(|| self.refusal(method))?;
        let Self { passes, buffers: Buffers { path_rays, shadow_rays, .. }, .. } = self;
        passes.encode_start(frame);
        for _ in 0..=self.effects.bounces {
            tracer.encode_answers(frame, path_rays, RayQuery::FirstHit)?;
            passes.encode_surface(frame, path_rays);
            if needed.contains(&RayQuery::Exit) {
                tracer.encode_answers(frame, path_rays, RayQuery::Exit)?;
                passes.encode_surface(frame, path_rays);
            }
            if needed.contains(&RayQuery::AnyHit) {
                for _ in 0..self.rays_per_surface {
                    tracer.encode_answers(frame, shadow_rays, RayQuery::AnyHit)?;
                    passes.encode_shadow(frame, shadow_rays);
                }
            }
        }
        Ok(())
    }

    /// Records a sample of effects that end at the first surface, which any method finds along the view's own
    /// rays.
    pub(crate) fn encode_first(
        &self,
        renderer: &mut dyn IsoRenderer,
        frame: &mut Frame<'_>,
    ) -> Result<(), RenderError> {
        if !self.effects.end_at_first_surface() {
            return Err(self.refusal(renderer.name()));
        }
        renderer.encode(frame)?;
        self.passes.encode_start(frame);
        let (targets, path_rays) = (self.targets, &self.buffers.path_rays);
        let hits = path_rays.hits();
        frame.encoder().copy_buffer_to_buffer(targets.hits(), 0, hits, 0, hits.size());
        if let (Some(found), Some(colors)) = (targets.colors(), path_rays.colors()) {
            frame.encoder().copy_buffer_to_buffer(found, 0, colors, 0, colors.size());
        }
        path_rays.encode_list(frame, RayQuery::FirstHit, "light start")?;
        self.passes.encode_surface(frame, path_rays);
        Ok(())
    }

    fn refusal(&self, method: &'static str) -> RenderError {
        let reason = format!(
            "needed answers to the ray queries {:?} of these effects; the method has none",
            self.effects.queries()
        );
        RenderError::Unsupported { method, reason }
    }
}
