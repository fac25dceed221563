//! What a method's result at one value of a case amounts to.

use serde::{Deserialize, Serialize};

/// From good to bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Every clear ray is right, and 99 of 100 hits lie within the method's tolerance.
    Right,
    /// Every clear ray is on the right front, but more than one hit in 100 lies beyond the tolerance.
    Coarse,
    /// Not run, with the reason: nothing is known.
    Untried,
    /// Not every ray has an answer, and the method reports it: by marks on the pixels, or by a refusal
    /// with its reason.
    #[serde(alias = "told")]
    Reported,
    /// Some rays are wrong and not marked, all of them where the method's paper promises nothing.
    #[serde(alias = "lost")]
    SilentlyWrong,
    /// Some rays are wrong and not marked where the method promises to be right.
    Broken,
}

impl Outcome {
    /// All, from good to bad.
    pub const ALL: [Self; 6] = [
        Self::Right,
        Self::Coarse,
        Self::Untried,
        Self::Reported,
        Self::SilentlyWrong,
        Self::Broken,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Coarse => "coarse",
            Self::Untried => "untried",
            Self::Reported => "reported",
            Self::SilentlyWrong => "silently wrong",
            Self::Broken => "broken",
        }
    }
}
