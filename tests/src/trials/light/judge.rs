//! Answers to free rays against the truth about each ray as it was sent: a start on the wrong side of a surface
//! shows as a ray that starts inside.

use libtest_mimic::Failed;
use metaball_core::RayQuery;
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Ray, Scene, Verdict};

use super::answers::Answered;

/// What was found among answers.
#[derive(Debug, Default)]
pub(super) struct Findings {
    pub(super) rays: usize,
    pub(super) hits: usize,
    pub(super) ambiguous: usize,
    pub(super) undecided: usize,
    pub(super) starts_inside: usize,
    pub(super) violations: Vec<String>,
}

/// Holds each answer against the truth.
pub(super) fn judge(scene: &Scene, answers: &[Answered]) -> Findings {
    let oracle = Oracle::new(scene);
    let mut findings = Findings { rays: answers.len(), ..Findings::default() };
    for Answered { ray, query, hit } in answers {
        findings.hits += usize::from(hit.is_hit());
        if hit.verdict == Verdict::Undecided {
            findings.undecided += 1;
            continue;
        }
        let wrong = match query {
            RayQuery::Exit => exit_is_wrong(&oracle, scene, ray, hit),
            RayQuery::FirstHit | RayQuery::AnyHit => {
                let truth = oracle.first_hit(ray);
                if truth.is_ambiguous() {
                    findings.ambiguous += 1;
                    continue;
                }
                findings.starts_inside += usize::from(truth.verdict == Verdict::Inside);
                let is_late = *query == RayQuery::FirstHit
                    && hit.is_hit()
                    && (f64::from(hit.t) - truth.t).abs() > 0.05 * f64::from(truth.smallest_radius);
                (hit.is_hit() != (truth.verdict != Verdict::Miss) || is_late)
                    .then(|| format!("needed {truth:?}"))
            }
        };
        if let Some(needed) = wrong {
            findings.violations.push(format!("{needed}, found {hit:?} of {query:?} {ray:?}"));
        }
    }
    findings
}

/// An exit is where the field falls below T: it is above on the way there, and below beyond. The oracle
/// finds the first sheet that a ray leaves.
fn exit_is_wrong(oracle: &Oracle<'_>, scene: &Scene, ray: &Ray, hit: &Hit) -> Option<String> {
    let truth = oracle.first_hit(ray);
    if truth.is_ambiguous() {
        return None;
    }
    let radius = scene.supports().iter().map(|ball| ball.radius).fold(f32::INFINITY, f32::min);
    let is_wrong = match truth.verdict {
        // Started outside: the space that is sought is there.
        Verdict::Miss | Verdict::Hit => hit.t != 0.0,
        _ => !hit.is_hit() || (f64::from(hit.t) - truth.exit).abs() > 0.05 * f64::from(radius),
    };
    is_wrong.then(|| format!("needed an exit at {} of {truth:?}", truth.exit))
}

impl Findings {
    /// No answer is wrong; fails with the first few that are.
    pub(super) fn pass(&self) -> Result<(), Failed> {
        let shown = self.violations.iter().take(5).cloned().collect::<Vec<_>>().join("\n  ");
        if !self.violations.is_empty() {
            let count = self.violations.len();
            return Err(format!("{count} of {} answers wrong\n  {shown}", self.rays).into());
        }
        Ok(())
    }

    /// There was something to test, and rounding spoilt one ray in a hundred at most: one of those that
    /// graze, which are the first to be ambiguous.
    pub(super) fn few_are_spoilt(&self) -> Result<(), Failed> {
        let spoilt = self.undecided + self.starts_inside;
        if self.rays < 10 || spoilt * 100 > self.rays {
            let Self { rays, hits, ambiguous, undecided, starts_inside, .. } = self;
            return Err(format!(
                "{rays} rays, {hits} hits, {ambiguous} ambiguous: {undecided} undecided and \
                 {starts_inside} on the wrong side"
            )
            .into());
        }
        Ok(())
    }
}
