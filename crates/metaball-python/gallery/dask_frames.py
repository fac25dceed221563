"""Frames spread over Dask's workers, here of this machine: a worker that dies is replaced, its frames drawn again."""

import sys
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster, as_completed

import metaball

CAMERA = metaball.Camera(eye=(0.0, 0.0, 8.0), look_at=(0.0, 0.0, 0.0))


def draw(frame: int, folder: Path) -> int:
    """Draws a frame, unless it is there: a file is whole or not there, and the same whoever draws it."""
    file = folder / f"frame-{frame:03}.png"
    if not file.exists():
        random = np.random.default_rng(2)
        positions, velocities = random.normal(0, 0.3, (2, 2000, 3))
        particles = metaball.Particles(positions + 0.2 * frame * velocities, radius=0.2)
        picture = metaball.Surface(particles).render(CAMERA, size=(320, 240), shadows=True)
        picture.save(file)
    return frame


def main(folder: Path, frames: int = 12) -> None:
    one_core = {"RAYON_NUM_THREADS": "1"}
    with (
        LocalCluster(2, threads_per_worker=1, env=one_core, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        # Drawing is no pure function: the scheduler keeps no answer in the place of a file.
        drawn = [client.submit(draw, frame, folder, pure=False) for frame in range(frames)]
        for future in as_completed(drawn):
            print(f"frame {future.result()}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
