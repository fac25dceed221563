"""A surface turned before the camera: the tree is built once, and each frame traced."""

import sys
from pathlib import Path

import numpy as np

import metaball


def main(folder: Path, frames: int = 8) -> None:
    angle = np.linspace(0, 4 * np.pi, 60)
    spiral = np.stack([np.cos(angle), angle / 6 - 1, np.sin(angle)], axis=1)
    surface = metaball.Surface(metaball.Particles(spiral, radius=0.25, color=(0.9, 0.5, 0.2)))
    for frame in range(frames):
        turn = 2 * np.pi * frame / frames
        eye = (5 * np.sin(turn), 1.5, 5 * np.cos(turn))
        camera = metaball.Camera(eye=eye, look_at=(0.0, 0.0, 0.0))
        surface.render(camera, size=(160, 120), shadows=True).save(folder / f"turn-{frame:03}.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
