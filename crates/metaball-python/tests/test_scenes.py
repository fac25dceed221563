"""Surfaces of scene files, of SPH and of other programs' formulas, by the command line's names."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

from metaball import Camera, Particles, ReaderWarning, Surface

pytestmark = pytest.mark.filterwarnings("ignore::metaball.ReaderWarning")

POOL = "x,y,z,radius\n0,0,0,0.5\n0.6,0,0,0.5\n0,0.6,0,0.25\n"

SCENE = """
particles = "pool.csv"
kernel = "wyvill"
threshold = 0.2
[camera]
eye = [0.1, 0.2, 4.3]
look_at = [0.3, 0.0, 0.0]
up = [0.1, 1.0, 0.0]
vertical_fov_degrees = 30
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A scene file, with its particles beside it."""
    (tmp_path / "pool.csv").write_text(POOL)
    file = tmp_path / "scene.toml"
    file.write_text(SCENE)
    return file


def fluid() -> dict[str, np.ndarray[tuple[int, ...], np.dtype[np.float64]]]:
    """A cube of fluid on a lattice, with what SPH codes write of it."""
    x, y, z = (axis.ravel() for axis in np.mgrid[0:6, 0:6, 0:6] * 0.1)
    ones = np.ones_like(x)
    return {"x": x, "y": y, "z": z, "mass": ones, "density": 1000.0 * ones, "h": 0.13 * ones}


def test_a_scene_file_says_how_it_is_seen(scene: Path) -> None:
    surface = Surface.read(scene)
    assert (surface.kernel, len(surface)) == ("wyvill", 3)
    assert surface.threshold == pytest.approx(0.2)
    camera = Camera(eye=(0.1, 0.2, 4.3), look_at=(0.3, 0, 0), up=(0.1, 1, 0), fov=30)
    particles = Particles.read(scene.with_name("pool.csv"))
    wanted = Surface(particles, "wyvill", 0.2).render(camera, size=(80, 60))
    found = surface.render(size=(80, 60))
    assert np.array_equal(found.pixels, wanted.pixels) and found.hits.is_hit.sum() > 300
    elsewhere = Surface(particles, "wyvill", 0.2).render(size=(80, 60))
    assert not np.array_equal(found.pixels, elsewhere.pixels), "the camera is its own"


def test_a_scene_that_was_read_is_pickled(scene: Path) -> None:
    surface = Surface.read(scene)
    copy = pickle.loads(pickle.dumps(surface))
    assert copy.notes == surface.notes != ()
    assert np.array_equal(copy.render(size=(80, 60)).pixels, surface.render(size=(80, 60)).pixels)


def test_kernel_and_threshold_may_be_others(scene: Path) -> None:
    surface = Surface.read(scene, "power-3", 0.1)
    assert surface.kernel == "power-3" and surface.threshold == pytest.approx(0.1)
    with pytest.raises(ValueError, match="kernel: needed power"):
        Surface.read(scene, "gauss")
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        Surface.read(scene.with_name("nowhere.toml"))
    scene.write_text(SCENE.replace("threshold", "treshold"))
    with pytest.raises(ValueError, match="scene.toml, line 4, column 1: unknown field"):
        Surface.read(scene)


def test_sph_makes_a_field_of_one_inside() -> None:
    surface = Surface.of(fluid(), sph=True)
    assert (surface.kernel, surface.threshold) == ("cubic-spline", 0.5)
    middle = surface.field([[0.25, 0.25, 0.25], [2.0, 0.0, 0.0]])
    assert middle[0] == pytest.approx(1.0, abs=0.05) and middle[1] == 0.0
    doubled = Surface.of(fluid(), sph=True, support_per_h=1.5)
    assert doubled.bounds != surface.bounds


def test_a_table_is_taken_as_its_file_is(tmp_path: Path) -> None:
    columns = fluid()
    file = tmp_path / "fluid.csv"
    rows = np.column_stack(list(columns.values()))
    np.savetxt(file, rows, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")
    for options in ({"sph": True}, {"preset": "splashsurf", "radius": 0.05}):
        table, read = Surface.of(columns, **options), Surface.read(file, **options)
        found, wanted = (of.render(size=(40, 30)).pixels for of in (table, read))
        assert np.array_equal(found, wanted) and repr(table) == repr(read)


def test_presets_are_other_programs_surfaces(tmp_path: Path) -> None:
    file = tmp_path / "water.xyz"
    file.write_text("3\nwater\nO 0 0 0.12\nH 0 0.76 -0.48\nH 0 -0.76 -0.48\n")
    drawn = []
    with pytest.warns(ReaderWarning):
        drawn.append(Surface.read(file))
        drawn.append(Surface.read(file, preset="quicksurf"))
        drawn.append(Surface.read(file, preset="molmap", resolution=2.0))
        drawn.append(Surface.read(file, preset="gaussian-surface"))
        drawn.append(Surface.read(file, preset="gaussian-surface", radius_offset=0.3))
        drawn.append(Surface.read(file, preset="gaussian-surface", smoothness=1.0))
    counts = [int(surface.render(size=(64, 48)).hits.is_hit.sum()) for surface in drawn]
    assert min(counts) > 50
    shown = [surface.field([[0.0, 0.0, 1.5]])[0] / surface.threshold for surface in drawn]
    assert len(set(shown)) == len(drawn), shown


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"preset": "vmd"}, "preset: needed quicksurf, molmap"),
        ({"preset": "molmap"}, "resolution: needed one in ångströms"),
        ({"sph": True, "preset": "quicksurf"}, "none beside sph"),
        ({"smoothness": 2.0}, "smoothness: needed the preset gaussian-surface"),
        ({"sph": True, "particle_mass": -1.0}, "particle mass: needed"),
        ({"smoothing_length": 2.0}, "smoothing length: needed the preset splashsurf"),
    ],
)
def test_formulas_that_make_no_sense_are_named(options: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Surface.of(fluid(), **options)  # type: ignore[arg-type]


def test_formulas_are_not_for_particles(scene: Path) -> None:
    with pytest.raises(TypeError, match="sph: needed an option of substance, radius"):
        Particles.read(scene.with_name("pool.csv"), sph=True)  # type: ignore[call-arg]
