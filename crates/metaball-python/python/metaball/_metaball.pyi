"""The native part: arrays in, arrays out. `metaball` is what people call."""

from os import PathLike
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .arrays import Floats
from .progress import ProgressBar
from .tables import Table

__version__: str

Rays = tuple[Floats, Floats, Floats, Floats]
Columns = tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[np.uint8]]
Point = tuple[float, float, float]
Notes = list[tuple[str, str]]
CameraNumbers = tuple[list[float], list[list[float]], float]

class ParticleArrays(Protocol):
    @property
    def centers(self) -> Floats: ...
    @property
    def radius(self) -> Floats | float | None: ...
    @property
    def support_radius(self) -> Floats | float | None: ...
    @property
    def strength(self) -> Floats | None: ...
    @property
    def color(self) -> npt.NDArray[np.uint8] | None: ...

class CameraParts(Protocol):
    @property
    def eye(self) -> Point | None: ...
    @property
    def look_at(self) -> Point | None: ...
    @property
    def up(self) -> Point | None: ...
    @property
    def fov(self) -> float | None: ...

class Surface:
    def __new__(cls, particles: ParticleArrays, kernel: str, threshold: float) -> Surface: ...
    @staticmethod
    def read(
        path: str | PathLike[str],
        reading: dict[str, object],
        kernel: str | None,
        threshold: float | None,
    ) -> tuple[Surface, Notes]: ...
    @staticmethod
    def of_table(
        table: Table, reading: dict[str, object], kernel: str | None, threshold: float | None
    ) -> tuple[Surface, Notes]: ...
    @staticmethod
    def restored(
        particles: ParticleArrays,
        kernel: str,
        threshold: float,
        origin: Point,
        camera: CameraNumbers,
    ) -> Surface: ...
    def state(self) -> tuple[dict[str, Any], Point, CameraNumbers]: ...
    @property
    def kernel(self) -> str: ...
    @property
    def threshold(self) -> float: ...
    @property
    def tree_bytes(self) -> int: ...
    @property
    def build_seconds(self) -> float: ...
    @property
    def bounds(self) -> tuple[Point, Point] | None: ...
    @property
    def camera(self) -> tuple[Point, Point, Point, float]: ...
    def __len__(self) -> int: ...
    def render(
        self,
        camera: CameraParts | None,
        size: tuple[int, int],
        picture: str,
        planes: list[tuple[Point, float]],
        corners: tuple[Point, Point] | None,
        light: dict[str, Any],
        bar: ProgressBar | None,
    ) -> tuple[npt.NDArray[np.uint8], Columns, npt.NDArray[np.float32] | None]: ...
    def rays(
        self, camera: CameraParts | None, size: tuple[int, int]
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float32]]: ...
    def trace(self, rays: Rays, bar: ProgressBar | None) -> Columns: ...
    def exit(self, rays: Rays) -> Columns: ...
    def any_hit(self, rays: Rays) -> npt.NDArray[np.uint8]: ...
    def truth(
        self,
        rays: Rays,
        bar: ProgressBar | None,
    ) -> tuple[
        npt.NDArray[np.float64],
        npt.NDArray[np.float64],
        npt.NDArray[np.uint8],
        npt.NDArray[np.float64],
    ]: ...
    def compare(
        self,
        rays: Rays,
        hits: Columns,
        bar: ProgressBar | None,
    ) -> tuple[
        npt.NDArray[np.uint8],
        npt.NDArray[np.float64],
        npt.NDArray[np.bool_],
        npt.NDArray[np.bool_],
        dict[str, Any],
    ]: ...
    def field(self, points: Floats) -> npt.NDArray[np.float64]: ...
    def gradient(self, points: Floats) -> npt.NDArray[np.float64]: ...

def read_particles(
    path: str | PathLike[str], reading: dict[str, object]
) -> tuple[dict[str, Any], Notes]: ...
def table_particles(
    table: Table, reading: dict[str, object]
) -> tuple[dict[str, Any], Notes]: ...
def png(pixels: npt.NDArray[np.uint8]) -> bytes: ...
def save_picture(path: str | PathLike[str], pixels: npt.NDArray[np.uint8]) -> None: ...
def save_hits(path: str | PathLike[str], size: tuple[int, int], hits: Columns) -> None: ...
def save_light(path: str | PathLike[str], light: npt.NDArray[np.float32]) -> None: ...
