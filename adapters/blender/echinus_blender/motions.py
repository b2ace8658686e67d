"""The motion of a body through sampled frames: rigid, or by its vertices. This file does not need Blender."""

from dataclasses import dataclass, field

import numpy as np

#: How far a rotation may deviate from orthonormality: matrices of Blender are in single precision.
RIGID_TOLERANCE = 1e-5


@dataclass
class BodySamples:
    """A body in each frame.

    Attributes
    ----------
    triangles
        (m, 3), looking outwards in the world; the same in all frames.
    shapes
        For each frame (n, 3) float32 in the object's frame; the same array as long as nothing changes.
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
    """A mesh at the first frame, relative to ``origin``, and its motion.

    Attributes
    ----------
    poses
        For a body that moves rigidly, its position and rotation (w, x, y, z) in each frame; empty if it is at rest.
    shapes
        For a body that deforms, (frames, n, 3) relative to ``origin``; None if it does not.
    """

    vertices: np.ndarray
    origin: np.ndarray
    poses: list
    shapes: np.ndarray | None


def motion_of(samples):
    """The simplest motion that fits the samples. Vertices are relative to the initial position of the object's origin.

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
    """The position and rotation in each frame of a mesh to which the first frame's rotation and scale have been applied.

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

    The products of its components with the largest of them are computed from the matrix, so none is a small difference.
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
