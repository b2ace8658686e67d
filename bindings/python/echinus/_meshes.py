"""Meshes: files, reports, repair, generators, and brute-force references."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import flag, number, path_of, threads_of, vector, whole

Path = str | os.PathLike[str]

_MOST_LAYERS = 256


@runtime_checkable
class MeshLike(Protocol):
    """Anything with ``vertices`` and ``faces``, for instance a mesh of trimesh or of Open3D's tensor API."""

    @property
    def vertices(self) -> Any:
        """array_like (n, 3) Positions."""

    @property
    def faces(self) -> Any:
        """array_like (m, 3) Whole numbers: the vertices of each triangle, counter-clockwise seen from outside."""


class Mesh:
    """Triangles with shared vertices.

    Parameters
    ----------
    vertices : array_like (n, 3)
        Positions, rounded to float32 if float32 can represent the shape. It cannot if the mesh is far from 0, such as a
        building in geographic coordinates; positions then stay float64.
    faces : array_like (m, 3)
        Whole numbers: the vertices of each triangle, counter-clockwise seen from outside.

    Attributes
    ----------
    vertices : ndarray (n, 3) of float32 or float64, read-only
    faces : ndarray (m, 3) of uint32, read-only

    Notes
    -----
    Contiguous arrays of these types are shared, not copied: do not change them while the mesh is in use. A
    mesh may have any fault; :func:`inspect` reports them.
    """

    vertices: NDArray[np.float32] | NDArray[np.float64]
    faces: NDArray[np.uint32]

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        self.faces = read_only(_core.face_array(faces))
        self.vertices = read_only(_core.vertex_array(vertices, self.faces))

    def __repr__(self) -> str:
        return f"<echinus.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Mesh, (self.vertices, self.faces)


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    view = array.view(np.ndarray)
    view.flags.writeable = False
    return view


def as_mesh(mesh: MeshLike) -> Mesh:
    """The mesh itself, or a :class:`Mesh` of its ``vertices`` and ``faces``.

    Raises
    ------
    TypeError
        The object does not have these attributes.
    """
    return _mesh_of(mesh, "mesh")


def arrays_of(given: MeshLike, name: str = "mesh") -> tuple[NDArray[np.float32] | NDArray[np.float64], NDArray[np.uint32]]:
    mesh = _mesh_of(given, name)
    return mesh.vertices, mesh.faces


def _mesh_of(given: MeshLike, name: str) -> Mesh:
    if isinstance(given, Mesh):
        return given
    if not isinstance(given, MeshLike):
        raise TypeError(
            f"{name} must have .vertices and .faces, which {type(given).__name__} has not: use echinus.Mesh(vertices, faces), or echinus.read_mesh(path) for a file"
        )
    return Mesh(given.vertices, given.faces)


def read_mesh(path: Path) -> Mesh:
    """Reads OBJ, PLY, STL, OFF, glTF, GLB or 3DS, depending on the file name's extension.

    All meshes of the file are joined, polygons are triangulated, equal positions are welded and vertices that
    no face uses are dropped. Nothing is repaired.

    Raises
    ------
    Error
        ``unreadable``, ``wrong_format``, ``damaged`` or ``invalid_mesh``; the message begins with the path.
    """
    return Mesh(*_core.read_mesh(path_of(path)))


def write_mesh(path: Path, mesh: MeshLike, *, original: Path | None = None) -> None:
    """Writes OBJ, PLY, STL or OFF, depending on the file name's extension. The file is written atomically.

    Parameters
    ----------
    original
        The OBJ file from which the mesh was read before its vertices moved: polygons, texture coordinates, groups and
        materials then stay as they are in it. If either file is no OBJ, or if the new file would be read as other faces, as
        when polygons of more than four corners are divided differently in their new shape, only triangles are written, and
        a :class:`RuntimeWarning` says so.

    Raises
    ------
    Error
        ``unwritable``, ``wrong_format`` for any other extension, or ``invalid_mesh``, also for another number of vertices
        than in the original.
    """
    if original is None:
        _core.write_mesh(path_of(path), *arrays_of(mesh))
    elif not _core.write_moved_mesh(path_of(path), *arrays_of(mesh), path_of(original, "original")):
        warnings.warn(f"{path}: triangles were written, without the other statements of {original}", RuntimeWarning, stacklevel=2)


