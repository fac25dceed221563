"""A molecule of MDAnalysis, without its water, coloured by chain: any AtomGroup will do."""

import sys
import warnings
from pathlib import Path

import MDAnalysis
import numpy as np

import metaball


def universe() -> MDAnalysis.Universe:
    """Two helices of carbon, nitrogen and oxygen, and some water; MDAnalysis.Universe("protein.pdb") reads yours."""
    turn = np.arange(120) * np.radians(33)
    helix = np.stack([4 * np.cos(turn), 4 * np.sin(turn), 0.4 * np.arange(120)], axis=1)
    water = np.random.default_rng(0).uniform(-15, 15, (40, 3))
    made = MDAnalysis.Universe.empty(280, trajectory=True)
    made.add_TopologyAttr("elements", [*240 * "C", *40 * "O"])
    made.add_TopologyAttr("chainIDs", [*120 * "A", *120 * "B", *40 * "W"])
    made.atoms.positions = np.concatenate([helix, helix + [12, 0, 0], water])
    return made


def main(folder: Path) -> None:
    atoms = universe().select_atoms("not chainID W")
    with warnings.catch_warnings(record=True) as said:
        particles = metaball.Particles.of(atoms, color_by="chain")
    print(len(particles), "atoms;", *(str(warning.message) for warning in said))
    surface = metaball.Surface(particles)
    camera = metaball.Camera(eye=(90.0, 20.0, 24.0), fov=30.0)
    image = surface.render(camera, size=(320, 240), shadows=True, lamp=(0.6, 0.9, 0.6), samples=2)
    image.save(folder / "molecule.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
