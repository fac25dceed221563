"""Where pictures are seen from."""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """Where a picture is seen from; what is `None` is as the surface's own camera has it.

    That one looks at all particles from the front, a little from the right and above.
    """

    eye: Point | None = None
    """The eye, in the particles' coordinates. Alone it looks at the middle of the surface."""
    look_at: Point | None = None
    """What it looks at, in the same coordinates."""
    up: Point | None = None
    """What is up in the picture; for another eye or direction the y axis, or the z axis in a view along y."""
    fov: float | None = None
    """Degrees from the bottom of the picture to its top."""
