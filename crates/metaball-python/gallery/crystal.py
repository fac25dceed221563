"""A crystal of ASE, its cell drawn 2 × 2 × 2 times, cut open."""

import sys
import warnings
from pathlib import Path

import ase.build

import metaball


def main(folder: Path) -> None:
    salt = ase.build.bulk("NaCl", "rocksalt", a=5.64, cubic=True)
    with warnings.catch_warnings():
        # That the cell is repeated is no news here.
        warnings.simplefilter("ignore", metaball.ReaderWarning)
        particles = metaball.Particles.of(salt, repeat=(2, 2, 2), radius_scale=0.8)
    surface = metaball.Surface(particles)
    image = surface.render(size=(480, 360), shadows=True, clip=[((0.0, 0.0, 1.0), 8.0)], samples=8)
    image.save(folder / "crystal.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
