"""Particles that other packages hold, as tables: positions and columns. None of these packages is imported.

| what | known by | what is taken |
| --- | --- | --- |
| MDAnalysis AtomGroup, Universe | `positions`, `universe` | elements, names, residues, chains, charges, masses |
| ASE Atoms | `get_positions`, `get_chemical_symbols` | elements, charges, the periodic cell, all arrays |
| PyVista PolyData and the like | `points`, `point_data` | all arrays of the points |
| pandas and Polars frames | `columns` | all columns; x, y and z are the positions |
| mappings, structured NumPy arrays | `keys`, `dtype.names` | likewise |
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .arrays import Floats, points

Column = npt.NDArray[np.float64] | list[str]
"""Numbers, or words."""


@dataclass
class Table:
    """What a package holds of particles."""

    positions: Floats | None
    """Shape (n, 3); `None` where columns x, y and z have them."""
    columns: list[tuple[str, Column]] = field(default_factory=list)
    edges: list[list[float]] | None = None
    """Edges of the periodic cell, where there is one."""
    atoms: bool = False
    """Whether they are atoms, in ångströms."""

    def add(self, name: str, values: npt.ArrayLike) -> None:
        """Adds a column of numbers or words, component by component; what is neither is left."""
        array = np.asarray(values)
        if array.ndim == 1 and array.dtype.kind in "OSU":
            self.columns.append((name, [str(word) for word in array.tolist()]))
        elif array.ndim == 1 and array.dtype.kind in "biuf":
            self.columns.append((name, array.astype(np.float64)))
        elif array.ndim == 2 and array.dtype.kind in "biuf":
            for component, column in enumerate(array.T):
                self.columns.append((f"{name}:{component}", column.astype(np.float64)))


def table_of(thing: Any) -> Table:
    """The table of an object of one of the kinds above.

    Raises
    ------
    TypeError
        When it is of none of them.
    """
    if hasattr(thing, "universe") and hasattr(thing, "atoms"):
        return _of_atom_group(thing.atoms)
    if hasattr(thing, "get_positions") and hasattr(thing, "get_chemical_symbols"):
        return _of_ase(thing)
    if hasattr(thing, "points") and hasattr(thing, "point_data"):
        table = Table(points("points", thing.points))
        return _with_columns(table, ((name, thing.point_data[name]) for name in thing.point_data))
    names = _names_of_columns(thing)
    if names is not None:
        return _with_columns(Table(None), ((name, thing[name]) for name in names))
    raise TypeError(
        "particles: needed an MDAnalysis AtomGroup, ASE Atoms, PyVista PolyData, a pandas or Polars frame, "
        f"a mapping or a structured array, found {type(thing).__name__}"
    )


def _names_of_columns(thing: Any) -> list[str] | None:
    if isinstance(thing, Mapping):
        return [str(name) for name in thing]
    if hasattr(thing, "columns"):
        return [str(name) for name in thing.columns]
    names = getattr(getattr(thing, "dtype", None), "names", None)
    return None if names is None else list(names)


def _with_columns(table: Table, columns: Iterable[tuple[str, npt.ArrayLike]]) -> Table:
    for name, values in columns:
        table.add(name, values)
    return table


def _of_atom_group(atoms: Any) -> Table:
    """Of MDAnalysis: columns by the names that files have for them, of those that the topology has."""
    table = Table(points("positions", atoms.positions), atoms=True)
    for name, attribute in (
        ("element", "elements"),
        ("name", "names"),
        ("residue", "resnames"),
        ("residue_number", "resids"),
        ("chain", "chainIDs"),
        ("segment", "segids"),
        ("type", "types"),
        ("charge", "charges"),
        ("mass", "masses"),
    ):
        if hasattr(atoms, attribute):
            table.add(name, getattr(atoms, attribute))
    if all(name != "element" for name, _ in table.columns):
        table.columns += [("element", values) for name, values in table.columns if name == "type"]
    cell = atoms.universe.trajectory.ts.triclinic_dimensions
    table.edges = None if cell is None else np.asarray(cell, dtype=np.float64).tolist()
    return table


def _of_ase(atoms: Any) -> Table:
    table = Table(points("positions", atoms.get_positions()), atoms=True)
    table.add("element", atoms.get_chemical_symbols())
    for name, values in atoms.arrays.items():
        if name not in ("positions", "numbers"):
            table.add(name, values)
    if np.any(atoms.pbc):
        table.edges = np.asarray(atoms.cell, dtype=np.float64).tolist()
    return table
