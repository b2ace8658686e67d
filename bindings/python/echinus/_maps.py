"""Maps and their answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic, Literal, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import flag, json_of, number, of_kind, path_of, threads_of
from echinus._meshes import MeshLike, Path, arrays_of

Scalar = TypeVar("Scalar", bound=np.generic)
CoreMap = TypeVar("CoreMap", _core.ExactMap, _core.DistanceMap)


class _Answers:
    """One answer for each point, in a structured array. The properties are views of its fields."""

    def __init__(self, array: NDArray[np.void], origin: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        self.array = array
        self._origin = origin

    def __len__(self) -> int:
        return len(self.array)

    def __repr__(self) -> str:
        return f"<echinus.{type(self).__name__}: {self.array.size} answers of shape {self.array.shape}>"

    def _field(self, name: str, kind: type[Scalar]) -> NDArray[Scalar]:
        field: NDArray[Scalar] = self.array[name]
        return field

    def _place(self) -> NDArray[np.float32] | NDArray[np.float64]:
        place: NDArray[np.float32] = self.array["point"]
        return place + np.array(self._origin) if any(self._origin) else place


class Contacts(_Answers):
    """One contact for each point.

    A point that is outside and farther away than the margin, or not finite, has no contact: depth 0, normal 0, face -1,
    and its own position as ``point``.

    Attributes
    ----------
    array : ndarray (...)
        The contacts as a structured array, whose field ``point`` is relative to the map's origin.
    """

    @property
    def inside(self) -> NDArray[np.bool_]:
        """(...) Is the point inside?"""
        return self._field("inside", np.bool_)

    @property
    def depth(self) -> NDArray[np.float32]:
        """(...) Distance to ``point``: positive inside, negative outside, 0 without a contact."""
        return self._field("depth", np.float32)

    @property
    def normal(self) -> NDArray[np.float32]:
        """(..., 3) Outward unit normal of the surface at ``point``; 0 without a contact."""
        return self._field("normal", np.float32)

    @property
    def point(self) -> NDArray[np.float32] | NDArray[np.float64]:
        """(..., 3) The target of the push-out: the nearest point of the surface or, with a distance map, a surface
        point on the particle's ray from the centre. The type is float64 if the map's :attr:`origin` is not 0."""
        return self._place()

    @property
    def face(self) -> NDArray[np.int32]:
        """(...) The face of the mesh that contains ``point``; -1 without a contact, and with a distance map."""
        return self._field("face", np.int32)

    @property
    def certain(self) -> NDArray[np.bool_]:
        """(...) With an exact map, false for a point with NaN, and if the mesh is open and its generalised winding
        number is within 0.1 of a threshold between inside and outside, such as one half. Always true with a distance
        map."""
        return self._field("certain", np.bool_)

    @property
    def feature(self) -> NDArray[np.uint8]:
        """(...) The part of the face that is nearest: 1 its interior, 2 an edge, 3 a vertex; 0 if it is not known."""
        return self._field("feature", np.uint8)

    @property
    def found(self) -> NDArray[np.bool_]:
        """(...) Is there a contact? The point is then inside, or outside within the margin."""
        found: NDArray[np.bool_] = self.inside | (self.normal != 0).any(axis=-1)
        return found


class SweepHits(_Answers):
    """The first crossing of each segment with the surface.

    A segment without a crossing has fraction 1, normal 0, face -1, and its end as ``point``.

    Attributes
    ----------
    array : ndarray (...)
        The hits as a structured array, whose field ``point`` is relative to the map's origin.
    """

    @property
    def fraction(self) -> NDArray[np.float32]:
        """(...) The position on the segment: 0 at the start, 1 at the end."""
        return self._field("fraction", np.float32)

    @property
    def point(self) -> NDArray[np.float32] | NDArray[np.float64]:
        """(..., 3) start + fraction (end - start). The type is float64 if the map's origin is not 0."""
        return self._place()

    @property
    def normal(self) -> NDArray[np.float32]:
        """(..., 3) Outward unit normal of the face."""
        return self._field("normal", np.float32)

    @property
    def face(self) -> NDArray[np.int32]:
        """(...) The index of the crossed face in the mesh."""
        return self._field("face", np.int32)

    @property
    def entering(self) -> NDArray[np.bool_]:
        """(...) Does the crossing lead from outside to inside?"""
        return self._field("entering", np.bool_)

    @property
    def found(self) -> NDArray[np.bool_]:
        """(...) Is there a crossing?"""
        found: NDArray[np.bool_] = self.face >= 0
        return found


