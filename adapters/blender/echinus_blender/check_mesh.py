"""The operator that selects the faults of a mesh."""

import bmesh
import bpy
import numpy as np

from . import Refusal
from .faults import find_faults
from .meshes import require_mesh, triangles_of, vertices_of
from .operators import Reporting, object_mode

KINDS = [
    ("BORDER", "Open Edges", "Edges with one face: borders of holes and sheets"),
    ("NONMANIFOLD", "Non-manifold", "Edges with more than two faces, and vertices at which several fans of faces meet"),
    ("MISORIENTED", "Misoriented", "Edges whose two faces disagree about the outside"),
    ("DUPLICATE", "Duplicate Faces", "Faces with the same vertices as another"),
    ("DEGENERATE", "Degenerate Faces", "Faces without area"),
    ("INTERSECTING", "Intersections", "Faces that intersect others beyond what they share"),
]


class CheckMesh(Reporting, bpy.types.Operator):
    """Select the faults of the active mesh, without its modifiers"""

    bl_idname = "echinus.check_mesh"
    bl_label = "Check Mesh"
    bl_options = {"REGISTER", "UNDO"}

    kinds: bpy.props.EnumProperty(
        name="Faults",
        description="The faults to look for",
        items=KINDS,
        options={"ENUM_FLAG"},
        default={kind for kind, _, _ in KINDS},
    )

    def execute(self, context):
        with object_mode(context):
            found, refused = self.refused_by(find_selection, context.object, self.kinds)
        if refused:
            return {"CANCELLED"}
        counts, places = found
        name = context.object.name
        bpy.ops.object.mode_set(mode="EDIT")
        select(context, places)
        if counts:
            self.tell(context.scene, f"{name}: {', '.join(counts)}; selected", is_bad=True)
        else:
            self.tell(context.scene, f"{name}: no faults")
        return {"FINISHED"}


def find_selection(echinus, thing, kinds):
    """The counts of faults, as text, and their places: vertices, edges (k, 2) and polygons."""
    require_mesh(thing, "active object")
    if thing.library or thing.data.library or thing.data.override_library:
        raise Refusal(f"{thing.name} is linked from another file, and nothing can be selected: check it there")
    if not kinds:
        raise Refusal("Choose at least one kind of fault to look for")
    vertices = vertices_of(thing.data)
    triangles, polygons = triangles_of(thing.data)
    mesh = echinus.Mesh(vertices, triangles)
    echinus.inspect(mesh)  # refuses what is not finite
    faults = find_faults(vertices, triangles)
    pairs = echinus.self_intersecting_pairs(mesh) if "INTERSECTING" in kinds else np.empty((0, 2), int)
    counts, edges, faces, points = [], [np.empty((0, 2), int)], [np.empty(0, int)], np.empty(0, int)
    for kind, words, found in [
        ("BORDER", "open edges", faults.border_edges),
        ("NONMANIFOLD", "edges with more than two faces", faults.nonmanifold_edges),
        ("MISORIENTED", "misoriented edges", faults.misoriented_edges),
    ]:
        if kind in kinds and len(found):
            counts.append(f"{len(found)} {words}")
            edges.append(found)
    if "NONMANIFOLD" in kinds and len(faults.parted_vertices):
        points = faults.parted_vertices
        counts.append(f"{len(points)} vertices at which several fans of faces meet")
    for kind, words, found in [
        ("DUPLICATE", "duplicate faces", faults.duplicate_faces),
        ("DEGENERATE", "degenerate faces", faults.degenerate_faces),
        ("INTERSECTING", "intersecting faces", np.unique(pairs)),
    ]:
        if kind in kinds and len(found):
            found = np.unique(polygons[found])
            counts.append(f"{len(found)} {words}")
            faces.append(found)
    return counts, (points, np.concatenate(edges), np.concatenate(faces))


def select(context, places):
    """Selects only these elements, in edit mode."""
    points, edges, faces = places
    tool_settings = context.tool_settings
    # A mode in which all selected elements are visible.
    if len(points):
        tool_settings.mesh_select_mode = (True, False, False)
    elif len(edges):
        tool_settings.mesh_select_mode = (False, True, False)
    elif len(faces):
        tool_settings.mesh_select_mode = (False, False, True)
    data = context.object.data
    shape = bmesh.from_edit_mesh(data)
    for sequence in (shape.verts, shape.edges, shape.faces):
        sequence.ensure_lookup_table()
        for element in sequence:
            element.select = False
    found = [shape.verts[vertex] for vertex in points]
    found += [shape.edges.get((shape.verts[a], shape.verts[b])) for a, b in edges]
    found += [shape.faces[face] for face in faces]
    for element in filter(None, found):  # no edge is where triangles of a polygon meet
        element.hide_set(False)  # what is hidden cannot be selected
        element.select_set(True)
    bmesh.update_edit_mesh(data)
