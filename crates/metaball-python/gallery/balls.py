"""Balls of random size, lit: arrays in, a picture out."""

import sys
from pathlib import Path

import numpy as np

import metaball


def main(folder: Path) -> None:
    random = np.random.default_rng(1)
    particles = metaball.Particles(
        random.normal(size=(300, 3)),
        radius=random.uniform(0.1, 0.3, 300),
        color=random.uniform(0.2, 1.0, (300, 3)),
    )
    surface = metaball.Surface(particles)
    image = surface.render(size=(320, 240), shadows=True, ambient_occlusion=8, floor="tiles", samples=2)
    image.save(folder / "balls.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
