"""Particles of files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metaball import Particles, ReaderWarning, Surface

WATER = "3\nwater\nO 0 0 0.12\nH 0 0.76 -0.48\nH 0 -0.76 -0.48\n"


def test_a_molecule_has_radii_and_colours(tmp_path: Path) -> None:
    file = tmp_path / "water.xyz"
    file.write_text(WATER)
    with pytest.warns(ReaderWarning, match="water.xyz: taken as a molecule: all are elements"):
        water = Particles.read(file)
    assert np.array_equal(water.centers[0], [0.0, 0.0, 0.12])
    assert isinstance(water.radius, np.ndarray) and water.radius[0] > water.radius[1] > 1.0
    assert water.color is not None and not np.array_equal(water.color[0], water.color[1])
    assert any("van der Waals radii" in note for note in water.notes)
    assert len(Surface(water)) == 3


def test_what_is_guessed_is_warned_of(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("x,y,z\n0,0,0\n1,0,0\n2,0,0\n")
    with pytest.warns(ReaderWarning, match="support radius 2 of all: twice the median distance"):
        points = Particles.read(file)
    assert points.support_radius == 2.0
    assert Particles.read(file, support_radius=1.5).support_radius is not None


def test_particles_are_chosen(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("x,y,z,mass\n0,0,0,1\n1,0,0,2\n2,0,0,3\n")
    with pytest.warns(ReaderWarning, match="drops 1 particle of mass=2.5..3"):
        assert len(Particles.read(file, support_radius=1.0, drop=["mass=2.5..3"])) == 2


def test_errors_have_the_librarys_words(tmp_path: Path) -> None:
    file = tmp_path / "broken.csv"
    file.write_text("x,y,z,radius\n0,0,0,four\n")
    with pytest.raises(ValueError, match=r'line 2, column 4 \(radius\): needed a finite number, found "four"'):
        Particles.read(file)
    with pytest.raises(FileNotFoundError, match="nowhere.xyz"):
        Particles.read(tmp_path / "nowhere.xyz")
    with pytest.raises(ValueError, match='units: needed A, nm or m, found "ell"'):
        Particles.read(file, units="ell")
    with pytest.raises(TypeError, match="unit: needed an option of substance, radius"):
        Particles.read(file, unit="nm")  # type: ignore[call-arg]