@dataclass(frozen=True)
class Fault:
    """The number of occurrences of a fault, and the first few faces at which it occurs."""

    count: int
    first_faces: tuple[int, ...]


@dataclass(frozen=True)
class MeshReport:
    """The properties of a mesh.

    Attributes
    ----------
    closed
        Every edge is balanced: the same number of faces traverse it in either direction. Vertices of unbalanced edges
        count as one if they are at most 2^-21 of the radius apart, as in all maps.
    manifold
        Every edge has at most two faces, and the faces at each vertex form one fan.
    orientable
        Faces can be flipped so that neighbours agree about the outside; those of a Moebius strip cannot.
    signed_volume
        Positive if faces point outwards.
    centre, radius
        The smallest sphere that encloses all vertices used by faces.
    rounding_step
        The spacing of float32 at the largest coordinate, if all coordinates are float32 numbers and half of
        this spacing exceeds a step of a map's lattice; otherwise 0. If the coordinates have been rounded to float32,
        the shape is wrong by up to half the spacing.
    """

    face_count: int
    vertex_count: int
    component_count: int
    closed: bool
    manifold: bool
    orientable: bool
    border_edges: Fault
    nonmanifold_edges: Fault
    misoriented_edges: Fault
    duplicate_faces: Fault
    degenerate_faces: Fault
    signed_volume: float
    centre: tuple[float, float, float]
    radius: float
    rounding_step: float


def inspect(mesh: MeshLike) -> MeshReport:
    """Examines a mesh.

    Raises
    ------
    Error
        ``invalid_mesh`` when there is no face, an index is out of range, or a used vertex is not finite.
    """
    return report_of(_core.inspect(*arrays_of(mesh)))


def report_of(values: dict[str, Any]) -> MeshReport:
    return MeshReport(**{key: Fault(**value) if isinstance(value, dict) else value for key, value in values.items()})


def weld(mesh: MeshLike) -> Mesh:
    """Joins vertices at equal positions and drops unused ones. Faces keep their order."""
    return Mesh(*_core.weld(*arrays_of(mesh)))


@dataclass(frozen=True)
class RepairReport:
    """The changes that :func:`repair` made. Faces are identified by their indices in the original mesh; faces that
    close holes have the indices after those.

    Attributes
    ----------
    holes_left
        The number of holes that were too large to be closed, and of rims of sheets; 0 if no holes were to be closed.
    sheets_thickened
        The number of sheets, that is, pieces of surface between rims, that were thickened.
    faces_added
        The number of faces that fill seams, close holes and thicken sheets.
    vertices_welded
        The number of vertices that were replaced by others in all faces.
    slivers_dropped
        Loose slivers, and faces that lost their area by welding.
    faces_turned
        The number of faces that were flipped so that neighbours agree.
    seams_filled
        The number of filled holes of zero width.
    """

    duplicate_faces_dropped: tuple[int, ...]
    doubled_patch_faces_dropped: tuple[int, ...]
    components_flipped: int
    holes_closed: int
    holes_left: int
    inner_faces_dropped: tuple[int, ...]
    sheets_thickened: int
    faces_added: int
    vertices_welded: int
    slivers_dropped: tuple[int, ...]
    faces_turned: int
    seams_filled: int

    @property
    def changed_anything(self) -> bool:
        """Does the copy differ from the given mesh?"""
        dropped = (
            self.duplicate_faces_dropped
            + self.doubled_patch_faces_dropped
            + self.inner_faces_dropped
            + self.slivers_dropped
        )
        return bool(
            dropped or self.components_flipped or self.faces_added or self.vertices_welded or self.faces_turned
        )


