"""Each script of the gallery runs, and writes what it says."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

GALLERY = Path(__file__).parent.parent / "gallery"

SCRIPTS = {
    "balls": (["balls.png"], None),
    "crystal": (["crystal.png"], "ase"),
    "dask_frames": ([f"frame-{frame:03}.png" for frame in range(12)], "distributed"),
    "error_map": (["errors.png"], None),
    "field_slice": (["slice.png"], None),
    "molecule": (["molecule.png"], "MDAnalysis"),
    "processes": (["hits.npy"], None),
    "sequence": ([f"frame-{frame:03}.png" for frame in range(8)], None),
    "sph_frame": (["frame.h5", "sph.png"], "h5py"),
    "turntable": ([f"turn-{frame:03}.png" for frame in range(8)], None),
    "volume": (["volume.txt"], None),
}
"""What each writes, and the package that it needs, if any."""


def test_all_scripts_are_listed() -> None:
    assert sorted(file.stem for file in GALLERY.glob("*.py")) == sorted(SCRIPTS)


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_script_runs(name: str, tmp_path: Path) -> None:
    files, package = SCRIPTS[name]
    if package is not None:
        pytest.importorskip(package)
    ran = subprocess.run(
        [sys.executable, GALLERY / f"{name}.py", tmp_path],
        capture_output=True,
        text=True,
        env={**os.environ, "MPLBACKEND": "agg"},
        timeout=120,
    )
    assert ran.returncode == 0, ran.stderr
    written = {file.name for file in tmp_path.iterdir()}
    assert written.issuperset(files)
    pictures = [tmp_path / file for file in files if file.endswith(".png")]
    assert all(picture.stat().st_size > 1500 for picture in pictures), "a picture of nothing"
