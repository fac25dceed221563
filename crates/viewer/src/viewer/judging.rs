//! The picture held against the reference.

use super::Viewer;
use crate::judge::{Judging, Verdicts};
use crate::painter::Stage;

impl Viewer {
    /// Whether the latest picture can be judged: it is sharp, and of the whole solid, since the
    /// reference knows no cuts.
    pub fn can_be_judged(&self) -> bool {
        let is_sharp = |stage| stage != Stage::Coarse;
        self.look.clip.is_all() && self.painting.as_ref().is_some_and(|it| is_sharp(it.stage))
    }

    /// Holds its rays against the reference, beside all else.
    pub fn judge(&mut self) {
        let Some(painting) = self.painting.as_ref().filter(|_| self.can_be_judged()) else {
            return;
        };
        let (view, hits) = (painting.view.clone(), painting.shown.hits.clone());
        let rays = (painting.model.clone(), view, hits);
        self.judging = Some(Judging::new(self.sights, rays, self.judged.post.clone()));
    }

    /// Ends that, and forgets what has been found.
    pub fn forget_verdicts(&mut self) {
        self.judging = None;
    }

    /// What has been found of the picture that is shown.
    pub fn verdicts(&self) -> Option<&Verdicts> {
        Some(&self.judging.as_ref()?.verdicts)
    }

    pub(super) fn take_judged(&mut self) {
        while let Ok(judged) = self.judged.reports.try_recv() {
            if let Some(judging) = self.judging.as_mut().filter(|it| it.picture == judged.picture) {
                judging.verdicts.add(judged.judgements);
            }
        }
    }

    /// A picture of other rays has come: what was found of the last one does not hold for it.
    pub(super) fn see_other(&mut self) {
        self.sights += 1;
        self.judging = None;
    }
}
