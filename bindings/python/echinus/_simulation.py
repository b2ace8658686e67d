"""Cloth and soft bodies among models."""

from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import flag, index, json_of, list_of_kind, number, of_kind, one_of, path_of, quaternion, threads_of, vector, whole
from echinus._colliders import Collider, ColliderState, ContactPoints, Load, PoseKey, Vector, VertexCache, key_arguments
from echinus._deformables import Deformable
from echinus._errors import Error
from echinus._maps import AnyMap, DistanceMap, ExactMap
from echinus._meshes import Mesh, MeshLike, Path, arrays_of, inspect, read_mesh

#: Vertices and faces, and the edges that no face has.
_Drawn = tuple["_core.Arrays | None", list[tuple[int, int]]]
#: Replaces the model of a collider.
_Model = MeshLike | AnyMap | None


@dataclass(frozen=True)
class SimulationOptions:
    """The options in use by a simulation; :class:`Simulation` describes them."""

    time_step: float
    solver: Literal["newton", "jakobsen"]
    iteration_count: int
    newton_step_count: int
    rest_frame_count: int
    rest_distance: float
    rest_speed: float
    gravity: Vector
    drag: float
    stiffness: Vector
    thickness: float
    self_thickness: float | None
    friction: float
    bound: float
    keep_free: bool
    allow_open_colliders: bool
    collision: Literal["particles", "surfaces", "surfaces_and_self"]
    untangle: bool
    density: float
    stretch_stiffness: float
    shear_stiffness: float
    bending_stiffness: float
    damping: float
    newton_tolerance: float
    air_drag: float
    wind: Vector
    wind_rate: float
    pressure: float
    threads: int


