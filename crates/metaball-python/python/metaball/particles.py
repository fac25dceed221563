"""Particles: where they are, how large, how strong and of what colour."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _metaball
from .arrays import Floats, floats, points
from .tables import table_of

if TYPE_CHECKING:
    from typing_extensions import Unpack


class ReaderWarning(UserWarning):
    """What a reader of files has guessed, left out or changed."""


class ReadOptions(TypedDict, total=False):
    """How a file is read, by the names of the command line; what is left out goes by what the file says."""

    substance: str
    """What the particles are: `molecule` or `particles` (the command line's `--as`)."""
    radius: float
    """The radius at which every particle alone shows, in the file's unit."""
    support_radius: float
    """The support radius of every particle, in the file's unit."""
    radius_scale: float
    """What all radii are multiplied by."""
    units: str
    """The unit of the file's lengths, for molecules: `A`, `nm` or `m`."""
    frame: int
    """The frame of a file that holds many, counted from 0."""
    model: int
    """The model of a structure, by its number in the file."""
    columns: list[str]
    """Names of a table's columns, in their order."""
    topology: str | PathLike[str]
    """The structure file that says what the particles of a trajectory are."""
    keep: str | list[str]
    """Which particles to keep: `water`, `hydrogen`, `COLUMN=VALUE,…` or `COLUMN=FROM..TO`."""
    drop: str | list[str]
    """Which to leave out, likewise."""
    color_by: str
    """The column that gives colours: `COLUMN` or `COLUMN=FROM..TO`."""
    repeat: tuple[int, int, int]
    """How often the periodic cell is drawn along each of its edges."""


class FieldOptions(ReadOptions, total=False):
    """How a file is read and what makes a field of it, by the names of the command line."""

    sph: bool
    """Masses, densities and smoothing lengths make the SPH interpolant; without densities neighbours do."""
    support_per_h: float
    """The support radius over the smoothing length h, with `sph`; what the kernel's source has when left out."""
    particle_mass: float
    """The mass of every particle, with `sph`, where there are densities and no masses."""
    preset: str
    """Another program's surface: `quicksurf`, `molmap`, `gaussian-surface` or `splashsurf`."""
    resolution: float
    """The resolution of `molmap`, ångströms."""
    radius_offset: float
    """What `gaussian-surface` increases radii by, ångströms."""
    smoothness: float
    """The smoothness of `gaussian-surface`; 1.5 when left out."""
    smoothing_length: float
    """The smoothing length of `splashsurf`, in particle radii; 2 when left out."""


class Particles:
    """Particles, in arrays that are kept as they are: float32 or float64 of any strides is not copied.

    Parameters
    ----------
    centers
        Centres, shape (n, 3), in any unit of length.
    radius
        The radius at which a particle alone shows, in the unit of the centres: one for all, or shape (n,).
        The support radius follows from it, from kernel, strength and threshold.
    support_radius
        The radius R beyond which a particle adds nothing, instead: one for all, or shape (n,). Without
        either it is twice the median distance between neighbours.
    strength
        The strength q, not 0: one for all, or shape (n,); 1 where left out. A negative ball takes away from what
        the others make; its `radius` is the one at which it would show if it added as much.
    color
        Colours, sRGB: one for all, shape (3,), or shape (n, 3); numbers from 0 to 1, or uint8 from 0 to 255.

    Raises
    ------
    ValueError
        When the arrays do not fit one another.
    """

    __slots__ = ("centers", "color", "notes", "radius", "strength", "support_radius")

    centers: Floats
    radius: Floats | float | None
    support_radius: Floats | float | None
    strength: Floats | None
    color: npt.NDArray[np.uint8] | None
    notes: tuple[str, ...]

    def __init__(
        self,
        centers: npt.ArrayLike,
        *,
        radius: npt.ArrayLike | None = None,
        support_radius: npt.ArrayLike | None = None,
        strength: npt.ArrayLike | None = None,
        color: npt.ArrayLike | None = None,
    ) -> None:
        self.centers = points("centers", centers)
        if radius is not None and support_radius is not None:
            raise ValueError("radius: needed a radius or a support radius, found both")
        count = len(self.centers)
        self.radius = _amount("radius", radius, count)
        self.support_radius = _amount("support_radius", support_radius, count)
        amount = _amount("strength", strength, count)
        self.strength = np.full(count, amount) if isinstance(amount, float) else amount
        self.color = _colors(color, count)
        self.notes = ()

    @classmethod
    def read(cls, path: str | PathLike[str], **options: Unpack[ReadOptions]) -> Particles:
        """The particles of a file: PDB, mmCIF, GRO, XYZ, CSV, LAMMPS, VTK, PLY, NumPy and others.

        A scene file (`.toml`) says how its particles make a surface, and so do formulas of simulations and of
        other programs: both are for `Surface.read`.

        What the reader says is in `notes`; what it has guessed, left out or changed is warned of too, as
        a `ReaderWarning`.

        Raises
        ------
        ValueError
            When the file holds something else than was needed: names it, with line and column.
        OSError
            When the file cannot be read.
        """
        keywords = reading(options, ReadOptions)
        return cls._read(f"{path}: ", *_metaball.read_particles(path, keywords))

    @classmethod
    def of(cls, thing: object, **options: Unpack[ReadOptions]) -> Particles:
        """The particles of an object of another package, taken as a file with the same columns would be.

        Parameters
        ----------
        thing
            An MDAnalysis AtomGroup or Universe, ASE Atoms, a PyVista PolyData, a pandas or Polars frame,
            a mapping of columns, or a structured NumPy array. Atoms get the radii and colours of their
            elements; else columns `radius`, `support_radius`, `strength`, `red`, `green` and `blue` are
            theirs.
        options
            As for `read`, as far as they are not about a file.

        Raises
        ------
        TypeError
            When the object is of another kind.
        ValueError
            When its columns cannot be used: names them.
        """
        keywords = reading(options, ReadOptions)
        return cls._read("", *_metaball.table_particles(table_of(thing), keywords))

    @classmethod
    def _read(
        cls, source: str, arguments: dict[str, Any], notes: list[tuple[str, str]]
    ) -> Particles:
        """What a reader has made, with what it says."""
        particles = cls(**arguments)
        particles.notes = told(source, notes)
        return particles

    def __len__(self) -> int:
        return len(self.centers)

    def __repr__(self) -> str:
        return f"<metaball.Particles: {len(self)}>"


def reading(options: Mapping[str, object], known: type[ReadOptions]) -> dict[str, object]:
    """The options of reading as the library takes them, all of them."""
    return {**dict.fromkeys(FieldOptions.__annotations__), **named("option", options, known)}


def told(source: str, notes: list[tuple[str, str]]) -> tuple[str, ...]:
    """What a reader says; the caller's caller is warned of what was not simply read."""
    for kind, text in notes:
        if kind != "read":
            warnings.warn(f"{source}{text}", ReaderWarning, stacklevel=4)
    return tuple(text for _, text in notes)


def named(what: str, given: Mapping[str, object], known: type[object]) -> dict[str, object]:
    """The keywords by their names, `None` for those left out."""
    names = known.__annotations__
    for name in given:
        if name not in names:
            raise TypeError(f"{name}: needed an {what} of {', '.join(names)}")
    return {**dict.fromkeys(names), **given}


def _amount(name: str, values: npt.ArrayLike | None, count: int) -> Floats | float | None:
    """One number, or one for each particle."""
    if values is None:
        return None
    array = floats(name, values)
    if array.ndim == 0:
        return float(array)
    if array.shape != (count,):
        raise ValueError(f"{name}: needed a number or shape ({count},), found {array.shape}")
    return array


def _colors(values: npt.ArrayLike | None, count: int) -> npt.NDArray[np.uint8] | None:
    """Eight bits a channel, one row for each particle."""
    if values is None:
        return None
    array = np.asarray(values)
    if array.shape not in ((3,), (count, 3)):
        raise ValueError(f"color: needed shape (3,) or ({count}, 3), found {array.shape}")
    if array.dtype != np.uint8:
        shares = floats("color", array)
        if not bool(np.all((shares >= 0) & (shares <= 1))):
            raise ValueError("color: needed numbers from 0 to 1, or uint8, found others")
        array = np.rint(255 * shares).astype(np.uint8)
    return np.broadcast_to(array, (count, 3))
