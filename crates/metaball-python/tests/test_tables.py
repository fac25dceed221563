"""Particles that other packages hold."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from metaball import Particles, ReaderWarning, Surface

CENTERS = np.array([[0.0, 0.0, 0.12], [0.0, 0.76, -0.48], [0.0, -0.76, -0.48]])


def test_a_mapping_is_a_table() -> None:
    columns = {"x": CENTERS[:, 0], "y": CENTERS[:, 1], "z": CENTERS[:, 2], "radius": [1, 2, 3]}
    particles = Particles.of({**columns, "mass": np.ones(3)}, keep="mass=1")
    assert np.array_equal(particles.centers, CENTERS)
    assert particles.radius is not None and np.asarray(particles.radius).tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match="needed columns x, y and z of numbers, found mass"):
        Particles.of({"x": [1.0], "y": [2.0], "mass": [1.0]})
    with pytest.raises(TypeError, match="needed an MDAnalysis AtomGroup, .* found int"):
        Particles.of(3)


def test_a_structured_array_is_a_table() -> None:
    array = np.zeros(3, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("support_radius", "f8")])
    array["y"], array["support_radius"] = [0, 1, 2], 1.5
    particles = Particles.of(array)
    assert particles.centers[:, 1].tolist() == [0.0, 1.0, 2.0]
    bounds = Surface(particles).bounds
    assert bounds is not None
    np.testing.assert_allclose(bounds, [[-1.5, -1.5, -1.5], [1.5, 3.5, 1.5]], rtol=1e-6)


def test_points_with_data_are_a_table() -> None:
    """What PyVista's PolyData has."""
    data = {"radius": np.full(3, 0.5), "Color": np.tile([0.5, 0.25, 1.0], (3, 1))}
    particles = Particles.of(SimpleNamespace(points=CENTERS, point_data=data))
    assert particles.color is not None and particles.color[0].tolist() == [128, 64, 255]


def test_pandas_frames() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(CENTERS, columns=["x", "y", "z"]).assign(element=["O", "H", "H"])
    with pytest.warns(ReaderWarning, match="taken as a molecule"):
        water = Particles.of(frame)
    assert water.color is not None and not np.array_equal(water.color[0], water.color[1])


def test_polars_frames() -> None:
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame({"x": CENTERS[:, 0], "y": CENTERS[:, 1], "z": CENTERS[:, 2]})
    particles = Particles.of(frame.with_columns(radius=polars.lit(0.5)), color_by="radius")
    assert np.array_equal(particles.centers, CENTERS) and particles.color is not None


def test_pyvista_points() -> None:
    pyvista = pytest.importorskip("pyvista")
    cloud = pyvista.PolyData(CENTERS)
    cloud["support_radius"] = np.full(3, 1.25)
    assert np.asarray(Particles.of(cloud).support_radius).tolist() == 3 * [1.25]


def test_ase_atoms() -> None:
    ase = pytest.importorskip("ase")
    atoms = ase.Atoms("OH2", positions=CENTERS, cell=[3, 4, 5], pbc=True)
    water = Particles.of(atoms)
    assert np.array_equal(water.centers, CENTERS)
    radii = np.asarray(water.radius)
    assert radii[0] > radii[1] > 1.0
    with pytest.warns(ReaderWarning, match="drawn 2 × 1 × 1 times"):
        assert len(Particles.of(atoms, repeat=(2, 1, 1))) == 6


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_mdanalysis_atoms() -> None:
    mda = pytest.importorskip("MDAnalysis")
    universe = mda.Universe.empty(3, trajectory=True)
    universe.add_TopologyAttr("elements", ["O", "H", "H"])
    universe.atoms.positions = CENTERS
    water = Particles.of(universe.atoms[:2])
    np.testing.assert_allclose(water.centers, CENTERS[:2], rtol=1e-6)
    assert water.color is not None and len(Particles.of(universe)) == 3
