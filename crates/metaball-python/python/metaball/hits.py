"""What rays meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from os import PathLike

import numpy as np
import numpy.typing as npt

from . import _metaball
from .arrays import floats


class Verdict(IntEnum):
    """Whether a ray meets the solid."""

    MISS = 0
    """The field stays below T along the whole ray."""
    HIT = 1
    """The field first reaches T at the hit's distance."""
    INSIDE = 2
    """The field is T or more where the ray starts."""
    UNDECIDED = 3
    """Arithmetic could not decide, not even in float64."""


@dataclass(frozen=True, eq=False)
class Hits:
    """What rays meet, in arrays of the rays' own shape; unpacks as `t, normals, verdicts = hits`."""

    t: npt.NDArray[np.float32]
    """Distance along the ray, in the particles' unit: +inf for a miss, `t_min` inside; shape (...)."""
    normals: npt.NDArray[np.float32]
    """Unit vectors out of the solid, against the field's gradient; 0 for a miss; shape (..., 3)."""
    verdicts: npt.NDArray[np.uint8]
    """Numbers of `Verdict`; shape (...)."""
    has_normals: bool = True
    """Whether the normals are known; where they are not, all are 0."""

    @classmethod
    def of(
        cls,
        t: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        verdicts: npt.ArrayLike | None = None,
    ) -> Hits:
        """Hits of any program, to be compared or saved.

        Parameters
        ----------
        t
            Distance along the unit ray, shape (...): +inf for a miss, NaN where the program could not tell.
        normals
            Unit normals out of the solid, shape (..., 3), or none.
        verdicts
            Numbers of `Verdict`, shape (...); where left out the distances say them.

        Raises
        ------
        ValueError
            When shapes do not fit one another.
        """
        distances = floats("t", t).astype(np.float32)
        shape = distances.shape
        if verdicts is None:
            of_misses = np.where(np.isinf(distances), Verdict.MISS, Verdict.HIT)
            numbers = np.where(np.isnan(distances), Verdict.UNDECIDED, of_misses)
        else:
            numbers = np.asarray(verdicts)
        vectors = np.zeros((*shape, 3)) if normals is None else floats("normals", normals)
        if numbers.shape != shape or vectors.shape != (*shape, 3):
            raise ValueError(
                f"hits: needed verdicts of shape {shape} and normals of {(*shape, 3)}, found "
                f"{numbers.shape} and {vectors.shape}"
            )
        narrow = vectors.astype(np.float32)
        return cls(distances, narrow, numbers.astype(np.uint8), normals is not None)

    def __iter__(self) -> Iterator[npt.NDArray[np.float32] | npt.NDArray[np.uint8]]:
        return iter((self.t, self.normals, self.verdicts))

    @property
    def shape(self) -> tuple[int, ...]:
        """That of the rays."""
        return self.t.shape

    @property
    def is_hit(self) -> npt.NDArray[np.bool_]:
        """Where there is a surface point: a hit, or a start inside; shape (...)."""
        return np.isin(self.verdicts, (Verdict.HIT, Verdict.INSIDE))

    def points(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The points that the rays hit, in the particles' coordinates; NaN for misses; shape (..., 3)."""
        t = np.where(self.is_hit, self.t.astype(np.float64), np.nan)[..., np.newaxis]
        along = floats("directions", directions).astype(np.float64)
        unit = along / np.linalg.norm(along, axis=-1, keepdims=True)
        at: npt.NDArray[np.float64] = floats("origins", origins) + t * unit
        return at

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the hits of a picture, of shape (height, width), as `.exr` or `.npy`.

        The file has the distance and the normal of each pixel; `metaball score` reads it.

        Raises
        ------
        ValueError
            When they are not those of a picture, or the ending is another.
        OSError
            When the file cannot be written.
        """
        if len(self.shape) != 2:
            raise ValueError(f"hits: needed those of a picture, (height, width), found {self.shape}")
        height, width = self.shape
        _metaball.save_hits(path, (width, height), self._columns())

    def _columns(self) -> _metaball.Columns:
        """One after the other."""
        return self.t.ravel(), self.normals.reshape(-1, 3), self.verdicts.ravel()

    @classmethod
    def _of(cls, columns: _metaball.Columns, shape: tuple[int, ...]) -> Hits:
        t, normals, verdicts = columns
        return cls(t.reshape(shape), normals.reshape(*shape, 3), verdicts.reshape(shape))