def repair(
    mesh: MeshLike,
    *,
    drop_duplicate_faces: bool = True,
    drop_doubled_patches: bool = True,
    flip_inside_out: bool = True,
    close_holes: int = 0,
    drop_inner_faces: bool = False,
    sheet_thickness: float = 0,
    close_seams: bool = True,
    drop_loose_slivers: bool = True,
    orient_faces: bool = True,
    weld_distance: float = 0,
) -> tuple[Mesh, RepairReport]:
    """Makes a copy with the repairs that require no guesswork, and a report of them. A closed mesh stays closed.

    On request, ``close_holes``, ``drop_inner_faces`` and ``sheet_thickness`` make open surfaces and
    assemblies solid by guessing. Seams are welded first; then follow duplicate faces, doubled patches, slivers,
    orientation, the filling of seams, holes, inside-out parts, inner faces and sheets.

    Parameters
    ----------
    mesh
        Vertices are distinguished by index: call :func:`weld` first, or close seams, if vertices at equal positions are
        meant to be one.
    drop_duplicate_faces
        Among faces with the same three vertices, drop opposite ones in pairs, and keep the first of the rest.
    drop_doubled_patches
        Where two pairs of faces fill the same quadrilateral, each along its own diagonal, drop one pair.
    flip_inside_out
        Flip closed parts whose faces point inwards; cavities stay cavities.
    close_holes
        Fill holes whose border has at most this number of edges, with the triangulation of least area. The rim of a
        sheet, whose filling would have more than a third of the sheet's area, is not a hole (0 to 256).
    drop_inner_faces
        Drop faces that have the solid on both sides, such as those of an engine in the body of a car: one patch of
        neighbours at a time, and only if no remaining edge becomes less balanced.
    sheet_thickness
        Thicken open parts into solids of this thickness, half of it on either side; 0: none (not negative).
    close_seams
        Join vertices at the borders of holes that are at most ``weld_distance`` apart, and fill holes that are no
        wider.
    drop_loose_slivers
        Drop faces without area at the borders of holes, unless they fill a seam.
    orient_faces
        Flip faces so that neighbours agree, in parts that are closed by themselves.
    weld_distance
        The width of seams, at most the radius of the bounding sphere. The effective value is at least 2^-21 of the
        radius, within which maps join vertices anyway (not negative).

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`inspect` does; ``invalid_options`` for a number out of range, and for a thickness or
        a weld distance that does not suit the mesh.
    """
    options = locals()
    arrays, report = _core.repair(*arrays_of(mesh), options)
    return Mesh(*arrays), RepairReport(**report)


def winding_number(mesh: MeshLike, points: ArrayLike, *, threads: int = 1) -> NDArray[np.float64]:
    """Generalised winding numbers: 1 inside a closed mesh with outward faces, 0 outside.

    The function visits all faces, in double precision: it is a reference for maps, not a query. The result is
    NaN for a point that is not finite.

    Parameters
    ----------
    points : array_like (..., 3)
    threads
        0: all cores.

    Returns
    -------
    ndarray (...) of float64
    """
    return _core.winding_number(*arrays_of(mesh), points, threads_of(threads))


def unsigned_distance(mesh: MeshLike, points: ArrayLike, *, threads: int = 1) -> NDArray[np.float64]:
    """Distances to the nearest point of the surface, by brute force in double precision: a reference for maps.

    They are infinite for points that are not finite. Parameters and shapes are those of :func:`winding_number`.
    """
    return _core.unsigned_distance(*arrays_of(mesh), points, threads_of(threads))


def intersecting_pairs(a: MeshLike, b: MeshLike) -> NDArray[np.uint32]:
    """The pairs of intersecting faces of ``a`` and ``b``, found by exact tests; faces that touch count as intersecting.

    Returns
    -------
    ndarray (n, 2) of uint32
        The indices of a face of ``a`` and of one of ``b``; the pairs ascend.
    """
    return _core.intersecting_pairs(*arrays_of(a, "a"), *arrays_of(b, "b"))


def self_intersecting_pairs(mesh: MeshLike) -> NDArray[np.uint32]:
    """The pairs of faces of a mesh that intersect other than in shared corners and edges, found by exact tests.

    Returns
    -------
    ndarray (n, 2) of uint32
        The indices of two faces; the pairs ascend.
    """
    return _core.self_intersecting_pairs(*arrays_of(mesh))


@dataclass(frozen=True)
class Intersections:
    """Where surfaces intersect.

    Attributes
    ----------
    pairs : ndarray (n, 2) of uint32
        The pairs of :func:`intersecting_pairs` or :func:`self_intersecting_pairs`.
    curves : tuple of ndarray (k, 3)
        The polylines along which faces cross. Coplanar faces, faces without area and faces that touch in a
        point have no curve.
    closed : tuple of bool
        For each curve: whether a segment joins its last point to its first.
    length
        The total length of all curves.
    """

    pairs: NDArray[np.uint32]
    curves: tuple[NDArray[np.float32] | NDArray[np.float64], ...]
    closed: tuple[bool, ...]
    length: float


