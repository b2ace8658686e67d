"""The systems that label points: the exact map through Python, and others, each called as its users would.

A system has `contains(points, out)` or `signed_distance(points, out)` or both; arrays are contiguous and float32.
"""

import time

import numpy as np

import echinus as ech
import echinus_bench

try:
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonCore import vtkPoints, vtkSMPTools
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
    from vtkmodules.vtkFiltersModeling import vtkSelectEnclosedPoints

    vtkSMPTools.SetBackend("Sequential")
    has_vtk = True
except ImportError:
    has_vtk = False
try:
    import open3d
except ImportError:
    open3d = None

MOST_FACES_FOR_SUMS = 20_000  # beyond, a sum over all of them takes milliseconds a point


class ExactMap:
    name, role, call = "exact map", "ours", 1_000_000  # points in a call; all others have the judge's number

    def __init__(self, mesh):
        self.map = ech.ExactMap(mesh, threads=1)
        self.byte_count = self.map.byte_count

    def contains(self, points, out):
        self.map.contains(points, out=out)

    def signed_distance(self, points, out):
        self.map.signed_distance(points, out=out)


def vtk_points(vertices, deep=False):
    points, surface = vtkPoints(), vtkPolyData()
    points.SetData(numpy_support.numpy_to_vtk(vertices, deep))
    surface.SetPoints(points)
    return surface


def vtk_surface(mesh):
    surface, cells = vtk_points(mesh.vertices, deep=True), vtkCellArray()  # VTK does not keep NumPy's arrays alive
    cells.SetData(3, numpy_support.numpy_to_vtkIdTypeArray(mesh.faces.astype(np.int64).ravel(), deep=True))
    surface.SetPolys(cells)
    return surface


class ExactMapInSmallerCalls(ExactMap):
    name, call = "exact map, calls of 100 000", 100_000


class VtkEnclosed:
    """It builds its tree in every call; what a call of one point takes is that of the build."""

    name, role = "VTK vtkSelectEnclosedPoints", "rival"

    def __init__(self, mesh):
        self.filter = vtkSelectEnclosedPoints()
        self.filter.SetSurfaceData(vtk_surface(mesh))
        one = mesh.vertices[:1].copy()
        self.contains(one, np.empty(1, bool))
        began = time.process_time()
        self.contains(one, np.empty(1, bool))
        self.call_ns = 1e9 * (time.process_time() - began)

    def contains(self, points, out):
        self.filter.SetInputData(vtk_points(points))
        self.filter.Update()
        out[:] = numpy_support.vtk_to_numpy(self.filter.GetOutput().GetPointData().GetArray("SelectedPoints"))


class VtkDistance:
    """Its sides are the signs of its distances."""

    name, role = "VTK vtkImplicitPolyDataDistance", "rival"

    def __init__(self, mesh):
        self.function = vtkImplicitPolyDataDistance()
        self.function.SetInput(vtk_surface(mesh))
        self.signed_distance(mesh.vertices[:1].copy(), np.empty(1, np.float32))

    def signed_distance(self, points, out):
        self.function.FunctionValue(numpy_support.numpy_to_vtk(points), numpy_support.numpy_to_vtk(out))


class Open3d:
    name, role = "Open3D", "rival"
    byte_count = None  # in Embree's own memory

    def __init__(self, mesh):
        self.scene = open3d.t.geometry.RaycastingScene(nthreads=1)
        tensor = open3d.core.Tensor.from_numpy
        self.scene.add_triangles(tensor(mesh.vertices.copy()), tensor(mesh.faces.copy()))
        self.contains(mesh.vertices[:1].copy(), np.empty(1, bool))

    def contains(self, points, out):
        out[:] = self.scene.compute_occupancy(open3d.core.Tensor.from_numpy(points), 1).numpy() != 0

    def signed_distance(self, points, out):
        out[:] = self.scene.compute_signed_distance(open3d.core.Tensor.from_numpy(points), 1).numpy()


class WindingSum:
    name, role, slow = "winding number by brute force", "rival", True

    def __init__(self, mesh):
        self.mesh = mesh
        self.byte_count = mesh.vertices.nbytes + mesh.faces.nbytes

    def contains(self, points, out):
        echinus_bench.contains_by_winding_number(self.mesh.vertices, self.mesh.faces, points, out)


def built(kind, mesh):
    """A system with the processor time of its build and, where it keeps no account, what it took from the heap."""
    seconds = []
    for _ in range(3):
        system = None
        heap, began = echinus_bench.heap_bytes(), time.process_time()
        system = kind(mesh)
        seconds.append(time.process_time() - began)
        taken = echinus_bench.heap_bytes() - heap
    system.build_ms = 1e3 * sorted(seconds)[1]
    if not hasattr(system, "byte_count"):
        system.byte_count = taken
    return system


def systems_on(mesh):
    """All that are at hand, ours first."""
    kinds = [VtkEnclosed, VtkDistance] if has_vtk else []
    kinds += [Open3d] if open3d else []
    kinds += [WindingSum] if len(mesh.faces) <= MOST_FACES_FOR_SUMS else []
    return [built(ExactMap, mesh), built(ExactMapInSmallerCalls, mesh), *echinus_bench.rivals(mesh.vertices, mesh.faces), *(built(kind, mesh) for kind in kinds)]
