//! Wrong answers that the judge must reject, and the wrong side of the surface where it must be found.

use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Ray, Verdict};

use super::CERTIFIED;
use super::effects::{Effect, last_rays};
use super::judge::judge;
use crate::trials::{draw, load, on_gpu, renderer, view_of};

pub(super) fn trials() -> Vec<Trial> {
    vec![
        on_gpu("light::canary::wrong_answers".to_owned(), wrong_answers_are_rejected),
        on_gpu("light::canary::starts_on_the_surface".to_owned(), clearance_is_needed),
    ]
}

/// Each ray has the answer of the one before it.
fn wrong_answers_are_rejected(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("random-200")?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    for effect in [Effect::Shadow, Effect::Reflection { level: 1 }, Effect::Refraction { level: 1 }]
    {
        let mut answers = last_rays(gpu, CERTIFIED, scene, &view, effect)?;
        let mut carried = answers.last().ok_or("no rays")?.hit;
        for one in &mut answers {
            std::mem::swap(&mut one.hit, &mut carried);
        }
        if judge(scene, &answers).pass().is_ok() {
            return Err(format!("{effect:?}: answers to other rays passed").into());
        }
    }
    Ok(())
}

/// Started at the hit itself, as many rays begin on the wrong side as on the right one.
fn clearance_is_needed(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("random-200")?;
    let (scene, view) = (&bench.scene, view_of(&bench)?);
    let picture = draw(gpu, &mut renderer(CERTIFIED)?, scene, &view)?;
    let found = picture.rays.iter().zip(&picture.hits).filter(|(_, hit)| hit.is_hit());
    let oracle = Oracle::new(scene);
    let starts: Vec<_> =
        found.map(|(ray, hit)| Ray::new(ray.origin + hit.t * ray.direction, hit.normal)).collect();
    let inside = oracle.first_hits(&starts);
    let inside = inside.iter().filter(|truth| truth.verdict == Verdict::Inside).count();
    if inside * 10 < starts.len() {
        return Err(format!("{inside} of {} starts inside: clearance is idle", starts.len()).into());
    }
    Ok(())
}
