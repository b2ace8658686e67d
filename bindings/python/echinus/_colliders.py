"""Models among which deformables move, and the motions of these models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import kind_name, list_of_kind, number, of_kind, path_of, quaternion, vector
from echinus._maps import AnyMap, DistanceMap, ExactMap
from echinus._meshes import MeshLike, Path, arrays_of

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Collider:
    """A map placed in the world: point_world = position + rotation * (scale * point_local).

    Attributes
    ----------
    map
        Several colliders may share a map. Surface collision needs an exact map.
    rotation
        Unit quaternion w, x, y, z; :func:`rotation_about` makes one.
    scale
        A number, or one for each axis of the map; not 0. A negative number mirrors.
    linear_velocity, angular_velocity
        Units per second, and radians per second about the position.
    name
        A name for error messages; if empty, "collider" and its index.
    """

    map: AnyMap
    position: Sequence[float] = (0, 0, 0)
    rotation: Sequence[float] = (1, 0, 0, 0)
    scale: float | Sequence[float] = 1
    linear_velocity: Sequence[float] = (0, 0, 0)
    angular_velocity: Sequence[float] = (0, 0, 0)
    name: str = ""

    def _arguments(self) -> _core.ColliderArguments:
        if not isinstance(self.map, (ExactMap, DistanceMap)):
            raise TypeError(f"map must be an ExactMap or a DistanceMap, not {kind_name(self.map)}")
        scale = vector("scale", self.scale) if np.ndim(self.scale) > 0 else (number("scale", self.scale),) * 3
        return (
            self.map._built,
            vector("position", self.position),
            quaternion("rotation", self.rotation),
            scale,
            vector("linear_velocity", self.linear_velocity),
            vector("angular_velocity", self.angular_velocity),
            of_kind("name", self.name, str),
        )


@dataclass(frozen=True)
class ColliderState:
    """The present pose of a model: point_world = position + rotation * (scale * point_local).

    Attributes
    ----------
    rotation
        Unit quaternion w, x, y, z.
    linear_velocity, angular_velocity
        Units per second, and radians per second about the position.
    """

    position: Vector
    rotation: Quaternion
    scale: Vector
    linear_velocity: Vector
    angular_velocity: Vector


class ContactPoints(NamedTuple):
    """The contacts of the deformables with models and with themselves in one frame.

    Attributes
    ----------
    positions
        [contact, 3] Points of contact on the deformable when the contact last exerted a force, in world coordinates.
    normals
        [contact, 3] Unit normals, which point towards the deformable or, in self-collision, towards the first of the
        two elements in contact.
    gaps
        [contact] The gap when the contact last exerted a force; positive.
    normal_impulses
        [contact] The impulse of the frame along the normal, N s, on the deformable or, in self-collision, on the first
        element.
    friction_impulses
        [contact, 3] The impulse of friction in the frame, perpendicular to the normal, N s.
    colliders
        [contact] The index of the collider; -1 for a contact of the deformables with themselves.
    particles
        [contact, 4] The particles of the deformable's element in contact, followed in self-collision by those of the
        second element: a vertex and the three corners of a face, or the two ends of each edge; -1 for unused entries.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    gaps: NDArray[np.float64]
    normal_impulses: NDArray[np.float64]
    friction_impulses: NDArray[np.float64]
    colliders: NDArray[np.int64]
    particles: NDArray[np.int64]


class Load(NamedTuple):
    """The load on a collider, in world axes.

    Attributes
    ----------
    force
        The force, mass * length / s^2; the unit of mass is that of the deformable's masses.
    torque
        The torque about the collider's position, which moves with the collider.
    """

    force: Vector
    torque: Vector


class PoseKey(NamedTuple):
    """A keyframe: the pose of a collider at a time, in seconds; the rotation is a unit quaternion w, x, y, z."""

    time: float
    position: Sequence[float]
    rotation: Sequence[float] = (1, 0, 0, 0)

    def _arguments(self) -> tuple[float, Vector, Quaternion]:
        return number("time", self.time), vector("position", self.position), quaternion("rotation", self.rotation)


def key_arguments(keys: Sequence[PoseKey]) -> list[_core.KeyArguments]:
    return [key._arguments() for key in list_of_kind("keys", keys, PoseKey)]


def pose_at(keys: Sequence[PoseKey], seconds: float) -> PoseKey:
    """The pose at a time, interpolated between two keys: the position linearly, the rotation along the shorter
    arc (slerp).

    Before the first key, the result is the pose of the first key; after the last key, it is that of the last.

    Parameters
    ----------
    keys
        At least one; their times ascend.
    """
    seconds = number("seconds", seconds)
    return PoseKey(seconds, *_core.pose_at(key_arguments(keys), seconds))


def rotation_about(axis: Sequence[float], angle_rad: float) -> Quaternion:
    """The unit quaternion w, x, y, z of a rotation about an axis, counter-clockwise seen from the tip of the axis."""
    return _core.rotation_about(vector("axis", axis), number("angle_rad", angle_rad))


class VertexCache:
    """The vertices of a model over time, in equally spaced samples.

    Between two samples vertices are interpolated linearly; before the first and after the last sample they do not move.

    Parameters
    ----------
    samples : array_like (sample_count, vertex_count, 3)
        Finite positions in the model's own frame; copied.
    sample_seconds
        The time between two samples; positive.
    start_time
        The time of the first sample, seconds.
    """

    _cache: _core.VertexCache

    def __init__(self, samples: ArrayLike, sample_seconds: float, start_time: float = 0) -> None:
        self._cache = _core.VertexCache(
            samples, number("start_time", start_time), number("sample_seconds", sample_seconds)
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return VertexCache, (self.samples, self.sample_seconds, self.start_time)

    @classmethod
    def _of(cls, core: _core.VertexCache) -> VertexCache:
        cache = cls.__new__(cls)
        cache._cache = core
        return cache

    @property
    def samples(self) -> NDArray[np.float32]:
        """(sample_count, vertex_count, 3) A read-only view."""
        return self._cache.samples

    @property
    def start_time(self) -> float:
        """The time of the first sample, seconds."""
        return self._cache.start_time

    @property
    def sample_seconds(self) -> float:
        """The time between two samples, seconds."""
        return self._cache.sample_seconds

    @property
    def end_time(self) -> float:
        """The time of the last sample, seconds."""
        return self._cache.end_time

    def at(self, seconds: float) -> NDArray[np.float32]:
        """(vertex_count, 3) The vertices at the given time, in a new array."""
        return self._cache.at(number("seconds", seconds))

    def __repr__(self) -> str:
        count, vertices, _ = self.samples.shape
        return f"<echinus.VertexCache: {count} samples of {vertices} vertices, {self.start_time} to {self.end_time} s>"


def read_vertex_cache(path: Path, mesh: MeshLike, *, frames_per_second: float, animation: str = "") -> VertexCache:
    """Reads a PC2 point cache, an animation, or a folder of OBJ files, one for each frame, in the order of their names.

    Parameters
    ----------
    mesh
        The model, as returned by :func:`read_mesh`.
    animation
        The name of the animation in a glTF, GLB or 3DS file; needed if there are several.

    Raises
    ------
    Error
        As :func:`read_mesh` does; ``invalid_mesh`` if the number of vertices, or a face in a file of the folder,
        differs from the model's.
    """
    rate = number("frames_per_second", frames_per_second)
    name = of_kind("animation", animation, str)
    return VertexCache._of(_core.VertexCache.read(path_of(path), *arrays_of(mesh), rate, name))
