"""The surface of particles: drawn, traced and asked."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, TypedDict

import numpy as np
import numpy.typing as npt

from . import _metaball
from .arrays import Floats, floats, points, spread
from .camera import Camera, Point
from .comparison import Comparison, Score, Truth
from .hits import Hits
from .image import Image
from .particles import FieldOptions, Particles, named, reading, told
from .progress import Progress, bar
from .tables import table_of

if TYPE_CHECKING:
    from typing_extensions import Unpack


class LightOptions(TypedDict, total=False):
    """Ray traced light, by the names of the command line; any of them asks for it."""

    shadows: bool
    """Lamps cast shadows."""
    lamp: Point | Sequence[Point]
    """Directions to lamps, any length. A key and a fill lamp that move with the camera when left out."""
    lamp_size: float
    """Width of all lamps in degrees, 0 to 180, for soft shadows."""
    ambient_occlusion: int
    """Occlusion rays from each surface point."""
    occlusion_reach: float
    """Where occlusion rays end, in the particles' unit; they cross the whole scene when left out."""
    reflections: int
    """Levels of mirror reflection; 0 mirrors the surroundings alone."""
    reflectivity: float
    """Share of light mirrored at normal incidence, 0 to 1; 0.3 when left out."""
    refraction: float
    """A clear fluid of this index of refraction, such as 1.33."""
    absorption: Point
    """What the fluid absorbs of red, green and blue per unit of length."""
    opacity: float
    """A see-through surface: its share in what is seen through it, 0 to 1."""
    bounces: int
    """Surfaces seen through others, in the fluid or the see-through solid; 8 when left out."""
    floor: str
    """What the scene stands on, y being up: `plain` or `tiles`."""
    environment: str | PathLike[str]
    """The surroundings: an equirectangular `.hdr` or `.exr` image. A generated sky when left out."""
    cel: int
    """Bands of light in cel shading."""
    depth_cue: float
    """Darken what lies behind something near, around it: the strength, such as 1."""
    samples: int
    """Paths of light a pixel; more than one smooths edges. 1 when left out, 64 in a fluid."""
    seed: int
    """Which random numbers."""
    exposure: float
    """Brighten the picture by powers of two."""


