"""A mesh of the field by VTK, drawn by Mitsuba 3, for `metaball tables peers` alone.

mesh.py THRESHOLD WIDTH HEIGHT THREADS CELLS, in a folder with
    balls.f32  x, y, z, R, q of each ball
    rays.f32   origin, t_min, direction, t_max of each ray, row by row from the top left
writes hits.npy (height x width x 4: t, normal) and prints its clocks in milliseconds. The field of the power
kernel with exponent 2 is evaluated at the corners of a grid, CELLS along its longest side, by loops that numba
compiles; VTK's flying edges make triangles of it, with normals by its gradient; Mitsuba builds Embree's
tree of these and traces the rays. What compiles at first use is used once before the clocks start.
--version prints what is installed.
"""

import importlib.metadata
import sys
import time

PACKAGES = ["numpy", "numba", "vtk", "mitsuba"]

if sys.argv[1:] == ["--version"]:
    print(", ".join(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES))
    sys.exit()

import drjit as dr
import mitsuba as mi
import numba
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkSMPTools
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

mi.set_variant("llvm_ad_rgb")


@numba.njit(parallel=True, fastmath=True, cache=True)
def field_at_corners(balls, origin, spacing, shape):
    """The field at shape (z, y, x) corners."""
    field = np.zeros(shape, np.float32)
    for layer in numba.prange(shape[0]):
        z = origin[2] + layer * spacing
        for ball in range(len(balls)):
            radius = balls[ball, 3]
            away_z = (z - balls[ball, 2]) / radius
            left_z = np.float32(1) - away_z * away_z
            if left_z <= 0:
                continue
            reach = radius * np.sqrt(left_z)
            first_y = max(0, int(np.ceil((balls[ball, 1] - reach - origin[1]) / spacing)))
            last_y = min(shape[1] - 1, int((balls[ball, 1] + reach - origin[1]) / spacing))
            for row in range(first_y, last_y + 1):
                away_y = (origin[1] + row * spacing - balls[ball, 1]) / radius
                left_y = left_z - away_y * away_y
                if left_y <= 0:
                    continue
                reach_x = radius * np.sqrt(left_y)
                first_x = max(0, int(np.ceil((balls[ball, 0] - reach_x - origin[0]) / spacing)))
                last_x = min(shape[2] - 1, int((balls[ball, 0] + reach_x - origin[0]) / spacing))
                step = spacing / radius
                away_x = (origin[0] + first_x * spacing - balls[ball, 0]) / radius
                for column in range(first_x, last_x + 1):
                    x = away_x + np.float32(column - first_x) * step
                    v = max(left_y - x * x, np.float32(0))
                    field[layer, row, column] += balls[ball, 4] * v * v
    return field


def grid(balls, cells):
    """Origin, spacing and shape (z, y, x) of a grid around all supports, with a corner to spare."""
    low = (balls[:, :3] - balls[:, 3:4]).min(axis=0)
    high = (balls[:, :3] + balls[:, 3:4]).max(axis=0)
    spacing = np.float32((high - low).max() / cells)
    corners = np.ceil((high - low) / spacing).astype(int) + 3
    return (low - spacing).astype(np.float32), spacing, tuple(int(n) for n in corners[::-1])


def triangles(balls, threshold, cells):
    """Positions and normals of vertices, and three vertices a triangle."""
    origin, spacing, shape = grid(balls, cells)
    field = field_at_corners(balls, origin, spacing, shape)
    image = vtkImageData()
    image.SetDimensions(*shape[::-1])
    image.SetOrigin(*map(float, origin))
    image.SetSpacing(float(spacing), float(spacing), float(spacing))
    image.GetPointData().SetScalars(numpy_to_vtk(field.ravel()))
    edges = vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, threshold)
    edges.ComputeNormalsOn()
    edges.ComputeGradientsOff()
    edges.ComputeScalarsOff()
    edges.Update()
    surface = edges.GetOutput()
    if surface.GetNumberOfPolys() == 0:
        sys.exit("the grid holds no surface")
    return (
        vtk_to_numpy(surface.GetPoints().GetData()),
        vtk_to_numpy(surface.GetPointData().GetNormals()),
        vtk_to_numpy(surface.GetPolys().GetConnectivityArray()),
    )


def scene_of(positions, normals, corners):
    """The mesh with Embree's tree."""
    mesh = mi.Mesh("surface", len(positions), len(corners) // 3, has_vertex_normals=True)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = mi.Float(positions.ravel())
    parameters["vertex_normals"] = mi.Float(normals.ravel())
    parameters["faces"] = mi.UInt32(corners.astype(np.uint32))
    parameters.update()
    return mi.load_dict({"type": "scene", "surface": mesh})


def hits_of(scene, origins, directions):
    """Distances and normals; infinity and zero where a ray hits nothing."""
    rays = mi.Ray3f(mi.Point3f(origins), mi.Vector3f(directions))
    found = scene.ray_intersect(rays, mi.RayFlags.ShadingFrame, True)
    is_hit = found.is_valid()
    t = dr.select(is_hit, found.t, dr.inf)
    normal = dr.select(is_hit, found.sh_frame.n, 0)
    dr.eval(t, normal)
    dr.sync_thread()
    return t, normal


def main():
    threshold = float(np.float32(sys.argv[1]))
    width, height, threads, cells = map(int, sys.argv[2:])
    numba.set_num_threads(threads)
    dr.set_thread_count(threads)
    vtkSMPTools.SetBackend("STDThread")
    vtkSMPTools.Initialize(threads)
    balls = np.fromfile("balls.f32", np.float32).reshape(-1, 5)
    rays = np.fromfile("rays.f32", np.float32).reshape(height * width, 8)
    origins = np.ascontiguousarray(rays[:, 0:3].T)
    directions = np.ascontiguousarray(rays[:, 4:7].T)

    warm = np.array([[0, 0, 0, 1, 1]], np.float32)
    hits_of(scene_of(*triangles(warm, 0.25, 16)), origins, directions)

    started = time.perf_counter()
    scene = scene_of(*triangles(balls, threshold, cells))
    built, before = time.perf_counter(), time.process_time()
    t, normal = hits_of(scene, origins, directions)
    traced, after = time.perf_counter(), time.process_time()

    hits = np.concatenate([t.numpy()[None], normal.numpy()]).T
    np.save("hits.npy", np.ascontiguousarray(hits.reshape(height, width, 4), np.float32))
    print(f"prepare {1e3 * (built - started)}")
    print(f"trace {1e3 * (traced - built)}")
    print(f"processor {1e3 * (after - before)}")


main()
