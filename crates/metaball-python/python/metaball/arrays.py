"""Arrays as the native part takes them: float32 or float64, of a known shape, copied only where they must be."""

from __future__ import annotations

from typing import TypeAlias, cast

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float32] | npt.NDArray[np.float64]
"""Numbers that are taken as they are, whatever their strides."""


def floats(name: str, values: npt.ArrayLike) -> Floats:
    """The values as float32 or float64: the same memory where they are that already."""
    array = np.asarray(values)
    if array.dtype in (np.float32, np.float64):
        return array if array.dtype.isnative else array.astype(array.dtype.newbyteorder("="))
    if not (np.issubdtype(array.dtype, np.integer) or np.issubdtype(array.dtype, np.floating)):
        raise ValueError(f"{name}: needed numbers, found {array.dtype}")
    return array.astype(np.float64)


def points(name: str, values: npt.ArrayLike) -> Floats:
    """Points of shape (..., 3) as an array of shape (n, 3)."""
    array = floats(name, values)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name}: needed an array of shape (..., 3), found {array.shape}")
    return array if array.ndim == 2 else array.reshape(-1, 3)


def spread(array: Floats, shape: tuple[int, ...]) -> Floats:
    """The array as if it had another shape, not copied."""
    return cast(Floats, np.broadcast_to(array, shape))