class Surface:
    """The surface where the field of particles equals a threshold, with the tree that answers rays exactly.

    Everything is in the particles' coordinates and unit of length. Computations run on all threads, or as
    many as RAYON_NUM_THREADS says, without the interpreter's lock. A surface can be pickled; what is
    unpickled answers the same, bit for bit.

    Parameters
    ----------
    particles
        The particles. Nothing of them is copied but into the surface's own balls, 16 bytes each.
    kernel
        The falloff k, by the names of the command line: `quartic`, `wyvill`, `cubic-spline`, `wendland-c2`
        and others, which the error for a name that is none lists.
    threshold
        T > 0, the field on the surface, in units of the strengths.

    Raises
    ------
    ValueError
        When a particle, the kernel or the threshold cannot be used: names it.
    """

    __slots__ = ("_native", "notes")

    _native: _metaball.Surface
    notes: tuple[str, ...]
    """What the reader of its file has said."""

    def __init__(
        self, particles: Particles, kernel: str = "quartic", threshold: float = 0.25
    ) -> None:
        self._native = _metaball.Surface(particles, kernel, threshold)
        self.notes = particles.notes

    @classmethod
    def read(
        cls,
        path: str | PathLike[str],
        kernel: str | None = None,
        threshold: float | None = None,
        **options: Unpack[FieldOptions],
    ) -> Surface:
        """The surface of a file: a scene (`.toml`), with its camera, or particles in any format.

        It is the surface that `metaball render` draws of the same file with the same options. What the reader
        has guessed, left out or changed is warned of, as a `ReaderWarning`.

        Parameters
        ----------
        path
            The file.
        kernel, threshold
            Others than the scene file or the formula has, or than `quartic` and 0.25.
        options
            How it is read, and what makes a field of it: `sph=True`, `preset="quicksurf"` and so on.

        Raises
        ------
        ValueError
            When the file holds something else than was needed, or an option cannot be used: names it.
        OSError
            When the file cannot be read.
        """
        keywords = reading(options, FieldOptions)
        read = _metaball.Surface.read(path, keywords, kernel, threshold)
        return cls._told(f"{path}: ", *read)

    @classmethod
    def of(
        cls,
        thing: object,
        kernel: str | None = None,
        threshold: float | None = None,
        **options: Unpack[FieldOptions],
    ) -> Surface:
        """The surface of what `Particles.of` takes, as a file with the same columns would make it.

        A fluid in memory, say: `Surface.of({"x": x, "y": y, "z": z, "mass": m, "density": rho, "h": h},
        sph=True)`.

        Parameters
        ----------
        thing
            What holds the particles.
        kernel, threshold
            Others than the formula has, or than `quartic` and 0.25.
        options
            As for `read`.

        Raises
        ------
        TypeError
            When the object is of another kind.
        ValueError
            When its columns or an option cannot be used: names them.
        """
        keywords = reading(options, FieldOptions)
        return cls._told("", *_metaball.Surface.of_table(table_of(thing), keywords, kernel, threshold))

    @classmethod
    def _told(
        cls, source: str, native: _metaball.Surface, notes: list[tuple[str, str]]
    ) -> Surface:
        """What was made of a file or a table, with what the reader says."""
        surface = cls.__new__(cls)
        surface._native, surface.notes = native, told(source, notes)
        return surface

    def render(
        self,
        camera: Camera | None = None,
        size: tuple[int, int] = (640, 480),
        *,
        picture: str = "phong",
        clip: Sequence[tuple[Point, float]] = (),
        clip_box: tuple[Point, Point] | None = None,
        progress: Progress = False,
        **light: Unpack[LightOptions],
    ) -> Image:
        """A picture, the same bytes on every machine. Ctrl-C ends it.

        Parameters
        ----------
        camera
            Where it is seen from; the surface's own camera where left out.
        size
            Pixels across and down.
        picture
            What it shows: `phong`, `normal`, `depth` or `color`.
        clip
            Planes (normal, offset): what lies where normal·x is at most the offset is kept, with faces
            filled.
        clip_box
            The least and the greatest corner of a box that is kept.
        progress
            `True` for a bar of rows by tqdm, or what makes a bar.
        light
            Ray traced light, as `LightOptions` says: `shadows=True`, `ambient_occlusion=64` and so on.

        Raises
        ------
        ValueError
            When an option cannot be used: names it.
        OSError
            When the image of the surroundings cannot be read.
        """
        keywords = named("option of light", light, LightOptions)
        with bar(progress, size[1], "row") as shown:
            pixels, columns, linear = self._native.render(
                camera, size, picture, list(clip), clip_box, keywords, shown
            )
        return Image(pixels, Hits._of(columns, pixels.shape[:2]), linear)

    def hits(
        self,
        camera: Camera | None = None,
        size: tuple[int, int] = (640, 480),
        *,
        progress: Progress = False,
    ) -> Hits:
        """What the rays through the middles of a picture's pixels meet, shape (height, width)."""
        return self.trace(*self.rays(camera, size), progress=progress)

    def rays(
        self, camera: Camera | None = None, size: tuple[int, int] = (640, 480)
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float32]]:
        """The rays of a picture: the eye, shape (3,), and unit directions, shape (height, width, 3)."""
        width, height = size
        origins, directions = self._native.rays(camera, size)
        return origins[0], directions.reshape(height, width, 3)

    def trace(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress = False,
    ) -> Hits:
        """Where rays first enter the solid. Every answer is right, or `Verdict.UNDECIDED`.

        Parameters
        ----------
        origins
            Where the rays start, shape (..., 3); broadcast against the directions.
        directions
            Any length above 0, shape (..., 3): distances are along the unit vector.
        t_min, t_max
            The least and the greatest distance that counts, shape (...) or one for all.
        progress
            `True` for a bar of rays by tqdm, or what makes a bar.

        Returns
        -------
        Hits
            Distances, normals and verdicts, of the rays' shape.

        Raises
        ------
        ValueError
            When a ray has no direction or no start, or shapes do not fit: names it.
        """
        arrays, shape = _rays(origins, directions, t_min, t_max)
        with bar(progress, len(arrays[1]), "ray") as shown:
            return Hits._of(self._native.trace(arrays, shown), shape)

    def exit(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
    ) -> Hits:
        """Where rays that start inside first leave the solid, with normals out of it.

        A ray that starts outside is at its exit already: `Verdict.INSIDE` the space beyond the solid, at
        `t_min`. `Verdict.MISS` is a ray that ends inside. Parameters are those of `trace`.
        """
        arrays, shape = _rays(origins, directions, t_min, t_max)
        return Hits._of(self._native.exit(arrays), shape)

    def any_hit(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
    ) -> npt.NDArray[np.uint8]:
        """Whether there is solid anywhere on rays, as for shadows: numbers of `Verdict`, shape (...).

        `INSIDE` where the ray starts in it, `HIT` where it reaches it. Parameters are those of `trace`.
        """
        arrays, shape = _rays(origins, directions, t_min, t_max)
        return self._native.any_hit(arrays).reshape(shape)

    def truth(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress = False,
    ) -> Truth:
        """Where rays first enter the solid, by the exact reference: slow, in float64, without the tree.

        Parameters are those of `trace`.
        """
        arrays, shape = _rays(origins, directions, t_min, t_max)
        with bar(progress, len(arrays[1]), "ray") as shown:
            t, normals, verdicts, margins = self._native.truth(arrays, shown)
        return Truth(
            t.reshape(shape),
            normals.reshape(*shape, 3),
            verdicts.reshape(shape),
            margins.reshape(shape),
        )

    def compare(
        self,
        hits: Hits,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress = False,
    ) -> Comparison:
        """Hits of any program against the exact reference, ray by ray.

        Parameters
        ----------
        hits
            What was found along the rays, of their shape: `Hits.of` makes them of arrays.
        origins, directions, t_min, t_max, progress
            The rays, as for `trace`.

        Raises
        ------
        ValueError
            When there is not one hit for each ray.
        """
        arrays, shape = _rays(origins, directions, t_min, t_max)
        if hits.shape != shape:
            raise ValueError(f"hits: needed the shape of the rays, {shape}, found {hits.shape}")
        with bar(progress, len(arrays[1]), "ray") as shown:
            findings, errors, ambiguous, wrong, numbers = self._native.compare(
                arrays, hits._columns(), shown
            )
        if not hits.has_normals:
            numbers["normal_degrees"] = None
        each = (findings.reshape(shape), errors.reshape(shape), ambiguous.reshape(shape))
        return Comparison(*each, wrong.reshape(shape), Score(**numbers))

    def score(
        self,
        hits: Hits,
        camera: Camera | None = None,
        *,
        progress: Progress = False,
    ) -> Score:
        """Hits of a picture, of shape (height, width), against the exact reference in every pixel."""
        if len(hits.shape) != 2:
            raise ValueError(f"hits: needed those of a picture, (height, width), found {hits.shape}")
        height, width = hits.shape
        return self.compare(hits, *self.rays(camera, (width, height)), progress=progress).score

    def field(self, at: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The field at points of shape (..., 3), in units of the strengths: shape (...), float64."""
        array = floats("points", at)
        return self._native.field(points("points", array)).reshape(array.shape[:-1])

    def gradient(self, at: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The field's gradient at points of shape (..., 3), per unit of length: shape (..., 3), float64."""
        array = floats("points", at)
        return self._native.gradient(points("points", array)).reshape(array.shape)

    @property
    def kernel(self) -> str:
        """The kernel's name, such as `power-2`, which is the quartic."""
        return self._native.kernel

    @property
    def threshold(self) -> float:
        """T, the field on the surface."""
        return self._native.threshold

    @property
    def bounds(self) -> tuple[Point, Point] | None:
        """The least and the greatest corner of the box around all supports; `None` without particles."""
        return self._native.bounds

    @property
    def camera(self) -> Camera:
        """Its own camera."""
        return Camera(*self._native.camera)

    @property
    def build_seconds(self) -> float:
        """The time that its tree took."""
        return self._native.build_seconds

    @property
    def tree_bytes(self) -> int:
        """The memory of its tree."""
        return self._native.tree_bytes

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self) -> str:
        return (
            f"<metaball.Surface of {len(self)} particles, kernel {self.kernel}, "
            f"threshold {self.threshold:g}>"
        )

    def __reduce__(self) -> tuple[object, ...]:
        arguments, *rest = self._native.state()
        return _restored, (arguments, self.notes, self.kernel, self.threshold, *rest)


