"""The operator that finds the parts of a cloth that are inside bodies or cut by them, at the present frame."""

from dataclasses import dataclass

import bpy
import numpy as np

from .bodies import bodies_of, said_of
from .meshes import (
    evaluated_mesh,
    in_world,
    matrix_of,
    require_mesh,
    triangles_of,
    vertices_of,
    world_mesh,
)
from .modifiers import modifiers_after_motion, unchecked_movers, without
from .operators import Reporting, object_mode

INSIDE, CUT = "Echinus Inside", "Echinus Cut"


class CheckCollisions(Reporting, bpy.types.Operator):
    """Put the cloth's vertices inside bodies, and those of faces that bodies cut, into vertex groups"""

    bl_idname = "echinus.check_collisions"
    bl_label = "Check Collisions"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        with object_mode(context):
            found, refused = self.refused_by(find_collisions, context)
            if refused:
                return {"CANCELLED"}
            cloth = context.scene.echinus.cloth
            fill_group(cloth, INSIDE, found.inside)
            fill_group(cloth, CUT, found.cut_vertices)
        sentence = f"{cloth.name}: {len(found.inside)} vertices inside, {len(found.cut_faces)} faces cut"
        is_bad = bool(len(found.inside) or len(found.cut_faces) or found.reservations)
        self.tell(context.scene, sentence + found.reservations, is_bad)
        return {"FINISHED"}


@dataclass(frozen=True)
class Collisions:
    """Vertices inside, polygons cut and the vertices of these, and the reservations about the count, as texts."""

    inside: np.ndarray
    cut_faces: np.ndarray
    cut_vertices: np.ndarray
    reservations: str


def find_collisions(echinus, context):
    cloth = context.scene.echinus.cloth
    require_mesh(cloth, "cloth")
    bodies, skipped = bodies_of(context)
    with without(modifiers_after_motion(cloth)):
        with evaluated_mesh(context, cloth) as (evaluated, mesh):
            vertices = in_world(vertices_of(mesh), matrix_of(evaluated))
            triangles, polygons = triangles_of(mesh)
    surface = echinus.Mesh(vertices, triangles)
    inside = np.zeros(len(vertices), bool)
    cut, open_bodies = [], []
    for body in bodies:
        mesh = echinus.Mesh(*world_mesh(context, body))
        inside |= echinus.ExactMap(mesh).contains(surface.vertices)
        cut.append(echinus.intersecting_pairs(surface, mesh)[:, 0])
        if not echinus.inspect(mesh).closed:
            open_bodies.append(body.name)
    cut = np.unique(np.concatenate(cut))
    reservations = f"; {', '.join(open_bodies)} not closed, where inside is a guess" if open_bodies else ""
    reservations += said_of(skipped) + unchecked_movers(cloth)
    return Collisions(np.flatnonzero(inside), np.unique(polygons[cut]), np.unique(triangles[cut]), reservations)


def fill_group(thing, name, vertices):
    """Makes the group contain exactly these vertices, with weight 1."""
    group = thing.vertex_groups.get(name) or thing.vertex_groups.new(name=name)
    group.remove(range(len(thing.data.vertices)))
    group.add(vertices.tolist(), 1, "REPLACE")
