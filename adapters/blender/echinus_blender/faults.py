"""The places of all faults that ``echinus.inspect`` counts. This file does not need Blender."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Faults:
    """Edges are (k, 2) vertices, ascending in each row; the other arrays are ascending indices of faces or vertices.

    Attributes
    ----------
    parted_vertices
        Vertices whose faces form more than one fan; their edges may be without faults.
    """

    border_edges: np.ndarray
    nonmanifold_edges: np.ndarray
    misoriented_edges: np.ndarray
    duplicate_faces: np.ndarray
    degenerate_faces: np.ndarray
    parted_vertices: np.ndarray


def find_faults(vertices, faces):
    """The faults of triangles according to the definitions of ``echinus.MeshReport``.

    Parameters
    ----------
    vertices : (n, 3) float32
    faces : (m, 3) integers, in range
    """
    ends, corners = _edge_uses(faces)
    edges, edge_of_use, use_counts = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True)
    edge_of_use = edge_of_use.reshape(-1)
    ascending = np.bincount(edge_of_use, ends[:, 0] < ends[:, 1], minlength=len(edges))
    return Faults(
        border_edges=edges[use_counts == 1],
        nonmanifold_edges=edges[use_counts > 2],
        misoriented_edges=edges[(use_counts == 2) & (ascending != 1)],
        duplicate_faces=_duplicates(faces),
        degenerate_faces=np.flatnonzero(_has_equal_corners(faces) | ~_normals(vertices, faces).any(axis=1)),
        parted_vertices=_parted_vertices(faces, ends, corners, edge_of_use),
    )


def _has_equal_corners(faces):
    return (faces == np.roll(faces, -1, axis=1)).any(axis=1)


def _edge_uses(faces):
    """For each use of an edge by a face, its two vertices and their corners, which are numbered over all faces.

    Faces with two equal corners have no edges.
    """
    corners = np.arange(3 * len(faces)).reshape(-1, 3)[~_has_equal_corners(faces)]
    uses = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)
    return faces.reshape(-1)[uses], uses


def _duplicates(faces):
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.setdiff1d(np.arange(len(faces)), first)


def _normals(vertices, faces):
    a, b, c = np.moveaxis(vertices.astype(float)[faces], 1, 0)
    return np.cross(b - a, c - a)


def _parted_vertices(faces, ends, corners, edge_of_use):
    """Joins corners of a vertex if their faces share an edge; a vertex with several sets of corners is parted."""
    order = np.argsort(edge_of_use, kind="stable")
    is_same_edge = edge_of_use[order][1:] == edge_of_use[order][:-1]
    one, other = order[:-1][is_same_edge], order[1:][is_same_edge]
    is_turned = ends[one, 0] != ends[other, 0]
    turned = np.where(is_turned[:, None], corners[other][:, ::-1], corners[other])
    sets = _joined(3 * len(faces), corners[one].reshape(-1), turned.reshape(-1))
    used = np.unique(corners)
    of_vertex = np.unique(np.stack([faces.reshape(-1)[used], sets[used]], axis=1), axis=0)[:, 0]
    vertices, set_counts = np.unique(of_vertex, return_counts=True)
    return vertices[set_counts > 1]


def _joined(count, a, b):
    """For each of ``count`` items, the least member of its set, after every a[i] has been joined with b[i]."""
    least = np.arange(count)
    while True:
        before = least.copy()
        lower = np.minimum(least[a], least[b])
        np.minimum.at(least, a, lower)
        np.minimum.at(least, b, lower)
        least = least[least]
        if np.array_equal(least, before):
            return least
