"""Deformables: cloth, soft bodies, and several of them together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from echinus import _core
from echinus._arguments import list_of_kind, number, of_kind, whole
from echinus._meshes import Mesh, MeshLike, arrays_of
from echinus._tetrahedra import TetrahedralMesh


class Deformable:
    """Particles with their constraints and materials, as made by :func:`make_cloth` or :func:`make_soft_body`.

    A deformable is immutable: a simulation works on a copy.
    """

    _deformable: _core.Deformable

    def __init__(self) -> None:
        raise TypeError("use echinus.make_cloth(), make_cloth_of_mesh(), make_soft_body() or combine()")

    @classmethod
    def _of(cls, core: _core.Deformable) -> Deformable:
        deformable = cls.__new__(cls)
        deformable._deformable = core
        return deformable

    @property
    def positions(self) -> NDArray[np.float32]:
        """(particle_count, 3) The initial positions; a read-only view."""
        return self._deformable.positions

    @property
    def inverse_masses(self) -> NDArray[np.float32]:
        """(particle_count,) 1 / mass; 0 for a particle that is pinned or attached. A read-only view."""
        return self._deformable.inverse_masses

    @property
    def faces(self) -> NDArray[np.uint32]:
        """(face_count, 3) The particles of each face; a read-only view."""
        return self._deformable.faces

    @property
    def tetrahedra(self) -> NDArray[np.uint32]:
        """(tetrahedron_count, 4) The particles of each tetrahedron; a read-only view."""
        return self._deformable.tetrahedra

    @property
    def constraint_count(self) -> int:
        """The number of distance constraints."""
        return self._deformable.constraint_count

    @property
    def mesh(self) -> Mesh:
        """The faces in their initial positions."""
        return Mesh(self.positions, self.faces)

    def __len__(self) -> int:
        return len(self.positions)

    def __reduce__(self) -> tuple[Any, ...]:
        return _deformable_of, (self._deformable.parts(),)

    def __repr__(self) -> str:
        return (
            f"<echinus.Deformable: {len(self)} particles, {len(self.faces)} faces, {self.constraint_count} constraints,"
            f" {len(self.tetrahedra)} tetrahedra>"
        )


def make_cloth(
    *,
    column_count: int = 100,
    row_count: int = 100,
    width: float = 1,
    height: float = 1,
    position: Sequence[float] = (0, 0, 0),
    rotation: Sequence[float] = (1, 0, 0, 0),
    pins: ArrayLike = (),
) -> Deformable:
    """Makes a rectangular sheet of cloth at rest: columns along x, rows along y, its middle at ``position``.

    Parameters
    ----------
    column_count
        Particles along x; at most 2^24 in total (2 to 8388608).
    row_count
        Particles along y. The particle (row, column) has the number row * column_count + column (2 to 8388608).
    width
        Length along x (positive).
    height
        Length along y (positive).
    position
        Initial pose of the middle of the sheet.
    rotation
        Unit quaternion w, x, y, z.
    pins
        Particles that do not move.

    Raises
    ------
    Error
        ``invalid_options``.
    """
    return Deformable._of(_core.make_cloth(locals()))


def make_cloth_of_mesh(
    mesh: MeshLike,
    *,
    position: Sequence[float] = (0, 0, 0),
    rotation: Sequence[float] = (1, 0, 0, 0),
    scale: float = 1,
    rest_vertices: ArrayLike | None = None,
    threads: ArrayLike = (),
    pins: ArrayLike = (),
    attachments: ArrayLike = (),
) -> Deformable:
    """Makes a cloth of any shape, whose particles are the mesh's vertices.

    Parameters
    ----------
    position
        A vertex starts at position + rotation * (scale * vertex).
    rotation
        Unit quaternion w, x, y, z.
    scale
        Scale factor, applied before the pose (1e-9 to 1e9).
    rest_vertices
        The rest shape, if it differs from the mesh: as many vertices as the mesh has, or none.
    threads
        (n, 2) Edges without faces: threads and needles.
    pins
        Vertices that do not move.
    attachments
        (n, 2) Vertices that move with a collider, and the index of that collider in the simulation.

    Raises
    ------
    Error
        ``invalid_mesh``, naming the face, edge or vertex; ``invalid_options``.
    """
    options = locals()
    return Deformable._of(_core.make_cloth_of_mesh(*arrays_of(mesh), options))


def make_soft_body(
    mesh: TetrahedralMesh,
    *,
    density: float = 1000,
    young_modulus: float = 10000,
    poisson_ratio: float = 0.4,
    damping: float = 0,
    position: Sequence[float] = (0, 0, 0),
    rotation: Sequence[float] = (1, 0, 0, 0),
    scale: float = 1,
    pins: ArrayLike = (),
    attachments: ArrayLike = (),
) -> Deformable:
    """Makes a soft body at rest, whose particles are the mesh's vertices and whose faces are its boundary.

    With metres, kilograms and seconds the numbers are in SI units; docs/soft_bodies.md describes the method and
    its limits.

    Parameters
    ----------
    density
        Water has 1000 kg/m^3 (1e-9 to 1e15 mass/length^3).
    young_modulus
        Stiffness; soft tissue has 1e3 to 1e5 Pa (1e-9 to 1e15 mass/(length s^2)).
    poisson_ratio
        Near 0.5 the volume is preserved (0 to 0.4999).
    damping
        Viscosity divided by the shear modulus (0 to 1e9 s).
    position
        A vertex starts at position + rotation * (scale * vertex).
    rotation
        Unit quaternion w, x, y, z.
    scale
        Scale factor, applied before the pose (1e-9 to 1e9).
    pins
        Vertices that do not move.
    attachments
        (n, 2) Vertices that move with a collider, and the index of that collider in the simulation.

    Raises
    ------
    Error
        ``invalid_mesh`` as :func:`require_valid_tetrahedra` does, and for a vertex that no tetrahedron uses;
        ``invalid_options`` for numbers out of range and for vertices that the mesh does not have.
    """
    options = locals()
    body = of_kind("mesh", mesh, TetrahedralMesh, "; tetrahedralize() makes one from a surface")
    return Deformable._of(_core.make_soft_body(body.vertices, body.tetrahedra, options))


def combine(parts: Sequence[Deformable]) -> Deformable:
    """Combines several deformables into one; with ``collision="surfaces_and_self"`` they collide with each other.

    The particles are those of the parts, one part after the other. Masses do not change, so they must be in the same
    unit: see :func:`with_masses_times`.
    """
    return Deformable._of(_core.combine([part._deformable for part in list_of_kind("parts", parts, Deformable)]))


def with_masses_times(factor: float, deformable: Deformable) -> Deformable:
    """Multiplies all masses of a deformable by a finite, positive factor.

    A cloth's particles have the mean mass 1, so multiplying by *mass of the cloth / number of its particles*
    converts them to the unit of that mass.
    """
    core = of_kind("deformable", deformable, Deformable)._deformable
    return Deformable._of(_core.with_masses_times(number("factor", factor), core))


def passing_through(collider: int, deformable: Deformable) -> Deformable:
    """Returns the deformable without collision with one collider, given by its index in the simulation.

    After :func:`combine`, this holds for this part only.
    """
    core = of_kind("deformable", deformable, Deformable)._deformable
    return Deformable._of(_core.passing_through(whole("collider", collider, 0), core))


def _deformable_of(parts: tuple[bytes, ...]) -> Deformable:
    return Deformable._of(_core.deformable_of(parts))
