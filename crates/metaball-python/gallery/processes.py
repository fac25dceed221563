"""A picture's rays spread over processes, as Dask and Ray do: a surface is pickled, its tree built anew there."""

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

import metaball


def main(folder: Path) -> None:
    particles = metaball.Particles(np.random.default_rng(0).random((500, 3)), radius=0.08)
    surface = metaball.Surface(particles)
    eye, directions = surface.rays(size=(320, 240))
    parts = np.array_split(directions, 4)
    # Not forked: threads do not live on in a forked process.
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(surface.trace, [eye] * 4, parts))
    t = np.concatenate([hits.t for hits in found])
    assert np.array_equal(t, surface.trace(eye, directions).t), "the same, bit for bit"
    metaball.Hits.of(t).save(folder / "hits.npy")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