def intersections(a: MeshLike, b: MeshLike | None = None) -> Intersections:
    """The intersecting faces of ``a`` and ``b``, or of ``a`` alone, and the curves along which they cross.

    Raises
    ------
    Error
        ``invalid_mesh`` for an invalid mesh, or for more than 33 554 432 pairs of intersecting faces.
    """
    if b is None:
        return Intersections(**_core.self_intersections(*arrays_of(a, "a")))
    return Intersections(**_core.intersections(*arrays_of(a, "a"), *arrays_of(b, "b")))


@dataclass(frozen=True)
class Penetration:
    """How far the vertices of one mesh are inside another.

    Attributes
    ----------
    vertex_count
        The number of vertices inside.
    deepest_vertex
        The index of the deepest vertex; ``None`` if no vertex is inside.
    depth
        The distance of the deepest vertex from the other surface.
    """

    vertex_count: int
    deepest_vertex: int | None
    depth: float


@dataclass(frozen=True)
class CheckedMeshes:
    """A pair of the meshes that were checked, or one mesh and itself.

    Attributes
    ----------
    a, b
        Indices of the meshes; equal for a mesh and itself.
    found
        Their intersections. There are no pairs if one mesh is entirely inside the other.
    a_in_b, b_in_a
        The vertices of one mesh inside the other; ``None`` if the other mesh is not closed or no exact map of it is
        possible, or if both are the same mesh.
    """

    a: int
    b: int
    found: Intersections
    a_in_b: Penetration | None
    b_in_a: Penetration | None


def check(meshes: Sequence[MeshLike], *, threads: int = 0) -> list[CheckedMeshes]:
    """Finds the meshes that intersect each other or themselves, the curves along which they do, and the depths.

    Parameters
    ----------
    meshes
        Open or closed meshes in the same frame.
    threads
        0: all cores.

    Returns
    -------
    list of CheckedMeshes
        The pairs of meshes that intersect, or of which one has a vertex inside the other, and the meshes that intersect
        themselves; ascending by index.

    Raises
    ------
    Error
        ``invalid_mesh``; the message gives the index of the mesh.
    """
    found = _core.check([arrays_of(mesh, f"meshes[{i}]") for i, mesh in enumerate(meshes)], threads_of(threads))
    return [
        CheckedMeshes(a, b, Intersections(**both), *(None if inside is None else Penetration(*inside) for inside in (a_in_b, b_in_a)))
        for a, b, both, a_in_b, b_in_a in found
    ]


@dataclass(frozen=True)
class Parted:
    """A surface after :func:`part`, and what still intersects.

    Attributes
    ----------
    mesh
        The surface with its vertices moved, in their order; of several layers all, joined.
    meshes
        The layers.
    own_pairs
        The intersecting pairs of its own faces, ``(n, 2)`` of uint32.
    model_pairs
        For each model the pairs of a face of the surface and a face of the model.
    inside
        The vertices that are inside a closed model, ascending.
    largest_displacement
        That of a vertex.
    stretched_share
        The share of edges whose length changed by more than 5 %.
    largest_stretch
        The largest length of an edge over its length before, minus 1.
    """

    mesh: Mesh
    meshes: tuple[Mesh, ...]
    own_pairs: NDArray[np.uint32]
    model_pairs: tuple[NDArray[np.uint32], ...]
    inside: NDArray[np.uint32]
    largest_displacement: float
    stretched_share: float
    largest_stretch: float

    @property
    def is_apart(self) -> bool:
        """Whether nothing intersects and no vertex is inside a model."""
        return len(self.own_pairs) == 0 and len(self.inside) == 0 and all(len(pairs) == 0 for pairs in self.model_pairs)


def _joined(meshes: Sequence[MeshLike]) -> Mesh:
    arrays = [arrays_of(mesh, f"mesh[{i}]") for i, mesh in enumerate(meshes)]
    firsts = np.cumsum([0] + [len(vertices) for vertices, _ in arrays[:-1]])
    return Mesh(
        np.concatenate([vertices for vertices, _ in arrays]),
        np.concatenate([faces + np.uint32(first) for (_, faces), first in zip(arrays, firsts)]),
    )