def _restored(
    arguments: dict[str, npt.ArrayLike],
    notes: tuple[str, ...],
    kernel: str,
    threshold: float,
    origin: Point,
    camera: _metaball.CameraNumbers,
) -> Surface:
    """A surface as it was pickled."""
    surface = Surface.__new__(Surface)
    surface.notes = notes
    particles = Particles(**arguments)
    surface._native = _metaball.Surface.restored(particles, kernel, threshold, origin, camera)
    return surface


def _rays(
    origins: npt.ArrayLike, directions: npt.ArrayLike, t_min: npt.ArrayLike, t_max: npt.ArrayLike
) -> tuple[_metaball.Rays, tuple[int, ...]]:
    """Rays as flat arrays, what is one for all as one; and the shape of what they meet."""
    starts, ways = floats("origins", origins), floats("directions", directions)
    ends = floats("t_min", t_min), floats("t_max", t_max)
    for name, array in (("origins", starts), ("directions", ways)):
        if array.ndim == 0 or array.shape[-1] != 3:
            raise ValueError(f"{name}: needed an array of shape (..., 3), found {array.shape}")
    try:
        shape = np.broadcast_shapes(
            starts.shape[:-1], ways.shape[:-1], *(end.shape for end in ends)
        )
    except ValueError as error:
        raise ValueError(
            f"rays: needed shapes that fit one another, found origins {starts.shape}, directions "
            f"{ways.shape}, t_min {ends[0].shape}, t_max {ends[1].shape}"
        ) from error
    if starts.ndim > 1:
        starts = spread(starts, (*shape, 3))
    least, greatest = (end if end.ndim == 0 else spread(end, shape) for end in ends)
    flat = (
        starts.reshape(-1, 3),
        spread(ways, (*shape, 3)).reshape(-1, 3),
        least.reshape(-1),
        greatest.reshape(-1),
    )
    return flat, shape
