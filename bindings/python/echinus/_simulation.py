"""Cloth among rigid models."""

from __future__ import annotations

import json
import pathlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from echinus import _core
from echinus._errors import Error
from echinus._maps import AnyMap, DistanceMap, ExactMap
from echinus._meshes import Mesh, MeshLike, Path, arrays_of, inspect, read_mesh

Vector = tuple[float, float, float]

#: Vertices and faces, and the edges that no face has.
_Drawn = tuple["_core.Arrays | None", list[tuple[int, int]]]


@dataclass(frozen=True)
class SimulationOptions:
    """The options of a simulation that are in force; docs/scenes.md describes them."""

    solver: Literal["verlet", "xpbd"]
    time_step: float
    iteration_count: int
    substep_count: int
    gravity: Vector
    drag: float
    friction: float
    thickness: float
    self_thickness: float | None
    surface_collision: bool
    self_collision: bool
    untangle: bool
    allow_open_colliders: bool


@dataclass(frozen=True)
class SimulationProfile:
    """Times and counts of all steps so far.

    Attributes
    ----------
    integration_seconds, constraint_seconds, collision_seconds
        Where the time went.
    query_count, contact_count, map_query_count
        Queries of particles, those of them that were pushed, and those that needed the map.
    rescued_count
        Times that a particle was put back because it would have passed through an exact map.
    lost_count
        Times that a particle ended a frame inside an exact map or on its other side.
    truncated_count
        With surface collision: times that a particle was stopped before a face met something.
    searched_face_count, measured_pair_count
        The work of surface collision.
    squeezed_count
        Times that there was no place for a particle. Only then faces may intersect.
    """

    integration_seconds: float
    constraint_seconds: float
    collision_seconds: float
    query_count: int
    contact_count: int
    map_query_count: int
    rescued_count: int
    lost_count: int
    truncated_count: int
    searched_face_count: int
    measured_pair_count: int
    squeezed_count: int


@dataclass(frozen=True)
class ColliderState:
    """Where a rigid model is now: point_world = position + rotation * (scale * point_local).

    Attributes
    ----------
    rotation
        Unit quaternion w, x, y, z.
    linear_velocity, angular_velocity
        Units per second, and radians per second about the position.
    """

    position: Vector
    rotation: tuple[float, float, float, float]
    scale: Vector
    linear_velocity: Vector
    angular_velocity: Vector