def _divided(joined: Mesh, meshes: Sequence[MeshLike]) -> tuple[Mesh, ...]:
    """The meshes with the positions of the joined one."""
    parts = np.split(joined.vertices, np.cumsum([len(as_mesh(mesh).vertices) for mesh in meshes])[:-1])
    return tuple(Mesh(vertices, as_mesh(mesh).faces) for vertices, mesh in zip(parts, meshes))


def part(
    mesh: MeshLike | Sequence[MeshLike],
    models: Sequence[MeshLike] = (),
    *,
    thickness: float | None = None,
    pinned: ArrayLike | None = None,
    threads: int = 1,
) -> Parted:
    """Moves a surface such as a garment, with little stretch, out of models and its layers out of each other.

    If it cannot be parted, for instance because it is knotted or the models leave no room, the result has the fewest
    intersections found. It may take minutes for 10 000 vertices on a detailed model.

    Parameters
    ----------
    mesh
        The surface; at most two faces meet at an edge. Or several, the layers from the inside to the outside: each moves to
        the outer side of those before it, which is the one that faces away from the closed models, or without any, the one
        to which the normals of their faces point.
    models
        Open or closed meshes that stay; an open one has no inside. They may intersect themselves and each other.
    thickness
        Distance above 0 from which contact pushes the surface off the models, at most four mean edge lengths; by default a
        tenth. It is less where the material presses. A surface that does not intersect anything is returned as it is.
    pinned
        For each vertex of all layers, true if it stays where it is; ``None``: no vertex is pinned. One inside a model cannot
        be parted.
    threads
        0: all cores. The result does not depend on it.

    Raises
    ------
    Error
        ``invalid_mesh``; for a model the message gives its index. ``invalid_options``
    """
    if isinstance(models, MeshLike) or not isinstance(models, Sequence):
        raise TypeError("models must be a list of meshes, such as [body]")
    pins = [] if pinned is None else list(pinned) if isinstance(pinned, (Sequence, np.ndarray)) else [None]
    if not all(isinstance(pin, (bool, np.bool_)) for pin in pins):
        raise TypeError("pinned must be an array of booleans, one for each vertex")
    meshes: Sequence[MeshLike] = [mesh] if isinstance(mesh, MeshLike) else mesh
    if not isinstance(meshes, Sequence) or len(meshes) == 0 or len(meshes) > _MOST_LAYERS:
        raise TypeError(f"mesh must be a mesh or a list of 1 to {_MOST_LAYERS} meshes")
    surface = _joined(meshes)
    layers = [i for i, layer in enumerate(meshes) for _ in range(len(as_mesh(layer).vertices))] if len(meshes) > 1 else []
    moved, own_pairs, model_pairs, inside, displacement, stretched_share, largest_stretch = _core.part(
        *arrays_of(surface),
        [arrays_of(model, f"models[{i}]") for i, model in enumerate(models)],
        (None if thickness is None else number("thickness", thickness), [int(pin) for pin in pins], layers),
        threads_of(threads),
    )
    joined = Mesh(*moved)
    return Parted(
        joined,
        _divided(joined, meshes),
        own_pairs,
        model_pairs,
        inside.astype(np.uint32),
        displacement,
        stretched_share,
        largest_stretch,
    )


def make_torus(
    major_radius: float = 1, minor_radius: float = 0.4, major_segments: int = 60, minor_segments: int = 24
) -> Mesh:
    """A torus about the z axis."""
    return Mesh(
        *_core.make_torus(
            number("major_radius", major_radius),
            number("minor_radius", minor_radius),
            whole("major_segments", major_segments),
            whole("minor_segments", minor_segments),
        )
    )


def make_sphere(radius: float = 1, meridian_count: int = 60, parallel_count: int = 30) -> Mesh:
    """A sphere of ``parallel_count`` rows of faces, with its poles on the z axis."""
    return Mesh(
        *_core.make_sphere(
            number("radius", radius), whole("meridian_count", meridian_count), whole("parallel_count", parallel_count)
        )
    )


def make_box(size: tuple[float, float, float] = (1, 1, 1), segments: int = 1) -> Mesh:
    """A box around the origin, with each side divided into ``segments`` x ``segments`` squares."""
    return Mesh(*_core.make_box(vector("size", size), whole("segments", segments)))
