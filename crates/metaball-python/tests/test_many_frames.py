"""Frames that engines spread over processes: all come, each the same whoever drew it, and however often."""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

GALLERY = Path(__file__).parent.parent / "gallery"
JOBS = Path(__file__).parents[3] / "docs/many-frames"


def script(name: str) -> ModuleType:
    """A script of the gallery, not run."""
    spec = importlib.util.spec_from_file_location(name, GALLERY / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def workers_of(cluster: int, count: int) -> list[int]:
    """So many workers of a cluster, by the numbers of their processes, as soon as it has them."""
    psutil = pytest.importorskip("psutil")

    def is_worker(child: Any) -> bool:
        try:
            return "spawn_main" in " ".join(child.cmdline())
        except psutil.Error:
            # It has ended since.
            return False

    workers: list[int] = []
    latest = time.monotonic() + 60.0
    while time.monotonic() < latest:
        workers = [child.pid for child in psutil.Process(cluster).children() if is_worker(child)]
        if len(workers) >= count:
            return workers[:count]
        time.sleep(0.05)
    raise TimeoutError(f"workers: needed {count}, found {len(workers)}")


@pytest.mark.skipif(sys.platform == "win32", reason="processes end otherwise there")
def test_workers_of_dask_are_killed_and_no_frame_is_lost(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    command = [sys.executable, str(GALLERY / "dask_frames.py"), str(tmp_path)]
    running = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert running.stdout is not None
        killed = []
        for drawn in range(2):
            assert running.stdout.readline().startswith("frame "), drawn
            for worker in workers_of(running.pid, drawn + 1):
                os.kill(worker, signal.SIGKILL)
                killed.append(worker)
        said, complaint = running.communicate(timeout=100)
    finally:
        running.kill()
    assert running.returncode == 0, complaint
    assert len(killed) == 3 and len(said.splitlines()) == 10

    draw = script("dask_frames").draw
    alone = tmp_path / "alone"
    alone.mkdir()
    for frame in range(12):
        draw(frame, alone)
    frames = {file.name: file.read_bytes() for file in tmp_path.glob("*.png")}
    assert frames == {file.name: file.read_bytes() for file in alone.glob("*.png")}
    assert len(set(frames.values())) == 12, "the scene moves"


@pytest.fixture
def metaball_path() -> str:
    """The search path of programs, with the command `metaball` first."""
    command = os.environ.get("METABALL")
    if command is None:
        pytest.skip("METABALL names no command metaball")
    return f"{Path(command).parent}{os.pathsep}{os.environ['PATH']}"


def run_openjd(path: str, folder: Path, *parameters: str) -> subprocess.CompletedProcess[str]:
    openjd = Path(sys.executable).with_name("openjd")
    if not openjd.exists():
        pytest.skip("openjd-cli is not installed")
    given = [f"Out={folder}/f-%02d.png", "Options=--size 32x24 --shadows", "Last=4", *parameters]
    arguments = [word for parameter in given for word in ("-p", parameter)]
    return subprocess.run(
        [openjd, "run", JOBS / "openjd.yaml", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "PATH": path},
        timeout=100,
    )


def test_a_job_of_open_job_description_draws_all_frames(metaball_path: str, tmp_path: Path) -> None:
    ran = run_openjd(metaball_path, tmp_path, "Scene=tornado:200", "FramesPerTask=3")
    assert ran.returncode == 0, ran.stdout
    assert "openjd_progress: 100" in ran.stdout and "2 of 2: frame 4" in ran.stdout
    frames = sorted(file.name for file in tmp_path.glob("*.png"))
    assert frames == [f"f-{frame:02}.png" for frame in range(5)]


def test_a_job_of_open_job_description_says_that_input_is_bad(
    metaball_path: str, tmp_path: Path
) -> None:
    ran = run_openjd(metaball_path, tmp_path, "Scene=nosuch.xyz")
    assert ran.returncode != 0
    assert "openjd_fail: the input cannot be used" in ran.stdout
