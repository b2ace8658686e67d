"""The samples of one mesh and their labels."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from echinus._arguments import flag, number, numbers, of_kind, one_of, whole
from echinus._errors import Error
from echinus._maps import ExactMap
from echinus._meshes import Mesh, MeshLike, as_mesh, inspect, repair
from echinus.corpus._random import Random

Frame = Literal["cube", "sphere", "none"]
Stored = Literal["float16", "float32"]
_LARGEST = 1e30  # the largest length: its square is far from overflow, and float32 can represent it


class Refused(Exception):
    """A mesh gets no labels; the text gives the reason.

    Attributes
    ----------
    again : bool
        Whether another attempt may succeed, because the cause is the machine, not the mesh.
    """

    def __init__(self, reason: str, *, again: bool = False) -> None:
        super().__init__(reason)
        self.again = again


@dataclass(frozen=True)
class Sampling:
    """The samples to draw, and their frame.

    Attributes
    ----------
    uniform
        Number of points in the box of the frame: [-0.5, 0.5]^3 for ``"cube"`` and the bounding box for ``"none"``, enlarged on
        each side by half the padding. For ``"sphere"`` the box is [-1, 1]^3, without padding.
    near
        Number of points near the surface: points of the surface that are moved by normally distributed offsets, with equal
        numbers for each sigma.
    sigmas
        Standard deviations of an offset along each axis, in the frame.
    surface
        Number of points on the surface, evenly distributed by area, with the normals of their faces.
    frame
        point_in_frame = (point - loc) / scale. ``"cube"``: the bounding box is centred and its longest edge is 1. ``"sphere"``:
        the bounding box is centred and the farthest vertex has the distance 1 / 1.03 from 0, as in DeepSDF. ``"none"``: the frame
        of the mesh.
    padding
        Padding of the box of uniform points, as a share of its edge; the sum of both sides.
    dtype
        The type in which points are stored. Labels are those of the stored points.
    distances
        Also compute signed distances and nearest points. Without them a closed mesh takes a tenth of the time.
    repair
        Make the repairs that require no guesswork, as :func:`echinus.repair` does.
    close_holes, drop_inner_faces
        Make meshes solid, as the arguments of :func:`echinus.repair` with these names do, in its order.
    thicken
        Also makes meshes solid: the thickness of the solids that replace sheets, as a share of the longest edge of the
        mesh's bounding box.
    min_certain
        Meshes with a smaller share of certain labels are refused.
    max_faces
        Meshes with more faces are refused.
    time_limit
        Seconds for the labels of a mesh, which is refused if they take longer.
    seed
        The seed of the samples, which otherwise depend only on the vertices and faces.
    """

    uniform: int = 50_000
    near: int = 50_000
    sigmas: Sequence[float] = (0.01, 0.05)
    surface: int = 10_000
    frame: Frame = "cube"
    padding: float = 0.1
    dtype: Stored = "float32"
    distances: bool = True
    repair: bool = True
    close_holes: int = 0
    drop_inner_faces: bool = False
    thicken: float = 0.0
    min_certain: float = 0.0
    max_faces: int = 5_000_000
    time_limit: float = 600.0
    seed: int = 0

    def __post_init__(self) -> None:
        def checked(check: Callable[..., Any], *names: str, bounds: tuple[int, ...] = ()) -> None:
            for name in names:
                object.__setattr__(self, name, check(name, getattr(self, name), *bounds))

        checked(whole, "uniform", "near", "surface", "max_faces")
        checked(whole, "close_holes", bounds=(0, 256))
        checked(whole, "seed", bounds=(0, 2**63 - 1))
        checked(number, "padding", "thicken", "min_certain", "time_limit")
        checked(flag, "distances", "repair", "drop_inner_faces")
        checked(numbers, "sigmas")
        one_of("frame", self.frame, get_args(Frame))
        one_of("dtype", self.dtype, get_args(Stored))
        for name, most in (("padding", _LARGEST), ("thicken", 0.5), ("min_certain", 1)):
            if not 0 <= getattr(self, name) <= most:
                raise ValueError(f"{name} must be a number from 0 to {most:g}, not {getattr(self, name)}")
        if (self.near and not self.sigmas) or not all(0 < sigma <= _LARGEST for sigma in self.sigmas):
            raise ValueError(f"sigmas must be positive numbers up to {_LARGEST:g}, not {self.sigmas}")
        if not self.time_limit > 0:
            raise ValueError(f"time_limit must be a positive number of seconds, not {self.time_limit}")

    @property
    def makes_solid(self) -> bool:
        return bool(self.close_holes or self.drop_inner_faces or self.thicken)


@dataclass(frozen=True)
class Samples:
    """The samples of a mesh, in its frame: first the uniform ones, then those near the surface.

    Attributes
    ----------
    points : ndarray (n, 3)
    occupancy : ndarray (n) of bool
    distance : ndarray (n) of float32
        Signed distances, negative inside; empty without ``Sampling.distances``.
    nearest : ndarray (n, 3) of float32
        The nearest points of the surface; empty without ``Sampling.distances``.
    certain : ndarray (n) of bool
        False if the mesh is open and its generalised winding number is within 0.1 of the threshold between inside and
        outside.
    surface, normals : ndarray (m, 3)
        Points of the surface, and unit normals of their faces.
    loc, scale
        point_in_frame = (point - loc) / scale
    report
        The properties of the mesh and of its labels.
    """

    points: NDArray[np.floating[Any]]
    occupancy: NDArray[np.bool_]
    distance: NDArray[np.float32]
    nearest: NDArray[np.float32]
    certain: NDArray[np.bool_]
    surface: NDArray[np.floating[Any]]
    normals: NDArray[np.floating[Any]]
    loc: NDArray[np.float64]
    scale: float
    report: dict[str, Any]


def sample(mesh: MeshLike, sampling: Sampling = Sampling()) -> Samples:
    """Samples around a mesh, with their labels.

    Raises
    ------
    Refused
        The mesh is too large, takes too long or has no extent, or too few of its labels are certain.
    Error
        ``invalid_mesh``.
    """
    mesh = as_mesh(mesh)
    if len(mesh.faces) > of_kind("sampling", sampling, Sampling).max_faces:
        raise Refused(f"it has {len(mesh.faces)} faces; at most {sampling.max_faces} are accepted")
    key = hashlib.sha256(b"%d/" % len(mesh.vertices))
    key.update(np.ascontiguousarray(mesh.vertices, "<f4").data)
    key.update(np.ascontiguousarray(mesh.faces, "<u4").data)
    mesh, report = _mended(mesh, sampling)
    framed, loc, scale = _in_frame(mesh, sampling.frame)

    def random(purpose: str) -> Random:
        return Random(key.digest() + f"{sampling.seed}/{purpose}".encode())

    surface = _Surface(framed)
    parts = [_uniform_points(framed, sampling, random("uniform"))]
    for i, sigma in enumerate(sampling.sigmas if sampling.near else ()):
        share = sampling.near * (i + 1) // len(sampling.sigmas) - sampling.near * i // len(sampling.sigmas)
        on_surface, _ = surface.points(share, random(f"near {i}"))
        parts.append(on_surface + sigma * random(f"offset {i}").normal(share, 3))
    cloud, cloud_faces = surface.points(sampling.surface, random("surface"))
    points, cloud = _stored(np.concatenate(parts), sampling), _stored(cloud, sampling)
    labels = _labels(framed, points, report["closed"], sampling)
    certain_share = float(labels.certain.mean()) if len(points) else 1.0
    if certain_share < sampling.min_certain:
        raise Refused(f"only {100 * certain_share:.3g} % of its labels are certain")
    report |= {"inside": int(labels.occupancy.sum()), "certain": certain_share, "loc": loc.tolist(), "scale": scale}
    return Samples(
        points=points,
        occupancy=labels.occupancy,
        distance=labels.distance,
        nearest=labels.nearest,
        certain=labels.certain,
        surface=cloud,
        normals=surface.normals(cloud_faces).astype(sampling.dtype),
        loc=loc,
        scale=scale,
        report=report,
    )


def _stored(points: NDArray[np.float64], sampling: Sampling) -> NDArray[np.floating[Any]]:
    with np.errstate(over="ignore"):
        stored: NDArray[np.floating[Any]] = points.astype(sampling.dtype)
    if not np.isfinite(stored).all():
        raise Refused(f"its points do not fit into {sampling.dtype}")
    return stored


def _mended(mesh: Mesh, sampling: Sampling) -> tuple[Mesh, dict[str, Any]]:
    report: dict[str, Any] = {"faces": len(mesh.faces)}
    if sampling.repair or sampling.makes_solid:
        mesh, done = repair(
            mesh,
            drop_duplicate_faces=sampling.repair,
            drop_doubled_patches=sampling.repair,
            flip_inside_out=sampling.repair,
            close_seams=sampling.repair,
            drop_loose_slivers=sampling.repair,
            orient_faces=sampling.repair,
            close_holes=sampling.close_holes,
            drop_inner_faces=sampling.drop_inner_faces,
            sheet_thickness=sampling.thicken * _longest_edge(mesh) if sampling.thicken else 0.0,
        )
        report["repaired"] = {
            "duplicate_faces_dropped": len(done.duplicate_faces_dropped),
            "doubled_patch_faces_dropped": len(done.doubled_patch_faces_dropped),
            "components_flipped": done.components_flipped,
            "vertices_welded": done.vertices_welded,
            "slivers_dropped": len(done.slivers_dropped),
            "faces_turned": done.faces_turned,
            "seams_filled": done.seams_filled,
        }
        if sampling.makes_solid:
            report["made_solid"] = {
                "holes_closed": done.holes_closed,
                "holes_left": done.holes_left,
                "inner_faces_dropped": len(done.inner_faces_dropped),
                "sheets_thickened": done.sheets_thickened,
                "faces_added": done.faces_added,
            }
    found = inspect(mesh)
    report |= {
        "closed": found.closed,
        "border_edges": found.border_edges.count,
        "misoriented_edges": found.misoriented_edges.count,
        "components": found.component_count,
    }
    return mesh, report


def _used_vertices(mesh: Mesh) -> NDArray[np.float64]:
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    vertices: NDArray[np.float64] = mesh.vertices[used].astype(np.float64)
    return vertices


def _longest_edge(mesh: Mesh) -> float:
    """The longest edge of the bounding box."""
    inspect(mesh)  # raises an error if there is none
    used = _used_vertices(mesh)
    return float((used.max(axis=0) - used.min(axis=0)).max())


def _in_frame(mesh: Mesh, frame: Frame) -> tuple[Mesh, NDArray[np.float64], float]:
    if frame == "none":
        return mesh, np.zeros(3), 1.0
    used = _used_vertices(mesh)
    low, high = used.min(axis=0), used.max(axis=0)
    loc = (low + high) / 2
    around = used - loc
    farthest = np.sqrt((around[:, 0] ** 2 + around[:, 1] ** 2 + around[:, 2] ** 2).max())
    scale = float((high - low).max() if frame == "cube" else 1.03 * farthest)
    if not 1 / _LARGEST < scale < _LARGEST:
        raise Refused(f"its extent is {scale:.3g}; it must be between {1 / _LARGEST:g} and {_LARGEST:g}")
    return Mesh((mesh.vertices.astype(np.float64) - loc) / scale, mesh.faces), loc, scale


def _uniform_points(mesh: Mesh, sampling: Sampling, random: Random) -> NDArray[np.float64]:
    if sampling.frame == "none":
        used = _used_vertices(mesh)
        low, high = used.min(axis=0), used.max(axis=0)
        low, high = low - (high - low) * sampling.padding / 2, high + (high - low) * sampling.padding / 2
    else:
        half = 1.0 if sampling.frame == "sphere" else 0.5 + sampling.padding / 2
        low, high = np.full(3, -half), np.full(3, half)
    points: NDArray[np.float64] = low + (high - low) * random.uniform(sampling.uniform, 3)
    return points


class _Surface:
    """Draws points of the surface of a mesh, evenly by area."""

    def __init__(self, mesh: Mesh) -> None:
        a, b, c = (mesh.vertices[mesh.faces[:, k]].astype(np.float64) for k in range(3))
        self._corners = [np.ascontiguousarray(corner.T) for corner in (a, b, c)]
        u, v = b - a, c - a
        self._normal = np.stack([u[:, k - 2] * v[:, k - 1] - u[:, k - 1] * v[:, k - 2] for k in range(3)], axis=1)
        self._area = np.sqrt(self._normal[:, 0] ** 2 + self._normal[:, 1] ** 2 + self._normal[:, 2] ** 2)
        self._total = np.cumsum(self._area)
        self._bins = 1 << min(1 + len(self._area).bit_length(), 18)
        self._face_of_bin = self._face_at(np.arange(self._bins) / self._bins * self._total[-1])

    def points(self, count: int, random: Random) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
        """Points and their faces."""
        if count == 0:
            return np.zeros((0, 3)), np.zeros(0, np.intp)
        if not self._total[-1] > 0:
            raise Refused("its surface has no area")
        face = self._find(random.uniform(count))
        root, share = np.sqrt(random.uniform(count)), random.uniform(count)
        weights = (1 - root, root * (1 - share), root * share)
        points = np.empty((count, 3))
        for k in range(3):
            a, b, c = (weight * corner[k].take(face) for weight, corner in zip(weights, self._corners))
            points[:, k] = a + b + c
        return points, face

    def _find(self, share: NDArray[np.float64]) -> NDArray[np.intp]:
        """The faces at shares of the area in [0, 1): usually the face at which the share's bin begins, which needs no
        search."""
        face = self._face_of_bin.take((share * self._bins).astype(np.intp))
        area = share * self._total[-1]
        beyond = np.flatnonzero(self._total.take(face) <= area)
        face[beyond] = self._face_at(area[beyond])
        return face

    def _face_at(self, area: NDArray[np.float64]) -> NDArray[np.intp]:
        return np.minimum(np.searchsorted(self._total, area, side="right"), len(self._area) - 1)

    def normals(self, faces: NDArray[np.intp]) -> NDArray[np.float64]:
        area = self._area[faces]
        normals: NDArray[np.float64] = self._normal[faces] / np.where(area > 0, area, 1)[:, None]
        return normals


@dataclass(frozen=True)
class _Labels:
    """As in :class:`Samples`."""

    occupancy: NDArray[np.bool_]
    certain: NDArray[np.bool_]
    distance: NDArray[np.float32]
    nearest: NDArray[np.float32]


def _labels(mesh: Mesh, points: NDArray[np.floating[Any]], closed: bool, sampling: Sampling) -> _Labels:
    """Computes labels in calls of a few seconds, so that the time limit takes effect. The first call is small, since queries of
    soups of triangles are a thousand times as slow."""
    end = time.monotonic() + sampling.time_limit
    try:
        exact = ExactMap(mesh, threads=1)
    except Error as error:
        raise Refused(str(error)) from error
    far = len(points) if sampling.distances else 0
    labels = _Labels(np.empty(len(points), bool), np.ones(len(points), bool), np.empty(far, np.float32), np.empty((far, 3), np.float32))
    first, count = 0, 1024
    while first < len(points):
        began = time.monotonic()
        if began > end:
            raise Refused(f"its labels take longer than {sampling.time_limit:g} s", again=True)
        _fill(labels, slice(first, min(first + count, len(points))), exact, points, closed, sampling.distances)
        first += count
        count = max(64, int(count * min(1024.0, 2.0 / max(time.monotonic() - began, 1e-6))))
    return labels


def _fill(labels: _Labels, part: slice, exact: ExactMap, points: NDArray[np.floating[Any]], closed: bool, distances: bool) -> None:
    """Computes some of the labels. For a closed mesh, inside or outside takes a tenth of the time of contacts, and all answers
    are certain."""
    if closed and not distances:
        exact.contains(points[part], out=labels.occupancy[part])
        return
    contacts = exact.contacts(points[part], np.inf if distances else 0)
    labels.occupancy[part], labels.certain[part] = contacts.inside, contacts.certain
    if distances:
        labels.distance[part], labels.nearest[part] = -contacts.depth, contacts.point
