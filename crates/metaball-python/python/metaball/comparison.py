"""Hits of anyone, held against the exact reference."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt


class Finding(IntEnum):
    """What a ray's hit is against the truth; a start inside counts as a hit."""

    MISS = 0
    """Both miss."""
    HIT = 1
    """Both hit; the error says how far apart."""
    FALSE_NEGATIVE = 2
    """The ray hits, and was called a miss."""
    FALSE_POSITIVE = 3
    """The ray misses, and was called a hit."""
    UNDECIDED = 4
    """It was left undecided."""


@dataclass(frozen=True, eq=False)
class Truth:
    """The truth along rays, in float64: the roots of the field's polynomial, isolated."""

    t: npt.NDArray[np.float64]
    """Distance along the ray, in the particles' unit: +inf for a miss, `t_min` inside; shape (...)."""
    normals: npt.NDArray[np.float64]
    """Unit vectors out of the solid; 0 for a miss, and where the gradient vanishes; shape (..., 3)."""
    verdicts: npt.NDArray[np.uint8]
    """Numbers of `Verdict`, never UNDECIDED; shape (...)."""
    margins: npt.NDArray[np.float64]
    """The least share of T by which a field raised or lowered has another first hit; shape (...)."""


@dataclass(frozen=True)
class Score:
    """How far hits are from the truth; numbers are of the rays that were compared."""

    rays: int
    """Rays compared."""
    true_hits: int
    """Rays that hit, or start inside, in truth."""
    false_negative: int
    """Clear rays that hit and were called a miss."""
    false_positive: int
    """Clear rays that miss and were called a hit."""
    wrong_front: int
    """Clear rays that both hit, more than 0.05 support radii apart."""
    ambiguous: int
    """Rays too close to call in float32; in none of the three above."""
    rel_rms_t: float | None
    """Root of the mean square of the relative error of t, where both hit; `None` where none does."""
    t_error_over_radius: tuple[float, float, float] | None
    """Median, 99th percentile and greatest error of t, in the smallest support radius at the hit."""
    normal_degrees: tuple[float, float, float] | None
    """Mean, 99th percentile and greatest angle to the true normal; `None` without normals."""

    @property
    def wrong(self) -> int:
        """False negatives, false positives and wrong fronts together."""
        return self.false_negative + self.false_positive + self.wrong_front


@dataclass(frozen=True, eq=False)
class Comparison:
    """What became of each ray, in arrays of the rays' shape, and the score of all."""

    findings: npt.NDArray[np.uint8]
    """Numbers of `Finding`."""
    errors: npt.NDArray[np.float64]
    """|t − t*| over the smallest support radius at the true hit; NaN where not both hit."""
    ambiguous: npt.NDArray[np.bool_]
    """Where the truth itself is too close to call in float32."""
    wrong: npt.NDArray[np.bool_]
    """Where the verdict is wrong, and the ray clear enough to say so."""
    score: Score
    """All of it in numbers."""
