"""Pictures."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np
import numpy.typing as npt

from . import _metaball
from .hits import Hits


@dataclass(frozen=True, eq=False)
class Image:
    """A picture; a notebook shows it by itself."""

    pixels: npt.NDArray[np.uint8]
    """Eight bits a channel, sRGB and alpha, from the top left; shape (height, width, 4)."""
    hits: Hits
    """What the rays through the middles of the pixels meet; shape (height, width)."""
    light: npt.NDArray[np.float32] | None
    """Linear light, red, green and blue, where the picture is ray traced; shape (height, width, 3)."""

    @property
    def size(self) -> tuple[int, int]:
        """Pixels across and down."""
        height, width, _ = self.pixels.shape
        return width, height

    def numpy(self) -> npt.NDArray[np.uint8]:
        """The pixels, not copied: sRGB and alpha, shape (height, width, 4)."""
        return self.pixels

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        if copy:
            return np.array(self.pixels, dtype=dtype)
        if copy is False and dtype is not None and np.dtype(dtype) != self.pixels.dtype:
            raise ValueError(f"image: needed a dtype that needs no copy, uint8, found {dtype}")
        return np.asarray(self.pixels, dtype=dtype)

    def png(self) -> bytes:
        """The picture as the bytes of a PNG."""
        return _metaball.png(self.pixels)

    def _repr_png_(self) -> bytes:
        return self.png()

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the picture: `.png`, or `.jpg` and `.jpeg` of quality 95. It appears whole or not at all.

        Raises
        ------
        ValueError
            When the ending is another.
        OSError
            When the file cannot be written.
        """
        _metaball.save_picture(path, self.pixels)

    def save_light(self, path: str | PathLike[str]) -> None:
        """Writes the linear light as `.exr`.

        Raises
        ------
        ValueError
            When there is no ray traced light, or the ending is another.
        OSError
            When the file cannot be written.
        """
        if self.light is None:
            raise ValueError("light: needed an option of light, such as shadows, found none")
        _metaball.save_light(path, self.light)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<metaball.Image of {width} × {height} pixels, {int(self.hits.is_hit.sum())} hits>"
