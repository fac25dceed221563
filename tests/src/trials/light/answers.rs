//! Free rays and their answers.

use libtest_mimic::Failed;
use metaball_core::RayQuery;
use metaball_core::gpu::{FreeRay, Gpu, RayBatch, RenderError, Targets, render_with};
use metaball_core::{Hit, Ray, Scene, View};

use super::CERTIFIED;
use crate::trials::on_adapter;

/// A free ray with its query, and the answer.
pub(super) struct Answered {
    pub(super) ray: Ray,
    pub(super) query: RayQuery,
    pub(super) hit: Hit,
}

/// The rays of a batch that had a query.
pub(super) fn answers(gpu: &Gpu, batch: &RayBatch) -> Result<Vec<Answered>, Failed> {
    let (rays, hits) = (batch.read_rays(gpu)?, batch.read_hits(gpu)?);
    let answered =
        |(ray, hit): (FreeRay, Hit)| Some(Answered { ray: ray.ray(), query: ray.query()?, hit });
    Ok(rays.into_iter().zip(hits).filter_map(answered).collect())
}

/// The certified tree's answers to rays of the host's own.
pub(super) fn trace(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    rays: &[FreeRay],
) -> Result<Vec<Answered>, Failed> {
    let mut renderer = on_adapter(CERTIFIED)?;
    renderer.build(gpu, scene)?;
    let targets = Targets::new(gpu, view.width(), view.height(), false, false)?;
    let batch = RayBatch::new(gpu, &targets)?;
    batch.write_rays(gpu, rays)?;
    render_with(gpu, renderer.as_mut(), &targets, view, |renderer, frame| {
        let name = renderer.name();
        let reason = "needed a tracer of any ray, found none".to_owned();
        let none = RenderError::Unsupported { method: name, reason };
        let tracer = renderer.ray_tracer().ok_or(none)?;
        RayQuery::ALL.iter().try_for_each(|&query| tracer.encode_answers(frame, &batch, query))
    })?;
    answers(gpu, &batch)
}
