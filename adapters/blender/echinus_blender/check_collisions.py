"""The operator that finds where a cloth is inside bodies or cut by them, at the present frame."""

import bpy
import numpy as np

from .meshes import (
    bodies_of,
    evaluated_mesh,
    in_world,
    leave_edit_mode,
    matrix_of,
    require_mesh,
    triangles_of,
    vertices_of,
    world_mesh,
)
from .modifiers import modifiers_after_motion, unchecked_movers, without
from .reporting import Reporting

INSIDE, CUT = "Echinus Inside", "Echinus Cut"


class CheckCollisions(Reporting, bpy.types.Operator):
    """Put the cloth's vertices inside bodies, and those of faces that bodies cut, into vertex groups"""

    bl_idname = "echinus.check_collisions"
    bl_label = "Check Collisions"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        leave_edit_mode(context)
        found, refused = self.refused_by(find_collisions, context, context.scene.echinus)
        if refused:
            return {"CANCELLED"}
        cloth = context.scene.echinus.cloth
        inside, cut_faces, cut_vertices, open_bodies = found
        fill_group(cloth, INSIDE, inside)
        fill_group(cloth, CUT, cut_vertices)
        sentence = f"{cloth.name}: {len(inside)} vertices inside, {len(cut_faces)} faces cut"
        if open_bodies:
            sentence += f"; {', '.join(open_bodies)} not closed, where inside is a guess"
        movers = unchecked_movers(cloth)
        if movers:
            sentence += f"; {movers}"
        self.tell(context.scene, sentence, is_bad=bool(len(inside) or len(cut_faces) or open_bodies or movers))
        return {"FINISHED"}


def find_collisions(echinus, context, settings):
    """Vertices inside, polygons cut, the vertices of these, and the names of bodies that are not closed."""
    require_mesh(settings.cloth, "cloth")
    bodies = bodies_of(settings)
    with without(modifiers_after_motion(settings.cloth)):
        with evaluated_mesh(context, settings.cloth) as (evaluated, mesh):
            vertices = in_world(vertices_of(mesh), matrix_of(evaluated))
            triangles, polygons = triangles_of(mesh)
    cloth = echinus.Mesh(vertices, triangles)
    inside = np.zeros(len(vertices), bool)
    cut, open_bodies = [], []
    for body in bodies:
        mesh = echinus.Mesh(*world_mesh(context, body))
        inside |= echinus.ExactMap(mesh).contains(cloth.vertices)
        cut.append(echinus.intersecting_pairs(cloth, mesh)[:, 0])
        if not echinus.inspect(mesh).closed:
            open_bodies.append(body.name)
    cut = np.unique(np.concatenate(cut))
    return np.flatnonzero(inside), np.unique(polygons[cut]), np.unique(triangles[cut]), open_bodies


def fill_group(thing, name, vertices):
    """The group has these vertices, with the weight 1, and no other."""
    group = thing.vertex_groups.get(name) or thing.vertex_groups.new(name=name)
    group.remove(range(len(thing.data.vertices)))
    group.add(vertices.tolist(), 1, "REPLACE")