class Simulation:
    """Cloth that falls on a rigid model; :meth:`from_scene` makes one.

    The same scene gives the same positions, bit for bit. Several threads may call; one at a time computes.
    """

    _simulation: _core.Simulation
    _frame_limit: int

    def __init__(self) -> None:
        raise TypeError("use echinus.Simulation.from_scene()")

    @classmethod
    def from_scene(
        cls,
        scene: Path | Mapping[str, Any],
        *,
        model: MeshLike | AnyMap | None = None,
        cloth: MeshLike | None = None,
        rest_cloth: MeshLike | None = None,
        model_folders: Sequence[Path] = (),
        surface_collision: bool | None = None,
        self_collision: bool | None = None,
        untangle: bool | None = None,
        allow_open_colliders: bool = False,
        threads: int = 0,
    ) -> Simulation:
        """The beginning of a scene.

        Parameters
        ----------
        scene
            The path of a JSON file, or its content; docs/scenes.md has every key.
        model
            A mesh, which the scene may repair, or a map in place of the scene's model.
        cloth, rest_cloth
            Meshes in place of the files that the scene's cloth is made of.
        model_folders
            Where the scene's files are looked for first; then beside the scene, in ``../models`` beside it,
            and in ``models`` in the working folder.
        surface_collision, self_collision, untangle
            In place of the scene's keys. Without the first there is none of the others. A distance map as ``model``
            has no surface collision.
        allow_open_colliders
            Accept a model that is not closed, for which nothing is promised. Surface collision needs no such
            permission.
        threads
            For the build of the map. 0: all cores.

        Raises
        ------
        Error
            ``invalid_scene`` names the key at fault; ``unreadable``, ``invalid_mesh`` and ``invalid_options``
            name the file and what is wrong with it.
        """
        if isinstance(scene, Mapping):
            parsed = _core.Scene.parse(json.dumps(scene), "the scene")
            folder = pathlib.Path()
        else:
            parsed = _core.Scene.read(scene)
            folder = pathlib.Path(scene).parent
        if surface_collision is None and isinstance(model, DistanceMap):
            surface_collision = False
        surfaces = _chosen(surface_collision, parsed.surface_collision)
        parsed.surface_collision = surfaces
        parsed.self_collision = surfaces and _chosen(self_collision, parsed.self_collision)
        parsed.untangle = surfaces and _chosen(untangle, parsed.untangle)
        parsed.allow_open_colliders = allow_open_colliders
        folders = [*map(pathlib.Path, model_folders), folder, folder / ".." / "models", pathlib.Path("models")]

        def read(name: str | None, given: MeshLike | None = None) -> _core.Arrays | None:
            if given is not None:
                return arrays_of(given)
            return None if name is None else arrays_of(read_mesh(_core.find_model(name, folders)))

        def read_cloth(name: str | None, given: MeshLike | None) -> _Drawn:
            if given is not None or name is None:
                return read(None, given), []
            return _core.read_mesh_and_edges(_core.find_model(name, folders))

        if isinstance(model, (ExactMap, DistanceMap)):
            collider = model._built
        else:
            arrays = parsed.repair(*(read(parsed.model_file, model) or parsed.make_model()))
            if not (parsed.surface_collision or allow_open_colliders):
                _require_closed(Mesh(*arrays), parsed.model_file or "the model")
            collider = parsed.build_map(*arrays, threads)
        start, threads_of_cloth = read_cloth(parsed.cloth_file, cloth)
        rest, _ = read_cloth(parsed.rest_file, rest_cloth)
        return cls._of(_core.Simulation(parsed, collider, start, rest, threads_of_cloth), parsed.frame_limit)

    @classmethod
    def _of(cls, core: _core.Simulation, frame_limit: int) -> Simulation:
        simulation = cls.__new__(cls)
        simulation._simulation = core
        simulation._frame_limit = frame_limit
        return simulation

    def step(self, frame_count: int = 1) -> None:
        """Computes frames. Ctrl-C ends it between two of them.

        Raises
        ------
        Error
            ``diverged``, naming the frame; afterwards the simulation can only be read.
        """
        self._simulation.step(frame_count)

    def run(self, frame_limit: int | None = None) -> bool:
        """Steps until the cloth rests or there are so many frames, by default the scene's limit.

        Returns
        -------
        bool
            Does it rest?
        """
        limit = self._frame_limit if frame_limit is None else frame_limit
        while not self.at_rest and self.frame < limit:
            self.step()
        return self.at_rest

    @property
    def positions(self) -> NDArray[np.float32]:
        """(particle_count, 3) A read-only view of the particles, which every step changes: copy what you keep."""
        return self._simulation.positions

    @property
    def previous_positions(self) -> NDArray[np.float32]:
        """(particle_count, 3) The same, one substep before."""
        return self._simulation.previous_positions

    @property
    def velocities(self) -> NDArray[np.float32]:
        """(particle_count, 3) Units per second, a new array."""
        rate = np.float32(self.options.substep_count / self.options.time_step)
        return (self.positions - self.previous_positions) * rate

    @property
    def faces(self) -> NDArray[np.uint32]:
        """(face_count, 3) The particles of each face of the cloth; a read-only view."""
        return self._simulation.faces

    @property
    def mesh(self) -> Mesh:
        """The cloth as it is now, a copy."""
        return Mesh(self.positions.copy(), self.faces)

    @property
    def colliders(self) -> list[ColliderState]:
        """The rigid models where they are now."""
        return [ColliderState(**state) for state in self._simulation.describe_colliders()]

    @property
    def options(self) -> SimulationOptions:
        """As given, with the thickness in force."""
        return SimulationOptions(**self._simulation.options)

    @property
    def frame(self) -> int:
        """Frames computed so far."""
        return self._simulation.frame

    @property
    def frame_limit(self) -> int:
        """The scene's."""
        return self._frame_limit

    @property
    def at_rest(self) -> bool:
        """Has every particle been slow and near one place for as many frames as the scene says?"""
        return self._simulation.at_rest

    @property
    def largest_speed(self) -> float:
        """Of the fastest particle, units per second; infinite before the first frame."""
        return self._simulation.largest_speed

    @property
    def state_hash(self) -> int:
        """Of the bits of all positions: to compare two runs."""
        return self._simulation.state_hash

    @property
    def profile(self) -> SimulationProfile:
        """Times and counts so far."""
        return SimulationProfile(**self._simulation.profile)

    def set_collider_velocity(self, collider: int, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Steers a model: it keeps these velocities, in units and radians per second, until they are set again."""
        self._simulation.set_collider_velocity(collider, _vector(linear), _vector(angular))

    def set_particle_velocity(self, particle: int, velocity: Sequence[float]) -> None:
        """Gives a particle a velocity, units per second. A pinned particle stays."""
        self._simulation.set_particle_velocity(particle, _vector(velocity))

    def blow(self, wind: Sequence[float], rate: float) -> None:
        """Wind for the next frame.

        Parameters
        ----------
        wind
            Velocity of the air, units per second.
        rate
            Per second, not negative: the higher, the lighter the cloth.
        """
        self._simulation.blow(_vector(wind), rate)

    def __copy__(self) -> Simulation:
        return self._of(self._simulation.copy(), self._frame_limit)

    def __deepcopy__(self, memo: Any) -> Simulation:
        return self.__copy__()

    def __repr__(self) -> str:
        return f"<echinus.Simulation: {len(self.positions)} particles, frame {self.frame}>"


def _chosen(given: bool | None, otherwise: bool) -> bool:
    return otherwise if given is None else given


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return float(x), float(y), float(z)


def _require_closed(mesh: Mesh, name: str) -> None:
    report = inspect(mesh)
    if not report.closed:
        raise Error(
            f"{name}: the model is not closed, so cloth would pass through it: {report.border_edges.count} edges have"
            f" one face, {report.misoriented_edges.count} have faces that disagree about the outside; mend it, or use"
            " surface_collision",
            "invalid_mesh",
        )
