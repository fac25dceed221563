"""A frame of an SPH simulation in HDF5, with its own kernel: the field is the share of space that is filled."""

import sys
from pathlib import Path

import h5py
import numpy as np

import metaball


def simulate(path: Path) -> None:
    """A drop above a pool, on a lattice: what a simulation would have written."""
    grid = np.stack(np.meshgrid(*3 * [np.arange(-1, 1, 0.1)], indexing="ij"), axis=-1).reshape(-1, 3)
    in_pool = grid[:, 1] < -0.5
    in_drop = np.linalg.norm(grid - [0, 0.3, 0], axis=1) < 0.45
    positions = grid[in_pool | in_drop] + np.random.default_rng(0).normal(0, 0.01, ((in_pool | in_drop).sum(), 3))
    with h5py.File(path, "w") as file:
        gas = file.create_group("PartType0")
        gas["Coordinates"] = positions
        gas["Masses"] = np.full(len(positions), 0.1**3)
        gas["Density"] = np.ones(len(positions))
        gas["SmoothingLength"] = np.full(len(positions), 0.13)


def main(folder: Path) -> None:
    simulate(folder / "frame.h5")
    with h5py.File(folder / "frame.h5") as file:
        gas = file["PartType0"]
        columns = dict(zip("xyz", gas["Coordinates"][:].T, strict=True))
        columns |= {"mass": gas["Masses"][:], "density": gas["Density"][:], "h": gas["SmoothingLength"][:]}
    # The field is 1 inside, and the surface where it is 1/2: where the fluid ends.
    surface = metaball.Surface.of(columns, sph=True)
    print("in the pool:", surface.field([0.0, -0.8, 0.0]))
    surface.render(size=(320, 240), shadows=True, samples=2).save(folder / "sph.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
