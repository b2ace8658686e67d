"""Tetrahedral meshes: files, filling a closed surface, reports, and embedded meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import number, of_kind, path_of, threads_of, vector, whole
from echinus._maps import ExactMap
from echinus._meshes import Mesh, MeshReport, Path, read_only, report_of


class TetrahedralMesh:
    """A body divided into tetrahedra that share vertices.

    Parameters
    ----------
    vertices : array_like (n, 3)
        Positions, rounded to float32 if that can represent the shape, like those of :class:`Mesh`.
    tetrahedra : array_like (m, 4)
        Integers: the vertices a, b, c, d of each tetrahedron, where a, b, c are counter-clockwise seen from d.

    Attributes
    ----------
    vertices : ndarray (n, 3) of float32 or float64, read-only
    tetrahedra : ndarray (m, 4) of uint32, read-only

    Notes
    -----
    Contiguous arrays of these types are shared, not copied: do not change them while the mesh is in use. A
    mesh may have any fault; :func:`require_valid_tetrahedra` reports the first.
    """

    vertices: NDArray[np.float32] | NDArray[np.float64]
    tetrahedra: NDArray[np.uint32]

    def __init__(self, vertices: ArrayLike, tetrahedra: ArrayLike) -> None:
        self.tetrahedra = read_only(_core.tetrahedron_array(tetrahedra))
        self.vertices = read_only(_core.vertex_array(vertices, self.tetrahedra))

    def __repr__(self) -> str:
        return f"<echinus.TetrahedralMesh: {len(self.vertices)} vertices, {len(self.tetrahedra)} tetrahedra>"

    def __reduce__(self) -> tuple[Any, ...]:
        return TetrahedralMesh, (self.vertices, self.tetrahedra)


@dataclass(frozen=True)
class TetrahedraFile:
    """A body from a file, and the changes that made it valid.

    Attributes
    ----------
    mesh
        The body; it is valid, and every vertex is used.
    turned_tetrahedra
        The number of tetrahedra with negative volume, of which two corners were exchanged: the order of the corners
        depends on the convention of the file.
    dropped_vertices
        The number of vertices that no tetrahedron uses.
    """

    mesh: TetrahedralMesh
    turned_tetrahedra: int
    dropped_vertices: int


def read_tetrahedra(path: Path) -> TetrahedraFile:
    """Reads ``.msh`` (Gmsh 2.2 and 4.1), ``.vtk`` (legacy, an unstructured grid) or TetGen's ``.node`` with ``.ele``.

    The path may be that of either file of TetGen's pair. Points, lines, planar cells and data are ignored; volume cells
    other than four-node tetrahedra are refused. Positions are not welded.

    Raises
    ------
    Error
        ``unreadable``, ``wrong_format``, ``damaged`` or ``invalid_mesh``; the message begins with the path.
    """
    arrays, turned, dropped = _core.read_tetrahedra(path_of(path))
    return TetrahedraFile(TetrahedralMesh(*arrays), turned, dropped)


def write_tetrahedra(path: Path, mesh: TetrahedralMesh) -> None:
    """Writes ``.msh`` (Gmsh 2.2) or ``.vtk``, depending on the file name's extension. The file is written atomically.

    Raises
    ------
    Error
        ``unwritable``, ``wrong_format`` for any other extension, or ``invalid_mesh``.
    """
    _core.write_tetrahedra(path_of(path), *_arrays_of(mesh))


def make_solid_box(
    size: tuple[float, float, float] = (1, 1, 1), segments: tuple[int, int, int] = (1, 1, 1)
) -> TetrahedralMesh:
    """Makes a box around the origin from cuboids that are divided into five tetrahedra each.

    Vertex (i, j, k), counted along x, y and z, has the index
    ``(k * (segments[1] + 1) + j) * (segments[0] + 1) + i``.

    Raises
    ------
    Error
        ``invalid_options`` unless lengths are positive and there are 1 to 512 segments along each axis.
    """
    sides = [whole("each of segments", side) for side in segments]
    if len(sides) != 3:
        raise ValueError(f"segments must be three whole numbers, not {segments!r}")
    return TetrahedralMesh(*_core.make_solid_box(vector("size", size), (sides[0], sides[1], sides[2])))


@dataclass(frozen=True)
class Tetrahedralization:
    """The result of :func:`tetrahedralize`.

    Attributes
    ----------
    mesh
        The body; it is valid, and every vertex is used.
    size
        The size with which the lattice was made.
    removed_tetrahedra
        The number of tetrahedra left out because parts of the body would have met only in an edge or a vertex.
    """

    mesh: TetrahedralMesh
    size: float
    removed_tetrahedra: int


def tetrahedralize(
    model: ExactMap,
    *,
    size: float | None = None,
    count: int | None = None,
    most_tetrahedra: int = 10_000_000,
    threads: int = 0,
) -> Tetrahedralization:
    """Fills the inside of an exact map with tetrahedra, by isosurface stuffing (Labelle and Shewchuk 2007).

    The boundary is closed, manifold, and does not intersect itself; the extreme dihedral angles are 9.3 and 161.7
    degrees. A part thinner than ``size`` is lost or torn. docs/tetrahedra.md describes the method and its
    guarantees.

    Parameters
    ----------
    model
        The map of a surface; if the surface is open, the winding number decides what is inside.
    size
        The edge of the lattice's cubes, in the model's unit. Set either this or ``count``; 0: not set (not
        negative).
    count
        The target number of tetrahedra: the size is found by trial.
    most_tetrahedra
        The largest number of tetrahedra; more are rejected.
    threads
        Threads to use; 0: all cores. The result does not depend on it.

    Raises
    ------
    ValueError
        Not exactly one of size and count is given.
    Error
        ``invalid_options`` for a size that is too small or not finite; ``invalid_mesh`` when no tetrahedron of
        that size fits into the model.
    """
    options = locals()
    if (size is None) == (count is None):
        raise ValueError("give either size or count")
    arrays, found, removed = _core.tetrahedralize(of_kind("model", model, ExactMap)._built, options)
    return Tetrahedralization(TetrahedralMesh(*arrays), found, removed)


def require_valid_tetrahedra(mesh: TetrahedralMesh) -> None:
    """Raises an error unless all tetrahedra have positive volumes, and any two with a common face lie on opposite sides
    of it.

    Unused vertices may have any values. The signs of volumes are exact.

    Raises
    ------
    Error
        ``invalid_mesh``, naming the first invalid tetrahedron or vertex.
    """
    _core.require_valid_tetrahedra(*_arrays_of(mesh))


def boundary(mesh: TetrahedralMesh) -> Mesh:
    """The faces that belong to only one tetrahedron, oriented outwards. The mesh has all vertices of the body,
    including interior ones.

    Raises
    ------
    Error
        ``invalid_mesh`` when an index is out of range, or two tetrahedra lie on the same side of a face.
    """
    return Mesh(*_core.boundary(*_arrays_of(mesh)))


@dataclass(frozen=True)
class TetrahedralReport:
    """The properties of a body.

    Attributes
    ----------
    vertex_count
        The number of vertices that tetrahedra use.
    volume, least_volume
        The volume of all tetrahedra, and that of the smallest one.
    least_angle_deg, greatest_angle_deg
        The smallest and the largest angle between two faces of a tetrahedron.
    boundary
        The report of :func:`inspect` on the result of :func:`boundary`.
    """

    tetrahedron_count: int
    vertex_count: int
    volume: float
    least_volume: float
    shortest_edge: float
    longest_edge: float
    least_angle_deg: float
    greatest_angle_deg: float
    boundary: MeshReport


def inspect_tetrahedra(mesh: TetrahedralMesh) -> TetrahedralReport:
    """Examines a body.

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`require_valid_tetrahedra` does.
    """
    report = _core.inspect_tetrahedra(*_arrays_of(mesh))
    report["boundary"] = report_of(report["boundary"])
    return TetrahedralReport(**report)


@dataclass(frozen=True)
class BoundaryDistance:
    """The distances between the boundary of a body and the surface of a model, at samples on both."""

    mean_to_model: float
    greatest_to_model: float
    mean_to_boundary: float
    greatest_to_boundary: float


def measure_distance(mesh: TetrahedralMesh, model: ExactMap, *, threads: int = 0) -> BoundaryDistance:
    """Measures the distances between a body's boundary and a model, at the corners of the faces of both and at points
    between the corners."""
    core = of_kind("model", model, ExactMap)._built
    return BoundaryDistance(*_core.measure_distance(*_arrays_of(mesh), core, threads_of(threads)))


class Embedding:
    """The positions of points relative to a body, so that the points can follow its vertices; :func:`embed` makes
    one."""

    _embedding: _core.Embedding

    def __init__(self) -> None:
        raise TypeError("use echinus.embed()")

    def carry(
        self, positions: ArrayLike, *, out: NDArray[np.float32] | None = None, threads: int = 1
    ) -> NDArray[np.float32]:
        """Computes the positions of the points after the body's vertices have moved.

        Parameters
        ----------
        positions : array_like (vertex_count, 3)
            Positions of the body's vertices: if a simulation also has other particles, a slice of its positions.
        out : ndarray (n, 3) of float32, optional
            Receives the answers.

        Returns
        -------
        ndarray (n, 3) of float32
        """
        return self._embedding.carry(positions, out, threads_of(threads))

    @property
    def vertices(self) -> NDArray[np.uint32]:
        """(n, 4) The corners of each point's tetrahedron, in a new array."""
        return self._embedding.vertices

    @property
    def weights(self) -> NDArray[np.float32]:
        """(n, 4) The weights of these corners. They sum to 1; if the point is outside the tetrahedron, some are
        negative."""
        return self._embedding.weights

    def __len__(self) -> int:
        return self._embedding.size

    def __repr__(self) -> str:
        return f"<echinus.Embedding: {len(self)} points>"


def embed(mesh: TetrahedralMesh, points: ArrayLike, *, threads: int = 0) -> Embedding:
    """Finds for each point the tetrahedron that contains it, or else the nearest one, and the weights of its corners.

    Parameters
    ----------
    points : array_like (n, 3)
        The points; they must be finite.

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`require_valid_tetrahedra` does, for a point that is not finite, and for a body so far
        from 0 that its vertices are float64.
    """
    embedding = Embedding.__new__(Embedding)
    embedding._embedding = _core.embed(*_arrays_of(mesh), points, threads_of(threads))
    return embedding


def _arrays_of(mesh: TetrahedralMesh) -> tuple[NDArray[np.float32] | NDArray[np.float64], NDArray[np.uint32]]:
    of_kind("mesh", mesh, TetrahedralMesh, "; tetrahedralize() makes one from a surface")
    return mesh.vertices, mesh.tetrahedra
