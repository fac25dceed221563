//! Rays from anywhere, as effects of light trace them, against the oracle; and pictures made of them.

mod answers;
mod canaries;
mod effects;
mod free_rays;
mod host;
mod judge;
mod pictures;

use libtest_mimic::Trial;

/// The method that answers every ray and promises that no answer is wrong.
const CERTIFIED: &str = "fbvh-certified";

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = effects::trials();
    trials.extend(free_rays::trials());
    trials.extend(host::trials());
    trials.extend(pictures::trials());
    trials.extend(canaries::trials());
    trials
}