@dataclass(frozen=True)
class SimulationProfile:
    """Times and counts of all steps since the simulation began.

    Attributes
    ----------
    integration_seconds, constraint_seconds, collision_seconds
        The computing time of each part.
    query_count, contact_count, map_query_count
        Numbers of queries of particles, of contacts found, and of queries that needed the map.
    rescued_count
        Number of times that a particle was moved back because it would otherwise have passed through an exact map.
    lost_count
        Number of times that a particle that had once been free of an exact map ended a frame inside it or on the other
        side of its surface.
    truncated_count
        With surface collision: number of times that the displacement of a particle was truncated, because an edge or
        face of the particle could have met a surface on the path.
    measured_pair_count
        With surface collision: number of pairs whose distance was measured.
    unresolved_count
        The number of unresolved pairs of elements, for which no free space was proven, summed over all steps. If it is
        0, no faces intersect.
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
    measured_pair_count: int
    unresolved_count: int


class Simulation:
    """A deformable that moves among colliders; :meth:`from_scene` makes one from a scene.

    The same input gives the same positions, bit for bit. Several threads may call its methods, but only one
    computes at a time.

    Parameters
    ----------
    deformable
        The deformable to simulate; it is copied.
    colliders
        Any number of colliders, each with its own pose and motion.
    frame_limit
        The default frame limit of :meth:`run`.
    time_step
        Seconds per frame. The paper's solver needs smaller steps: there, halving the step doubles the computing
        time and reduces the stretch to a quarter (1e-9 to 1e9 s).
    solver
        ``newton``: a continuous material in SI units; ``jakobsen``: the paper's solver, with distance constraints
        and collision of particles only.
    iteration_count
        ``jakobsen`` only: relaxations per frame, each of all distance constraints and then of all contacts; more
        relaxations take longer and leave less stretch (1 to 1e6).
    newton_step_count
        ``newton`` only: the largest number of steps of Newton's method per frame or substep, or twice that number
        while there is no contact; fewer are taken if it converges (1 to 1000).
    rest_frame_count
        The number of consecutive frames for which all particles must be slow and near one position (1 to 1e9).
    rest_distance
        The distance from one position within which a particle at rest stays (0 to 1e9).
    rest_speed
        The largest speed of a particle at rest at the end of a frame (at least 0 length/s).
    gravity
        The acceleration of gravity. A model whose y axis points up needs ``[0, -9.81, 0]`` (-1e9 to 1e9
        length/s^2).
    drag
        ``jakobsen`` only: share of the velocity that is lost per frame; its effect depends on ``time_step`` (0 to
        1).
    stiffness
        ``jakobsen`` only: share of a constraint's error that one relaxation removes, for structural, shear and
        bending constraints (0 to 1.99).
    thickness
        Distance that the deformable keeps from colliders, by default half the mean rest length of structural
        constraints or, for soft bodies, half the mean edge length (0 to 1e9).
    self_thickness
        ``newton`` only: distance that layers keep from each other if they collide; less near small faces. By
        default the thickness (0 to 1e9).
    friction
        Coulomb's coefficient of friction, for contacts with models and, if layers collide, between layers; 0: no
        friction (0 to 1e9).
    bound
        The largest distance of a particle from the initial middle of all particles; if a particle is farther away,
        the simulation ends as diverged. 0: 10 000 times the initial extent (0 to 1e30).
    keep_free
        ``jakobsen`` only: rescue particles that would pass through an exact map.
    allow_open_colliders
        Accept exact maps of open meshes, for which nothing is guaranteed. The collision of surfaces does not need
        this option.
    collision
        The parts that collide; with ``jakobsen`` only particles do. ``particles``: particles collide with models;
        ``surfaces``: edges and faces do, too, so none of them intersects a model at the end of a frame, within
        limits; ``surfaces_and_self``: in addition, faces do not intersect each other.
    untangle
        ``newton`` only: separate, before the first frame, an initial state in which surfaces intersect or particles
        are inside the model, instead of rejecting it; needs the collision of surfaces.
    density
        ``newton`` only, like the next four options: mass of the cloth per area (1e-6 to 1e6 kg/m^2).
    stretch_stiffness
        Force per width that resists stretching of warp and weft (1e-6 to 1e9 N/m).
    shear_stiffness
        Force per width that resists shear between warp and weft (0 to 1e9 N/m).
    bending_stiffness
        Moment per width and curvature that resists bending (0 to 1e6 N m).
    damping
        Viscosity of the cloth divided by its stiffness (0 to 1e6 s).
    newton_tolerance
        ``newton`` only: tolerance of Newton's method, relative to the mean edge length. It has converged if the
        decrease of the energy corresponds to a root-mean-square displacement of at most the tolerance times that
        length (0 to 1).
    air_drag
        ``newton`` only: resistance of still air, the rate at which the velocity of a free particle decays; 0 is a
        vacuum (0 to 1e6 1/s).
    wind
        Velocity of the air; needs ``wind_rate`` (-1e9 to 1e9 length/s).
    wind_rate
        The rate at which particles take on the air's velocity relative to a face, along the face's normal; higher
        for lighter cloth. 0: no air. Without ``wind`` the air is at rest and slows motion (0 to 1e9 1/s).
    pressure
        ``newton`` only: pressure inside closed pieces of cloth in excess of the surrounding pressure; it is
        constant, as if a pump maintained it (0 to 1e9 N/m^2).
    threads
        Threads that compute a frame; 0: all cores. The results are bit-identical for any number (0 to 1024).

    Raises
    ------
    Error
        ``invalid_options``, naming the fault.
    """

    _simulation: _core.Simulation
    _frame_limit: int

    def __init__(
        self,
        deformable: Deformable,
        colliders: Sequence[Collider] = (),
        *,
        frame_limit: int = 3000,
        time_step: float = 1 / 60,
        solver: Literal["newton", "jakobsen"] = "newton",
        iteration_count: int = 10,
        newton_step_count: int = 4,
        rest_frame_count: int = 60,
        rest_distance: float = 0.001,
        rest_speed: float = 0.1,
        gravity: Sequence[float] = (0, 0, -9.81),
        drag: float = 0.005,
        stiffness: Sequence[float] = (1, 1, 0.3),
        thickness: float | None = None,
        self_thickness: float | None = None,
        friction: float = 0.5,
        bound: float = 0,
        keep_free: bool = True,
        allow_open_colliders: bool = False,
        collision: Literal["particles", "surfaces", "surfaces_and_self"] = "surfaces_and_self",
        untangle: bool = False,
        density: float = 0.2,
        stretch_stiffness: float = 1000,
        shear_stiffness: float = 400,
        bending_stiffness: float = 1e-5,
        damping: float = 0.01,
        newton_tolerance: float = 0.0005,
        air_drag: float = 0.5,
        wind: Sequence[float] = (0, 0, 0),
        wind_rate: float = 0,
        pressure: float = 0,
        threads: int = 1,
    ) -> None:
        options = dict(locals())
        of_kind("deformable", deformable, Deformable)
        models = list_of_kind("colliders", colliders, Collider)
        self._frame_limit = whole("frame_limit", frame_limit)
        self._simulation = _core.Simulation(deformable._deformable, [c._arguments() for c in models], options)

    @classmethod
    def from_scene(
        cls,
        scene: Path | Mapping[str, Any],
        *,
        model: _Model | Sequence[_Model] = None,
        cloth: MeshLike | None = None,
        rest_cloth: MeshLike | None = None,
        model_folders: Path | Sequence[Path] = (),
        collision: Literal["particles", "surfaces", "surfaces_and_self"] | None = None,
        untangle: bool | None = None,
        allow_open_colliders: bool = False,
        threads: int = 0,
    ) -> Simulation:
        """Makes the simulation of a scene, in its initial state.

        Parameters
        ----------
        scene
            The path of a JSON file, or its content; docs/scenes.md documents every key.
        model
            A mesh, which the scene may repair, or a map that replaces the scene's model. For a scene with several
            colliders, pass a list with one entry for each; None keeps the scene's own model. For a collider with a
            vertex cache the entry must be a mesh.
        cloth, rest_cloth
            Meshes that replace the files of the scene's cloth.
        model_folders
            A folder, or several, in which the scene's files are looked up first; the scene's folder, its ``../models``,
            and ``models`` in the working folder follow.
        collision, untangle
            Override the scene's keys. With a distance map as ``model`` the default of ``collision`` is ``particles``.
        allow_open_colliders
            Accept a model that is not closed, for which nothing is guaranteed. The collision of surfaces
            does not need this option.
        threads
            Threads that build maps; 0: all cores.

        Raises
        ------
        Error
            ``invalid_scene`` names the key; ``unreadable``, ``invalid_mesh`` and ``invalid_options`` name
            the file and its fault.
        """
        if isinstance(scene, Mapping):
            parsed = _core.Scene.parse(json_of(scene), "the scene")
            folder = pathlib.Path()
        else:
            parsed = _core.Scene.read(path_of(scene))
            folder = pathlib.Path(path_of(scene)).parent
        for warning in parsed.warnings:
            warnings.warn(warning, stacklevel=2)
        models = _one_for_each(model, parsed.collider_count)
        if collision is None and any(isinstance(given, DistanceMap) for given in models):
            collision = "particles"
        if collision is not None:
            parsed.choose_collision(one_of("collision", collision, ("particles", "surfaces", "surfaces_and_self")))
        if untangle is not None:
            parsed.choose_untangle(flag("untangle", untangle))
        parsed.allow_open_colliders = flag("allow_open_colliders", allow_open_colliders)
        threads = threads_of(threads)
        folders = [model_folders] if isinstance(model_folders, (str, bytes, os.PathLike)) else model_folders
        files = _Files([*(pathlib.Path(path_of(each)) for each in folders), folder, folder / ".." / "models", pathlib.Path("models")])
        loaded = [_load_collider(parsed, i, given, files, threads) for i, given in enumerate(models)]
        start, threads_of_cloth = files.cloth(parsed.cloth_file, cloth, "cloth")
        rest, _ = files.cloth(parsed.rest_file, rest_cloth, "rest_cloth")
        bodies = [None if name is None else files.find(name) for name in parsed.body_files]
        maps, caches = [part[0] for part in loaded], [part[1] for part in loaded]
        core = parsed.simulate(maps, caches, start, rest, threads_of_cloth, bodies)
        return cls._of(core, parsed.frame_limit)

    @classmethod
    def _of(cls, core: _core.Simulation, frame_limit: int) -> Simulation:
        simulation = cls.__new__(cls)
        simulation._simulation = core
        simulation._frame_limit = frame_limit
        return simulation

    def step(self, frame_count: int = 1) -> None:
        """Computes frames. Ctrl-C ends the call between two frames.

        Raises
        ------
        Error
            ``diverged``, naming the frame; afterwards the simulation can only be read.
        """
        self._simulation.step(whole("frame_count", frame_count))

    def run(self, frame_limit: int | None = None) -> bool:
        """Steps until the simulation is at rest or reaches the frame limit, by default :attr:`frame_limit`.

        Returns
        -------
        bool
            Whether it is at rest.
        """
        limit = self._frame_limit if frame_limit is None else whole("frame_limit", frame_limit)
        while not self.at_rest and self.frame < limit:
            self.step()
        return self.at_rest

    @property
    def positions(self) -> NDArray[np.float32]:
        """(particle_count, 3) A read-only view of the particles, which every step changes: copy what you keep."""
        return self._simulation.positions

    @property
    def velocities(self) -> NDArray[np.float32]:
        """(particle_count, 3) Units per second; a read-only view, which every step changes: copy what you keep."""
        return self._simulation.velocities

    @property
    def faces(self) -> NDArray[np.uint32]:
        """(face_count, 3) The particles of each face; a read-only view."""
        return self._simulation.faces

    @property
    def tetrahedra(self) -> NDArray[np.uint32]:
        """(tetrahedron_count, 4) The particles of each tetrahedron; a read-only view."""
        return self._simulation.tetrahedra

    @property
    def mesh(self) -> Mesh:
        """A copy of the faces in their present positions."""
        return Mesh(self.positions.copy(), self.faces)

    @property
    def colliders(self) -> list[ColliderState]:
        """The models in their present poses."""
        return [ColliderState(**state) for state in self._simulation.describe_colliders()]

    @property
    def options(self) -> SimulationOptions:
        """The given options, with the effective thickness."""
        return SimulationOptions(**self._simulation.options)

    @property
    def frame(self) -> int:
        """The number of frames that have been computed."""
        return self._simulation.frame

    @property
    def frame_limit(self) -> int:
        """The default frame limit of :meth:`run`."""
        return self._frame_limit

    @property
    def at_rest(self) -> bool:
        """Has every particle been slow and near one position for the required number of frames?"""
        return self._simulation.at_rest

    @property
    def largest_speed(self) -> float:
        """Speed of the fastest particle, units per second; infinite before the first frame."""
        return self._simulation.largest_speed

    @property
    def residual(self) -> tuple[float, float]:
        """The relative deviation of structural constraints from their rest lengths; root mean square and largest.

        With ``jakobsen`` it is the residual error of the relaxations.
        """
        return self._simulation.residual()

    @property
    def state_hash(self) -> int:
        """A hash of the bits of all positions and velocities, to compare two runs."""
        return self._simulation.state_hash

    @property
    def profile(self) -> SimulationProfile:
        """Times and counts of all steps since the simulation began."""
        return SimulationProfile(**self._simulation.profile)

    def set_collider_velocity(self, collider: int, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Sets the velocities of a model, in units and radians per second. The model keeps them until they are set
        again."""
        self._simulation.set_collider_velocity(
            index("collider", collider), vector("linear", linear), vector("angular", angular)
        )

    def set_collider_pose(
        self, collider: int, position: Sequence[float], rotation: Sequence[float] = (1, 0, 0, 0)
    ) -> None:
        """Moves a model to this pose during the next frame, rotating along the shorter arc; it then stays there.

        Parameters
        ----------
        rotation
            Unit quaternion w, x, y, z; :func:`rotation_about` makes one.
        """
        self._simulation.set_collider_pose(
            index("collider", collider), vector("position", position), quaternion("rotation", rotation)
        )

    def set_collider_keyframes(self, collider: int, keys: Sequence[PoseKey]) -> None:
        """Makes a model follow keyframes: each frame moves it to the pose that :func:`pose_at` returns for the frame's
        end.

        The model starts from its present pose, so first place it at the pose of the keyframes at the present time.
        Without keys it does not move.

        Parameters
        ----------
        keys
            The keyframes; their times ascend, in seconds since the simulation began.
        """
        self._simulation.set_collider_keyframes(index("collider", collider), key_arguments(keys))

    def set_collider_vertices(self, collider: int, vertices: ArrayLike) -> None:
        """Moves the vertices of a model to these positions during the next frame, along straight lines.

        This needs an exact map and surface collision; the map is rebuilt in this call.

        Parameters
        ----------
        vertices : array_like (vertex_count, 3)
            Positions in the model's own frame: one for each vertex of the mesh from which its map was built, in the
            same order.

        Raises
        ------
        Error
            ``invalid_options``; in that case nothing changes.
        """
        self._simulation.set_collider_vertices(index("collider", collider), _core.float_array(vertices, "vertices"))

    def set_collider_cache(self, collider: int, cache: VertexCache) -> None:
        """Makes each frame move the vertices of a model to those of the cache at the frame's end.

        Build the model's map from ``cache.at(0)``; otherwise the first frame moves the model there. The requirements
        are those of :meth:`set_collider_vertices`.
        """
        core = of_kind("cache", cache, VertexCache)._cache
        self._simulation.set_collider_cache(index("collider", collider), core)

    def load_on(self, collider: int) -> Load:
        """The load that the deformables exerted on a model in the last frame, averaged over the frame; 0
        before the first.

        It is caused by contact, friction and attached particles, in N and N m. With ``jakobsen`` it is always 0. A
        program that applies it to a rigid body and moves the model with the body exchanges momentum with the
        deformables.
        """
        return Load(*self._simulation.load_on(index("collider", collider)))

    def set_collider_free(self, collider: int, mass: float) -> None:
        """Makes a model move freely from its present velocities, as a rigid body of uniform density.

        Gravity and the deformables move it. This needs an exact map of a closed mesh and the solver ``newton``.

        Raises
        ------
        Error
            ``invalid_options``; in that case nothing changes.
        """
        self._simulation.set_collider_free(index("collider", collider), number("mass", mass))

    def record_contacts(self, is_on: bool = True) -> None:
        """Sets whether the following frames record their contacts; off by default. The setting is not part of a saved
        state."""
        self._simulation.record_contacts(flag("is_on", is_on))

    def contact_points(self) -> ContactPoints:
        """Copies of the contacts that were recorded in the last frame.

        For each model, the impulses of its contacts divided by the time step sum to the opposite of :meth:`load_on`,
        except for the loads of attached particles and of particles whose displacement was truncated. ``jakobsen``
        records none.
        """
        return ContactPoints(*self._simulation.contact_points())

    def set_particle_velocity(self, particle: int, velocity: Sequence[float]) -> None:
        """Sets the velocity of a particle, in units per second. A pinned particle does not move."""
        self._simulation.set_particle_velocity(index("particle", particle), vector("velocity", velocity))

    def blow(self, wind: Sequence[float], rate: float) -> None:
        """Sets the wind for the next frame.

        Parameters
        ----------
        wind
            Velocity of the air, units per second.
        rate
            The rate at which the cloth takes on the velocity of the air, per second; not negative, higher for lighter
            cloth.
        """
        self._simulation.blow(vector("wind", wind), number("rate", rate))

    def save_state(self) -> bytes:
        """Returns the state of the simulation without its inputs (docs/saved_states.md)."""
        return self._simulation.save_state()

    def restored(self, state: bytes) -> Simulation:
        """Makes a new simulation with the inputs of this one, which resumes from a saved state bit for bit.

        This simulation does not change, and neither do views of its positions.

        Raises
        ------
        Error
            ``wrong_format``, ``unsupported_version`` or ``damaged`` for bytes that are not a state, are of another
            version, or are truncated or altered; ``invalid_options`` for a state of another simulation, naming the
            difference.
        """
        return self._of(self._simulation.restored(of_kind("state", state, bytes)), self._frame_limit)

    def __copy__(self) -> Simulation:
        return self._of(self._simulation.copy(), self._frame_limit)

    def __deepcopy__(self, memo: Any) -> Simulation:
        return self.__copy__()

    def __repr__(self) -> str:
        return f"<echinus.Simulation: {len(self.positions)} particles, frame {self.frame}>"


