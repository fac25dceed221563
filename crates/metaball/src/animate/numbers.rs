//! Which frames a run draws.

use std::ops::Range;

use particle_files::AnimatedScene;

use super::AnimateOptions;
use crate::Error;

/// The numbers of a run's frames.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Numbers {
    /// Those that the scene has, rising; at least one.
    pub(super) present: Vec<u32>,
    /// Those that it has not: the first and the last of each row of them.
    pub(super) absent: Vec<[u32; 2]>,
    /// From one number that is wanted to the next.
    step: u32,
    /// Whether a range was asked for.
    asked: bool,
}

impl Numbers {
    /// Of the range that was asked for every so manyth number is wanted; without one every so manyth of the
    /// frames that there are, and all that miss between the first and the last are absent.
    pub(super) fn of(scene: &dyn AnimatedScene, options: &AnimateOptions) -> Result<Self, Error> {
        let every = options.every.max(1);
        let range = options.frames.clone().unwrap_or(scene.frames());
        let mut present = scene.present(range.clone()).map_err(Error::Frames)?;
        let asked = options.frames.is_some();
        let (step, absent) = if asked {
            present.retain(|number| (number - range.start).is_multiple_of(every));
            (every, gaps(&range, every, &present))
        } else {
            let absent = gaps(&range, 1, &present);
            present = present.into_iter().step_by(every as usize).collect();
            (1, absent)
        };
        if present.is_empty() {
            let (scene, frames) = (scene.name().to_owned(), scene.frames());
            return Err(Error::NoFrames { scene, range, frames });
        }
        Ok(Self { present, absent, step, asked })
    }

    /// How many are absent.
    pub(super) fn absent_count(&self) -> usize {
        let count = |[first, last]: &[u32; 2]| 1 + ((last - first) / self.step) as usize;
        self.absent.iter().map(count).sum()
    }

    /// Whether none is absent that was asked for.
    pub(super) fn has_all(&self) -> bool {
        !self.asked || self.absent.is_empty()
    }
}

/// The numbers of a range, every `step`th from its first on, that are not among those present, which are
/// such numbers and rise: first and last of each row.
fn gaps(range: &Range<u32>, step: u32, present: &[u32]) -> Vec<[u32; 2]> {
    let (start, step) = (u64::from(range.start), u64::from(step));
    let end = start + (range.len() as u64).div_ceil(step) * step;
    let mut next = start;
    let mut gaps = Vec::new();
    for number in present.iter().copied().map(u64::from).chain([end]) {
        if number > next {
            // Both are in the range.
            gaps.push([next as u32, (number - step) as u32]);
        }
        next = number + step;
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_lie_between_what_is_there() {
        assert_eq!(gaps(&(1..9), 1, &[1, 2, 3]), [[4, 8]]);
        assert_eq!(gaps(&(0..9), 1, &[1, 2, 5]), [[0, 0], [3, 4], [6, 8]]);
        assert_eq!(gaps(&(1..4), 1, &[1, 2, 3]), Vec::<[u32; 2]>::new());
        assert_eq!(gaps(&(0..100), 10, &[0, 10, 50]), [[20, 40], [60, 90]]);
        assert_eq!(gaps(&(0..4), 3, &[]), [[0, 3]]);
        let all = 0..u32::MAX;
        assert_eq!(gaps(&all, 1, &[7]), [[0, 6], [8, u32::MAX - 1]]);
        assert_eq!(gaps(&all, u32::MAX, &[0]), Vec::<[u32; 2]>::new());
    }
}
