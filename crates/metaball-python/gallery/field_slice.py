"""A slice of the field, with the surface as its contour, and its gradient beside it."""

import sys
from pathlib import Path

import numpy as np

import metaball


def main(folder: Path) -> None:
    surface = metaball.Surface(
        metaball.Particles(np.random.default_rng(4).random((40, 3)), support_radius=0.3)
    )
    x, y = np.meshgrid(np.linspace(-0.2, 1.2, 200), np.linspace(1.2, -0.2, 200))
    points = np.stack([x, y, np.full_like(x, 0.5)], axis=-1)
    field, gradient = surface.field(points), surface.gradient(points)
    grey = np.clip(255 * field / field.max(), 0, 255).astype(np.uint8)
    pixels = np.dstack([grey, grey, grey, np.full_like(grey, 255)])
    # Within half a pixel of the surface, by the first term of Taylor's series.
    steepness = np.maximum(np.linalg.norm(gradient, axis=-1), 1e-12)
    pixels[np.abs(field - surface.threshold) < 0.0035 * steepness] = (255, 80, 40, 255)
    nothing = metaball.Hits.of(np.full(x.shape, np.inf))
    metaball.Image(pixels, nothing, None).save(folder / "slice.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
