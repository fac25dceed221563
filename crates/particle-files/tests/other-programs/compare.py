"""Holds what `metaball convert` reads to what other programs read of the same files, atom for atom.

A developer's test, not one of CI: it wants packages from PyPI.

    pip install numpy ase meshio plyfile gemmi MDAnalysis MDAnalysisTests
    cargo build --release -p metaball-cli
    python3 crates/particle-files/tests/other-programs/compare.py target/release/metaball

A file agrees where all positions are the same to single precision, in the same order, and, where the other program
knows elements, all elements. Virtual sites are left out of the other program's atoms, as they are here, and
structures with alternative places are not compared. Prints a line for each file and fails where one disagrees. A package that is missing is named: its files are not compared, and the run fails.
"""

import csv
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import warnings

warnings.filterwarnings("ignore")

PACKAGES = ["numpy", "ase", "meshio", "plyfile", "gemmi", "MDAnalysis", "MDAnalysisTests"]

def ours(metaball, path, folder, options=()):
    """Positions and columns that the program under test reads."""
    out = folder / "converted.csv"
    done = subprocess.run(
        [metaball, "convert", str(path), str(out), *options], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        return None, done.stderr.strip()
    with open(out, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    positions = [[float(row[axis]) for axis in "xyz"] for row in rows]
    return positions, {name: [row[name] for row in rows] for name in (rows[0] if rows else {})}


def difference(found, expected, elements=None, columns=None):
    """The first difference between our positions and the other program's; None where there is none."""
    import numpy as np

    if found is None:
        return f"not read: {columns}"
    found, expected = np.asarray(found, float).reshape(-1, 3), np.asarray(expected, float).reshape(-1, 3)
    if len(found) != len(expected):
        return f"{len(found)} particles, {len(expected)} there"
    scale = max(1.0, float(abs(expected).max())) if len(expected) else 1.0
    off = abs(found - expected).max() if len(expected) else 0.0
    if off > 2e-6 * scale:
        return f"off by {off}"
    names = columns.get("element") or columns.get("species") if columns else None
    if elements is not None and names:
        for index, (mine, other) in enumerate(zip(names, elements)):
            # X is gemmi's word for an element that it does not know.
            known = str(other) != "X"
            if known and mine.upper() != str(other).upper() and {mine, str(other)} != {"H", "D"}:
                return f"atom {index}: {mine!r} here, {other!r} there"
    return None


def of_ase(folder):
    """Files that ASE writes: XYZ, extended XYZ, PDB, CIF, GROMACS, LAMMPS data."""
    import ase.build
    import ase.io

    molecule = ase.build.molecule("CH3CH2OH")
    molecule.set_cell([12.0, 13.0, 14.0])
    molecule.center()
    crystal = ase.build.bulk("NaCl", "rocksalt", a=5.64, cubic=True).repeat((2, 2, 1))
    for name, atoms in [("molecule", molecule), ("crystal", crystal)]:
        for ending, form in [("xyz", "xyz"), ("extxyz", "extxyz"), ("pdb", "proteindatabank"), ("cif", "cif")]:
            path = folder / f"ase-{name}.{ending}"
            ase.io.write(path, atoms, format=form)
            back = ase.io.read(path, format=form)
            # Crystallographic files have fractional coordinates, which come back wrapped or not.
            yield path, back.get_positions(), back.get_chemical_symbols(), ()
        path = folder / f"ase-{name}.gro"
        ase.io.write(path, atoms, format="gromacs")
        yield path, ase.io.read(path, format="gromacs").get_positions(), None, ()


def of_meshio(folder):
    """Points that meshio writes: VTK, VTU, PLY."""
    import meshio
    import numpy as np

    points = np.random.default_rng(1).normal(size=(50, 3))
    cells = [("vertex", np.arange(50).reshape(-1, 1))]
    mesh = meshio.Mesh(points, cells, point_data={"mass": np.linspace(0, 1, 50)})
    for ending, options in [("vtk", {}), ("vtk", {"binary": False}), ("vtu", {}), ("vtu", {"binary": False})]:
        path = folder / f"meshio-{'-'.join(map(str, options.values())) or 'default'}.{ending}"
        mesh.write(path, **options)
        yield path, meshio.read(path).points, None, ()


def of_plyfile(folder):
    """Vertices that plyfile writes, in all three forms."""
    import numpy as np
    import plyfile

    vertices = np.zeros(30, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("red", "u1"), ("radius", "f8")])
    for axis in "xyz":
        vertices[axis] = np.random.default_rng(ord(axis)).normal(size=30)
    element = plyfile.PlyElement.describe(vertices, "vertex")
    for name, options in [("text", {"text": True}), ("little", {"byte_order": "<"}), ("big", {"byte_order": ">"})]:
        path = folder / f"plyfile-{name}.ply"
        plyfile.PlyData([element], **options).write(str(path))
        back = plyfile.PlyData.read(str(path))["vertex"]
        yield path, np.stack([back[axis] for axis in "xyz"], axis=1), None, ()


def of_numpy(folder):
    """Arrays that NumPy writes."""
    import numpy as np

    points = np.random.default_rng(2).normal(size=(20, 3))
    for name, array in [
        ("f8", points),
        ("f4", points.astype("<f4")),
        ("big", points.astype(">f8")),
        ("fortran", np.asfortranarray(points)),
        ("i4", (100 * points).astype("<i4")),
    ]:
        path = folder / f"numpy-{name}.npy"
        np.save(path, array)
        yield path, np.load(path), None, ()
    path = folder / "numpy.npz"
    np.savez_compressed(path, positions=points, mass=np.ones(20))
    yield path, points, None, ()


def of_gemmi(folder):
    """Structures of MDAnalysis' tests, as gemmi reads them: its first model, alternatives by occupancy."""
    import gemmi
    from MDAnalysisTests import datafiles

    for name in ["PDB_small", "PDB", "PDB_multiframe", "PDB_full", "mol2_ligand", "PDB_helix", "PDB_cm"]:
        path = pathlib.Path(str(getattr(datafiles, name, "")))
        if path.suffix not in (".pdb", ".cif", ".gz"):
            continue
        model = gemmi.read_structure(str(path))[0]
        atoms = [atom for chain in model for residue in chain for atom in residue]
        atoms = [atom for atom in atoms if not atom.name.startswith("MW")]
        # gemmi brings the residues of a chain together; serial numbers have the order of the file.
        atoms.sort(key=lambda atom: atom.serial)
        if any(atom.altloc != "\0" for atom in atoms):
            continue
        # Where a file names no element, gemmi takes the first letters of names: every CA is calcium.
        with open(path, encoding="latin-1") as file:
            named = any(line.startswith("ATOM") and line[76:78].strip() for line in file)
        elements = [atom.element.name for atom in atoms] if named else None
        yield path, [atom.pos.tolist() for atom in atoms], elements, ()


def of_mdanalysis(folder):
    """Structures and trajectories of MDAnalysis' tests, as it reads them."""
    import MDAnalysis
    from MDAnalysisTests import datafiles

    for name in ["GRO", "two_water_gro", "GRO_velocity", "PQR", "PDBQT_input"]:
        path = pathlib.Path(str(getattr(datafiles, name)))
        universe = MDAnalysis.Universe(str(path))
        keep = [not atom.name.startswith("MW") for atom in universe.atoms]
        yield path, universe.atoms.positions[keep], None, ()
    for topology, trajectory in [("GRO", "XTC"), ("GRO", "TRR"), ("PSF", "DCD")]:
        path = pathlib.Path(str(getattr(datafiles, trajectory)))
        universe = MDAnalysis.Universe(str(getattr(datafiles, topology)), str(path))
        for frame in (0, len(universe.trajectory) - 1):
            universe.trajectory[frame]
            # Without a topology lengths stay in the file's unit: nanometres in XTC and TRR.
            factor = 0.1 if trajectory in ("XTC", "TRR") else 1.0
            yield path, factor * universe.atoms.positions, None, ("--frame", str(frame))


def main():
    metaball = sys.argv[1]
    missing = [name for name in PACKAGES if importlib.util.find_spec(name) is None]
    sources = {
        "ase": of_ase,
        "meshio": of_meshio,
        "plyfile": of_plyfile,
        "numpy": of_numpy,
        "gemmi": of_gemmi,
        "MDAnalysis": of_mdanalysis,
    }
    compared, differing = 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for package, files in sources.items():
            if package in missing or (package in ("gemmi", "MDAnalysis") and "MDAnalysisTests" in missing):
                print(f"{package}: not compared, it is not installed")
                continue
            for path, expected, elements, options in files(folder):
                found, columns = ours(metaball, path, folder, options)
                differs = difference(found, expected, elements, columns)
                compared += 1
                differing += differs is not None
                print(f"{package}: {path.name} {' '.join(options)}: {differs or f'the same {len(expected)}'}")
        # The canary: a particle that is elsewhere is seen.
        moved = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
        assert difference(moved, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.001]]) is not None
        assert difference(moved, moved) is None
    print(f"{compared} files compared, {differing} differ")
    sys.exit(bool(missing) or differing > 0 or compared == 0)


if __name__ == "__main__":
    main()
