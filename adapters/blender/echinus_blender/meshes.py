"""Objects of Blender as arrays."""

import contextlib

import numpy as np

from . import Refusal

def require_mesh(candidate, what):
    """
    Raises
    ------
    Refusal
        There is no such object, or it is not a mesh with faces.
    """
    if candidate is None:
        raise Refusal(f"Choose a mesh as the {what}")
    if candidate.type != "MESH":
        raise Refusal(f"{candidate.name} is not a mesh")
    if not candidate.data.polygons:
        raise Refusal(f"{candidate.name} has no faces")


def hindrance(context, thing):
    """Why Blender may not have computed the object, and the remedy; None if it has."""
    if context.scene not in thing.users_scene:
        return "not in the scene", "choose another object"
    if thing.name not in context.view_layer.objects:
        return "excluded from the view layer", "include its collection"
    if not thing.visible_get():
        return f"hidden in frame {context.scene.frame_current}", "show it in the viewport"
    return None


def vertices_of(mesh):
    """(vertex_count, 3) float32, in the object's frame."""
    vertices = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", vertices.ravel())
    return vertices


def triangles_of(mesh):
    """The triangles that Blender draws, (triangle_count, 3) int32, and the polygon of each."""
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    polygons = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    mesh.loop_triangles.foreach_get("polygon_index", polygons)
    return triangles, polygons


def loose_edges_of(mesh):
    """(count, 2) int32: edges that belong to no polygon."""
    edges = np.empty((len(mesh.edges), 2), np.int32)
    mesh.edges.foreach_get("vertices", edges.ravel())
    is_loose = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("is_loose", is_loose)
    return edges[is_loose]


def matrix_of(evaluated):
    """(4, 4) float64: from the object's frame to the world's."""
    return np.array(evaluated.matrix_world, float)


@contextlib.contextmanager
def evaluated_mesh(context, thing):
    """The object and its mesh at the present frame, with the modifiers that are enabled in the view.

    Raises
    ------
    Refusal
        It is hidden, or not in the scene.
    """
    found = hindrance(context, thing)
    if found:
        raise Refusal(f"{thing.name} is {found[0]}: {found[1]}")
    evaluated = thing.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        yield evaluated, mesh
    finally:
        evaluated.to_mesh_clear()


def world_mesh(context, thing):
    """The object as the view shows it: vertices in the world (n, 3) float64, and triangles that look outwards there.

    Raises
    ------
    Refusal
        Its modifiers leave no faces.
    """
    with evaluated_mesh(context, thing) as (evaluated, mesh):
        triangles, _ = triangles_of(mesh)
        if len(triangles) == 0:
            raise Refusal(f"{thing.name} has no faces once its modifiers have worked")
        matrix = matrix_of(evaluated)
        return in_world(vertices_of(mesh), matrix), outwards(triangles, matrix)


def in_world(vertices, matrix):
    """(n, 3) float64"""
    return vertices @ matrix[:3, :3].T + matrix[:3, 3]


def outwards(triangles, matrix):
    """Reverses the faces if the matrix mirrors, so that they look outwards."""
    return triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else triangles
