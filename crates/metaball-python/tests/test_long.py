"""What takes long: it is watched, ended, sent to other processes, and lets others work meanwhile."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from metaball import Particles, Surface


class Bar:
    """A bar that remembers."""

    def __init__(self, total: int, unit: str) -> None:
        self.total, self.unit, self.steps, self.closed = total, unit, list[int](), False

    def update(self, n: int, /) -> None:
        self.steps.append(n)

    def close(self) -> None:
        self.closed = True


def test_progress_is_told(surface: Surface) -> None:
    bars: list[Bar] = []

    def make(total: int, unit: str) -> Bar:
        bars.append(Bar(total, unit))
        return bars[-1]

    surface.render(size=(640, 100), samples=1, progress=make)
    surface.hits(size=(640, 400), progress=make)
    rows, rays = bars
    assert (rows.total, rows.unit, sum(rows.steps), rows.closed) == (100, "row", 100, True)
    assert len(rows.steps) > 2
    assert (rays.total, rays.unit, sum(rays.steps)) == (256_000, "ray", 256_000)


def test_tqdm_is_used_where_it_is(surface: Surface, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    surface.render(size=(64, 48), progress=True)
    assert "48/48" in capsys.readouterr().err


def test_a_bar_that_raises_ends_a_picture(surface: Surface) -> None:
    class Broken(Bar):
        def update(self, n: int, /) -> None:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        surface.render(size=(640, 480), progress=Broken)


LONG = {
    "a picture": "surface.render(size=(640, 9000), ambient_occlusion=64, samples=64)",
    "a tree": "metaball.Surface(metaball.Particles(random((2_000_000, 3)), support_radius=0.016))",
    "the truth": "surface.truth([0.5, 0.5, 2.0], random((1_000_000, 3)) - [0.5, 0.5, 2.0])",
}
"""What takes seconds at least, however fast the machine."""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_what_is_long(what: str) -> None:
    script = (
        "import signal, numpy as np, metaball\n"
        # A shell that runs tests in the background has signals of this kind ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "random = np.random.default_rng(0).random\n"
        "surface = metaball.Surface(metaball.Particles(random((3000, 3))))\n"
        "print('begins', flush=True)\n"
        f"{LONG[what]}\n"
        "print('ended by itself')\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None and process.stdout.readline() == "begins\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        said, errors = process.communicate(timeout=100)
    finally:
        process.kill()
    assert process.returncode != 0 and errors.rstrip().endswith("KeyboardInterrupt")
    assert said == ""


def test_others_work_meanwhile() -> None:
    """A second thread counts while rays are traced: it could not if the lock were held."""
    particles = Particles(np.random.default_rng(0).random((3000, 3)))
    surface = Surface(particles)
    counts = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counts[0] += 1
            time.sleep(0)

    counter = threading.Thread(target=count)
    directions = np.tile(surface.rays(size=(300, 300))[1], (1, 1, 1))
    counter.start()
    try:
        before = counts[0]
        # Fewer than are traced together: no signal is looked for on the way.
        surface.render(size=(100, 100), ambient_occlusion=16, samples=4)
        during = counts[0] - before
    finally:
        done.set()
        counter.join()
    assert during > 10 and len(directions) == 300


def test_a_surface_is_pickled(surface: Surface) -> None:
    far = Surface(
        Particles(np.random.default_rng(1).random((20, 3)) + 1e7, support_radius=0.3), "wyvill", 0.5
    )
    for original in (surface, far):
        copy = pickle.loads(pickle.dumps(original))
        assert repr(copy) == repr(original) and copy.bounds == original.bounds
        picture, expected = (of.render(size=(60, 40), shadows=True) for of in (copy, original))
        assert np.array_equal(picture.pixels, expected.pixels)
        assert np.array_equal(picture.hits.t, expected.hits.t)
        assert expected.hits.is_hit.sum() > 100
