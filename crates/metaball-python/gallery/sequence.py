"""Frames of a simulation to pictures, and to a video where ffmpeg is installed."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

import metaball


def main(folder: Path, frames: int = 8) -> None:
    random = np.random.default_rng(2)
    positions, velocities = random.normal(0, 0.3, (200, 3)), random.normal(0, 1, (200, 3))
    camera = metaball.Camera(eye=(0.0, 0.0, 8.0), look_at=(0.0, 0.0, 0.0))
    for frame in range(frames):
        surface = metaball.Surface(metaball.Particles(positions, radius=0.2))
        surface.render(camera, size=(160, 120)).save(folder / f"frame-{frame:03}.png")
        positions = positions + 0.1 * velocities
        velocities = velocities - [0, 0.2, 0]
    ffmpeg = shutil.which("ffmpeg")
    if ffmpeg is None:
        print("no video: ffmpeg is not installed")
        return
    command = [ffmpeg, "-loglevel", "error", "-y", "-i", "frame-%03d.png", "-pix_fmt", "yuv420p"]
    subprocess.run([*command, "frames.mp4"], cwd=folder, check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