@dataclass(frozen=True)
class ExactMapStatistics:
    """The statistics of the build of an exact map.

    Attributes
    ----------
    dropped_faces
        Faces without area on the map's lattice; they are used for distances only.
    longest_list, mean_list
        The largest and the mean number of faces in a band.
    expected_tests
        Expected number of faces that ``contains`` tests for a point on the surface; about 10 for most meshes.
    certain_share
        Share of the bounding sphere's volume in which the map stores the answer; 1 for a closed mesh.
    uncertain_directions
        Share of the directions from the centre in which, at some distance, the answer is computed instead of stored.
    """

    face_count: int
    dropped_faces: int
    longest_list: int
    mean_list: float
    expected_tests: float
    certain_share: float
    uncertain_directions: float


@dataclass(frozen=True)
class DistanceMapStatistics:
    """The statistics of the build of a distance map.

    Attributes
    ----------
    max_entries
        The largest number of crossings along one direction.
    corrected_entries, clamped_entries
        The number of entries that the correction moved, and the number of those whose correction was cut short.
    wrong_parity_share
        Share of the directions in which the number of crossings has the wrong parity because of a hole; 0 for a closed
        mesh.
    """

    face_count: int
    dropped_faces: int
    max_entries: int
    corrected_entries: int
    clamped_entries: int
    wrong_parity_share: float


class _Map(Generic[CoreMap]):
    """The queries of both kinds of map. A map is immutable; any number of threads may query it."""

    _built: CoreMap

    def contains(
        self, points: ArrayLike, *, threads: int = 1, out: NDArray[np.bool_] | None = None
    ) -> NDArray[np.bool_]:
        """Decides which points are inside.

        Parameters
        ----------
        points : array_like (..., 3)
            A point with NaN or infinity is outside.
        threads
            0: all cores. The answers do not depend on it.
        out : ndarray (...) of bool, optional
            Receives the answers.

        Returns
        -------
        ndarray (...) of bool
        """
        return self._built.contains(points, out, threads_of(threads))

    def contacts(
        self, points: ArrayLike, margin: float = 0, *, threads: int = 1, out: Contacts | None = None
    ) -> Contacts:
        """Finds the contact of each point: how deep it is, and where the push-out leads.

        Parameters
        ----------
        points : array_like (..., 3)
            A point with NaN or infinity has no contact.
        margin
            Points outside also get a contact if the surface is at most this far away; ``inf``: however far away it is.
        threads
            0: all cores. The answers do not depend on it.
        out : Contacts, optional
            Earlier answers for the same number of points, which are overwritten.
        """
        taken = None if out is None else of_kind("out", out, Contacts).array
        return Contacts(self._built.contacts(points, number("margin", margin), taken, threads_of(threads)), self._built.origin)

    def save(self, path: Path) -> None:
        """Writes a map file atomically; :func:`load` reads it in place.

        Raises
        ------
        Error
            ``unwritable``.
        """
        self._built.save(path_of(path))

    @property
    def origin(self) -> tuple[float, float, float]:
        """The origin of the map's float32 frame: (0, 0, 0), unless the mesh is so far from 0 that float32 could not
        represent it. Points in queries and answers are nevertheless in the frame of the mesh: pass them as float64."""
        return self._built.origin

    @property
    def centre(self) -> tuple[float, float, float]:
        """The point at which the map's rays start."""
        return self._built.centre

    @property
    def radius(self) -> float:
        """Every vertex lies within this distance of the centre."""
        return self._built.radius

    @property
    def byte_count(self) -> int:
        """The size of all data that a query reads."""
        return self._built.byte_count

    @property
    def source_hash(self) -> int:
        """A hash that identifies the mesh and the options from which the map was built."""
        return self._built.source_hash

    def __reduce__(self) -> tuple[Any, ...]:
        return _map_from_bytes, (self._built.to_bytes(),)

    def __copy__(self) -> _Map[CoreMap]:
        return self

    def __deepcopy__(self, memo: Any) -> _Map[CoreMap]:
        return self

    def __repr__(self) -> str:
        faces = self._built.statistics["face_count"]
        return f"<echinus.{type(self).__name__}: {faces} faces, {self.byte_count} bytes>"