def _one_for_each(model: _Model | Sequence[_Model], collider_count: int) -> list[_Model]:
    """The mesh or map that replaces the model of each collider; None for a model of the scene."""
    if model is None:
        return [None] * collider_count
    models = list(model) if isinstance(model, (list, tuple)) else [model]
    if len(models) != collider_count:
        raise ValueError(
            f"the scene has {collider_count} colliders, and model has {len(models)}: pass a list with one for each, and None for the scene's own"
        )
    return models


class _Files:
    """The files of a scene, and the folders in which they are looked up."""

    def __init__(self, folders: Sequence[pathlib.Path]) -> None:
        self.folders = folders

    def find(self, name: str) -> pathlib.Path:
        return pathlib.Path(_core.find_model(name, self.folders))

    def cloth(self, file: str | None, given: MeshLike | None, argument: str) -> _Drawn:
        if given is not None:
            return arrays_of(given, argument), []
        return (None, []) if file is None else _core.read_mesh_and_edges(self.find(file))

    def cache(self, cache: tuple[str, float, str], mesh: _core.Arrays) -> _core.VertexCache:
        name, frames_per_second, animation = cache
        return _core.VertexCache.read(_core.find_cache(name, self.folders), *mesh, frames_per_second, animation)


def _load_collider(
    scene: _core.Scene, index: int, given: _Model, files: _Files, threads: int
) -> tuple[_core.ColliderMap, _core.VertexCache | None]:
    """The map of a collider, and the cache by which it deforms."""
    file, cache_file = scene.model_file(index), scene.cache_file(index)
    if isinstance(given, (ExactMap, DistanceMap)):
        if cache_file is not None:
            raise ValueError(f"collider {index} has a vertex cache, which takes a mesh as its model, not a map")
        return _core.ColliderMap(given._built), None
    if given is not None:
        arrays = arrays_of(given, "model")
    else:
        arrays = scene.make_model(index) if file is None else arrays_of(read_mesh(files.find(file)))
    arrays = scene.repair(index, *arrays)
    if not (scene.surfaces_collide or scene.allow_open_colliders):
        _require_closed(Mesh(*arrays), file or "the model")
    if cache_file is None:
        return scene.build_map(*arrays, threads), None
    cache = files.cache(cache_file, arrays)
    return scene.build_map(cache.at(0), arrays[1], threads), cache


def _require_closed(mesh: Mesh, name: str) -> None:
    report = inspect(mesh)
    if not report.closed:
        raise Error(
            f"{name}: the model is not closed, so cloth would pass through it: {report.border_edges.count} edges have"
            f" one face, {report.misoriented_edges.count} have faces that disagree about the outside; repair it, or use"
            " the collision of surfaces",
            "invalid_mesh",
        )
