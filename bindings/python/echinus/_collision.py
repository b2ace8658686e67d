"""Collision for your own solver."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import index, list_of_kind, number, quaternion, vector
from echinus._colliders import Collider


class ParticleCollision:
    """Keeps the particles of any solver out of models.

    After each step of the solver, :meth:`correct` moves particles that entered or crossed a model back out. With exact
    maps of closed meshes, a particle that begins a step outside ends it outside, however fast it or the models move,
    within the limits of docs/limits.md. Several threads may call its methods, but only one computes at a time.

    Parameters
    ----------
    colliders
        The models in their initial poses; their velocities are ignored.
    thickness
        The distance that particles keep from the surface (0 to 1e9).
    friction
        Coulomb's coefficient of friction between particles and models; 0: no friction (0 to 1e9).
    allow_open_colliders
        Accept exact maps of open meshes, for which nothing is guaranteed.
    threads
        Threads that share a step; 0: all cores. The results are bit-identical for any number (0 to 1024).

    Raises
    ------
    Error
        ``invalid_options``, naming the fault.
    """

    _collision: _core.ParticleCollision

    def __init__(
        self,
        colliders: Sequence[Collider],
        thickness: float,
        *,
        friction: float = 0.5,
        allow_open_colliders: bool = False,
        threads: int = 1,
    ) -> None:
        options = dict(locals())
        models = [collider._arguments() for collider in list_of_kind("colliders", colliders, Collider)]
        self._collision = _core.ParticleCollision(models, number("thickness", thickness), options)

    def set_collider_pose(self, collider: int, position: Sequence[float], rotation: Sequence[float] = (1, 0, 0, 0)) -> None:
        """Moves a collider to a pose during the solver's next step, rotating along the shorter arc; then it stops.

        Parameters
        ----------
        collider
            The index of the collider.
        rotation
            Unit quaternion w, x, y, z.
        """
        self._collision.set_collider_pose(index("collider", collider), vector("position", position), quaternion("rotation", rotation))

    def place_collider(self, collider: int, position: Sequence[float], rotation: Sequence[float] = (1, 0, 0, 0)) -> None:
        """Places a collider at a pose at once, as after a cut in a film: no particle is swept along the jump."""
        self._collision.place_collider(index("collider", collider), vector("position", position), quaternion("rotation", rotation))

    def set_collider_friction(self, collider: int, friction: float) -> None:
        """Sets the friction of one collider."""
        self._collision.set_collider_friction(index("collider", collider), number("friction", friction))

    def correct(
        self,
        previous_positions: ArrayLike,
        positions: NDArray[np.float32],
        velocities: NDArray[np.float32] | None = None,
        inverse_masses: ArrayLike | None = None,
        *,
        seconds: float,
    ) -> NDArray[np.uint32]:
        """Corrects the particles after a step of the solver, in place, and moves the colliders.

        A particle whose position is not finite is not changed and collides with nothing. Collision starts afresh for a
        particle whose previous position is not the one at which the last step ended.

        Parameters
        ----------
        previous_positions
            (n, 3) The positions at the start of the step.
        positions
            (n, 3) The solver's positions, in a contiguous float32 array, which is corrected in place.
        velocities
            (n, 3) The velocities, in units per second, which are corrected, too.
        inverse_masses
            (n,) 1 / mass, in any unit; 0 for pinned particles, which no collider pushes.
        seconds
            The duration of the step.

        Returns
        -------
        The indices of corrected particles, ascending.

        Raises
        ------
        Error
            ``invalid_options`` for arrays of different sizes, a negative mass, or a duration that is not positive.
        """
        return self._collision.correct(previous_positions, positions, velocities, inverse_masses, number("seconds", seconds))

    @property
    def lost_count(self) -> int:
        """The number of times that a particle that had once been outside an exact map ended a step inside it or on the
        other side of its surface."""
        return self._collision.lost_count


class SurfaceCollision:
    """Keeps the faces that join the particles of any solver off models and off each other.

    After :meth:`correct` no face intersects a model or, with ``self_collision``, another face, within the limits of
    docs/limits.md. Several threads may call its methods, but only one computes at a time.

    Parameters
    ----------
    positions
        (n, 3) The initial positions. No face may intersect a model or, with ``self_collision``, another face, and no
        particle may be inside a closed model (but see ``untangle``).
    faces
        (m, 3) The faces between the particles.
    colliders
        The models in their initial poses; their velocities are ignored.
    thickness
        The distance to keep from colliders (0 to 1e9); the effective value is at least a fiftieth of the mean edge
        length.
    friction
        Coulomb's coefficient of friction; 0: no friction (0 to 1e9).
    self_thickness
        Distance that layers keep from each other; less near small faces. By default the thickness (0 to 1e9).
    self_collision
        Faces do not intersect each other either.
    untangle
        Separate an initial state in which surfaces intersect or particles are inside the model, instead of
        rejecting it.
    threads
        Threads that share a step; 0: all cores. The results are bit-identical for any number (0 to 1024).

    Raises
    ------
    Error
        ``invalid_options``, naming the fault or the intersecting faces.
    """

    _collision: _core.SurfaceCollision

    def __init__(
        self,
        positions: ArrayLike,
        faces: ArrayLike,
        colliders: Sequence[Collider],
        thickness: float,
        *,
        friction: float = 0.5,
        self_thickness: float | None = None,
        self_collision: bool = True,
        untangle: bool = False,
        threads: int = 1,
    ) -> None:
        options = dict(locals())
        models = [collider._arguments() for collider in list_of_kind("colliders", colliders, Collider)]
        start, joined = _core.float_array(positions, "positions"), _core.face_array(faces)
        self._collision = _core.SurfaceCollision(start, joined, models, number("thickness", thickness), options)

    def set_collider_pose(self, collider: int, position: Sequence[float], rotation: Sequence[float] = (1, 0, 0, 0)) -> None:
        """Moves a collider to a pose during the solver's next step, rotating along the shorter arc; then it stops.

        Parameters
        ----------
        collider
            The index of the collider.
        rotation
            Unit quaternion w, x, y, z.
        """
        self._collision.set_collider_pose(index("collider", collider), vector("position", position), quaternion("rotation", rotation))

    def correct(
        self,
        positions: NDArray[np.float32],
        velocities: NDArray[np.float32] | None = None,
        *,
        seconds: float,
    ) -> NDArray[np.uint32]:
        """Corrects the particles after a step of the solver, in place, and moves the colliders.

        The step starts from the positions at the end of the last one.

        Parameters
        ----------
        positions
            (n, 3) The solver's positions, in a contiguous float32 array, which is corrected in place.
        velocities
            (n, 3) The velocities, in units per second, which are corrected, too.
        seconds
            The duration of the step.

        Returns
        -------
        The indices of corrected particles, ascending.

        Raises
        ------
        Error
            ``invalid_options`` for arrays of the wrong size or a duration that is not positive.
        """
        return self._collision.correct(positions, velocities, number("seconds", seconds))

    @property
    def unresolved_count(self) -> int:
        """The number of unresolved pairs of elements, summed over all steps; if it is 0, no faces intersect."""
        return self._collision.unresolved_count
