"""Where a method of one's own is wrong: marching with a fixed step, against the exact reference."""

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt

import metaball


def march(
    surface: metaball.Surface, eye: npt.NDArray[np.float64], directions: npt.NDArray[np.float32]
) -> metaball.Hits:
    """The first of 100 equal steps at which the field is above T: late, and blind to what is thin."""
    least, greatest = np.array(surface.bounds)
    middle, reach = np.linalg.norm(eye - (least + greatest) / 2), np.linalg.norm(greatest - least) / 2
    steps = np.linspace(middle - reach, middle + reach, 100)
    t = np.full(directions.shape[:-1], np.inf)
    for step in steps:
        inside = surface.field(eye + step * directions.astype(np.float64)) >= surface.threshold
        t = np.where(np.isinf(t) & inside, step, t)
    return metaball.Hits.of(t)


def main(folder: Path) -> None:
    centers = np.random.default_rng(5).random((60, 3))
    surface = metaball.Surface(metaball.Particles(centers, support_radius=0.35))
    eye, directions = surface.rays(metaball.Camera(fov=30.0), size=(120, 90))
    comparison = surface.compare(march(surface, eye, directions), eye, directions)
    print(comparison.score)
    # Errors up to a twentieth of a radius as red, wrong verdicts white.
    pixels = np.zeros((90, 120, 4), dtype=np.uint8)
    pixels[..., 0] = 255 * np.clip(np.nan_to_num(comparison.errors) / 0.05, 0, 1)
    pixels[comparison.wrong] = 255
    pixels[..., 3] = 255
    metaball.Image(pixels, surface.trace(eye, directions), None).save(folder / "errors.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