class ExactMap(_Map[_core.ExactMap]):
    """A map whose answers are exact on its lattice; a lattice step is 1.9e-6 of the bounding radius.

    Parameters
    ----------
    mesh
        Anything with ``vertices`` and ``faces``. It may be open: see :attr:`Contacts.certain`.
    cells_per_octant
        Cells in each octant of directions, rounded down to a square number; 0: chosen according to the mesh. More
        cells take memory and save time; they do not change any answer (0 to 262144).
    budget
        The largest size of the map, which gets as many cells as fit; 0: no limit. It cannot be combined with a
        number of cells (0 to 4e9 bytes).
    rule
        The points that count as inside where parts of the model overlap: those in any part, or those in an odd
        number of parts.
    centre
        The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest face
        tests per query.
    threads
        Threads that build the map; 0: all cores. The map does not depend on it.

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`inspect` does, ``invalid_scene`` for an option out of range, ``invalid_options`` for
        a budget that is too small.
    """

    def __init__(
        self,
        mesh: MeshLike,
        *,
        cells_per_octant: int | None = None,
        budget: int | None = None,
        rule: Literal["nonzero", "parity"] | None = None,
        centre: Literal["sphere", "search"] | None = None,
        threads: int = 0,
    ) -> None:
        options = _options("exact", locals())
        built = _core.build_map(*arrays_of(mesh), options, threads_of(threads))
        assert isinstance(built, _core.ExactMap)
        self._built = built

    @overload
    def signed_distance(
        self,
        points: ArrayLike,
        *,
        gradient: Literal[False] = False,
        threads: int = 1,
        out: NDArray[np.float32] | None = None,
    ) -> NDArray[np.float32]: ...
    @overload
    def signed_distance(
        self,
        points: ArrayLike,
        *,
        gradient: Literal[True],
        threads: int = 1,
        out: NDArray[np.float32] | None = None,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def signed_distance(
        self,
        points: ArrayLike,
        *,
        gradient: bool = False,
        threads: int = 1,
        out: NDArray[np.float32] | None = None,
    ) -> Any:
        """Signed distances from the surface, **negative inside and positive outside**, however far away.

        The sign is that of :meth:`contains`, even if the distance is 0: it is then -0 inside. For an open mesh
        :attr:`Contacts.certain` tells whether it is certain. If parts overlap, the nearest face may lie inside the
        solid.

        Parameters
        ----------
        points : array_like (..., 3)
            The distance is NaN for a point with NaN, and infinite for one with infinity.
        gradient
            Also return the unit vectors along which the distances grow fastest; 0 for points that are not
            finite.
        threads
            0: all cores. The answers do not depend on it.
        out : ndarray (...) of float32, optional
            Receives the distances.

        Returns
        -------
        distances : ndarray (...) of float32
        gradients : ndarray (..., 3) of float32
            Only with ``gradient=True``.
        """
        return self._built.signed_distance(points, flag("gradient", gradient), out, threads_of(threads))

    def winding_number(
        self,
        points: ArrayLike,
        *,
        tolerance: float = 1e-2,
        threads: int = 1,
        out: NDArray[np.float32] | None = None,
    ) -> NDArray[np.float32]:
        """Winding numbers: the signed number of times that the surface surrounds each point.

        They are integers for a closed surface, and otherwise generalised winding numbers (Jacobson et al.
        2013), whose distance from one half shows how much holes and gaps matter.

        Parameters
        ----------
        points : array_like (..., 3)
            A point with NaN has the winding number NaN, and one with infinity has 0.
        tolerance
            The largest error of the result; the result is never on the wrong side of an odd multiple of one half. 0
            counts as 1e-8.
        threads
            0: all cores. The answers do not depend on it.
        out : ndarray (...) of float32, optional
            Receives the winding numbers.
        """
        return self._built.winding_number(points, number("tolerance", tolerance), out, threads_of(threads))

    def sweep(self, start: ArrayLike, end: ArrayLike, *, threads: int = 1) -> SweepHits:
        """Finds the first crossings of segments with the surface.

        Parameters
        ----------
        start, end : array_like (..., 3)
            The ends of the segments; their shapes are broadcast. A segment with NaN or infinity has no crossing.
        threads
            0: all cores. The answers do not depend on it.
        """
        start, end = _core.number_array(start, "start"), _core.number_array(end, "end")
        if start.shape != end.shape:
            try:
                start, end = np.broadcast_arrays(start, end)
            except ValueError:
                raise ValueError(f"start and end must have compatible shapes, not {start.shape} and {end.shape}") from None
        return SweepHits(self._built.sweep(start, end, threads_of(threads)), self._built.origin)

    @property
    def statistics(self) -> ExactMapStatistics:
        """The statistics of the build."""
        return ExactMapStatistics(**self._built.statistics)


class DistanceMap(_Map[_core.DistanceMap]):
    """The paper's map, which interpolates distances along rays from a centre. It is small and fast, but not exact.

    Parameters
    ----------
    mesh
        Anything with ``vertices`` and ``faces``; it should be closed, and its faces counter-clockwise seen from
        outside.
    directions
        The numbers of samples of longitude and of colatitude; (200, 200) by default. Only for the grids ``"spherical"``
        and ``"ellipsoidal"``.
    grid
        The grid of directions.
    divisions
        Octahedral and cube grid: the number of parts into which each edge is divided (4 to 4096).
    correction
        The correction for vertices of the mesh between the samples.
    entries
        The format of a stored distance; ``unorm16`` takes half the bytes, with an error of at most 7.6e-6 R, or
        1.4e-5 R on octahedral and ellipsoidal grids.
    pole_axis
        Spherical and ellipsoidal grid: the axis of the mesh on which the poles of the grid lie, where samples
        crowd.
    centre
        The origin of the rays: the centre of the bounding sphere, or a point found by a search for the fewest wrong
        answers near the surface.
    threads
        Threads that build the map; 0: all cores. The map does not depend on it.

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`inspect` does, ``invalid_scene`` for an option that is out of range or belongs to a
        different grid.
    """

    def __init__(
        self,
        mesh: MeshLike,
        directions: tuple[int, int] | None = None,
        *,
        grid: Literal["spherical", "octahedral", "cube", "ellipsoidal"] | None = None,
        divisions: int | None = None,
        correction: Literal["none", "paper", "signed"] | None = None,
        entries: Literal["float32", "unorm16"] | None = None,
        pole_axis: Literal["x", "y", "z"] | None = None,
        centre: Literal["sphere", "search"] | None = None,
        threads: int = 0,
    ) -> None:
        options = _options("distance", locals())
        built = _core.build_map(*arrays_of(mesh), options, threads_of(threads))
        assert isinstance(built, _core.DistanceMap)
        self._built = built

    @property
    def statistics(self) -> DistanceMapStatistics:
        """The statistics of the build."""
        return DistanceMapStatistics(**self._built.statistics)


AnyMap = ExactMap | DistanceMap


def load(path: Path) -> AnyMap:
    """Loads a map from its file, which is checked and then read in place: processes that load it share its memory.

    Raises
    ------
    Error
        ``unreadable``, ``wrong_format``, ``unsupported_version`` or ``damaged``; the message begins with the path.
    """
    return wrap(_core.load_map(path_of(path)))


def wrap(built: _core.ExactMap | _core.DistanceMap) -> AnyMap:
    """Wraps a map that the library made."""
    kind: type[AnyMap] = ExactMap if isinstance(built, _core.ExactMap) else DistanceMap
    result: Any = kind.__new__(kind)
    result._built = built
    return result  # type: ignore[no-any-return]


def _map_from_bytes(data: bytes) -> AnyMap:
    return wrap(_core.map_from_bytes(data))


def _options(kind: str, given: dict[str, Any]) -> str:
    """The options as JSON, as under the key ``map`` of a scene; an option that is None keeps its default."""
    others = ("self", "mesh", "threads")
    return json_of({"kind": kind} | {key: value for key, value in given.items() if value is not None and key not in others})
