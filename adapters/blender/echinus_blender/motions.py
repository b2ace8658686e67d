"""How a body moves through sampled frames: rigidly, or by its vertices. No Blender is needed here."""

from dataclasses import dataclass, field

import numpy as np

#: How far from orthonormal a rotation may be: matrices of Blender are in single precision.
RIGID_TOLERANCE = 1e-5


@dataclass
class BodySamples:
    """A body in each frame.

    Attributes
    ----------
    triangles
        (m, 3), looking outwards in the world; the same in all frames.
    shapes
        For each frame (n, 3) float32 in the object's frame; one and the same array while nothing changes.
    matrices
        For each frame (4, 4), from the object's frame to the world's.
    """

    name: str
    triangles: np.ndarray
    shapes: list = field(default_factory=list)
    matrices: list = field(default_factory=list)

    def add(self, shape, matrix):
        if self.shapes and np.array_equal(shape, self.shapes[-1]):
            shape = self.shapes[-1]
        self.shapes.append(shape)
        self.matrices.append(matrix)


@dataclass(frozen=True)
class Motion:
    """A mesh at the first frame, relative to ``origin``, and what becomes of it.

    Attributes
    ----------
    poses
        Of a body that moves rigidly, for each frame its position and rotation (w, x, y, z); empty if it rests.
    shapes
        Of a body that deforms, (frames, n, 3) relative to ``origin``; None if it does not.
    """

    vertices: np.ndarray
    origin: np.ndarray
    poses: list
    shapes: np.ndarray | None


def motion_of(samples):
    """The simplest motion that the samples allow. Vertices are relative to where the object's origin begins.

    Parameters
    ----------
    samples : BodySamples
        At least one frame.
    """
    first = samples.matrices[0]
    origin = first[:3, 3]
    vertices = samples.shapes[0] @ first[:3, :3].T
    if all(shape is samples.shapes[0] for shape in samples.shapes):
        if all(np.array_equal(matrix, first) for matrix in samples.matrices):
            return Motion(vertices, origin, [], None)
        poses = rigid_poses(samples.matrices)
        if poses:
            return Motion(vertices, origin, poses, None)
    shapes = [shape @ m[:3, :3].T + (m[:3, 3] - origin) for shape, m in zip(samples.shapes, samples.matrices)]
    return Motion(vertices, origin, [], np.array(shapes, np.float32))


def rigid_poses(matrices):
    """Position and rotation in each frame of what the first frame's rotation and scale were applied to before.

    Returns
    -------
    list
        Empty if the scale, or shear, changes between frames, or a scale is 0.
    """
    if np.linalg.matrix_rank(matrices[0][:3, :3]) < 3:
        return []
    inverse = np.linalg.inv(matrices[0][:3, :3])
    rotations = [matrix[:3, :3] @ inverse for matrix in matrices]
    if any(abs(r.T @ r - np.eye(3)).max() > RIGID_TOLERANCE or np.linalg.det(r) < 0 for r in rotations):
        return []
    return [(matrix[:3, 3], quaternion_of(rotation)) for matrix, rotation in zip(matrices, rotations)]


def quaternion_of(rotation):
    """The unit quaternion w, x, y, z of a rotation matrix.

    The four products of its components with the largest of them are read off the matrix, so none is a small difference.
    """
    (a, b, c), (d, e, f), (g, h, i) = rotation
    products = np.array(
        [
            [1 + a + e + i, h - f, c - g, d - b],
            [h - f, 1 + a - e - i, b + d, c + g],
            [c - g, b + d, 1 - a + e - i, f + h],
            [d - b, c + g, f + h, 1 - a - e + i],
        ]
    )
    largest = products[np.argmax(products.diagonal())]
    return largest / np.linalg.norm(largest)
