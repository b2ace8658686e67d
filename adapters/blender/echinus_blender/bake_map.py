"""The operator that writes the exact map of a mesh as a file."""

import bpy
from bpy_extras.io_utils import ExportHelper

from . import Refusal
from .meshes import require_mesh, world_mesh
from .motion_files import writable_place
from .operators import Reporting, object_mode


class BakeMap(Reporting, bpy.types.Operator, ExportHelper):
    """Write the exact map of the active mesh, as the view shows it, in the frame and the unit of the world"""

    bl_idname = "echinus.bake_map"
    bl_label = "Bake Map"
    bl_options = {"REGISTER"}

    filename_ext = ".ech"
    filter_glob: bpy.props.StringProperty(default="*.ech", options={"HIDDEN"})

    def execute(self, context):
        with object_mode(context):
            found, refused = self.refused_by(write_map, context, self.filepath)
        if refused:
            return {"CANCELLED"}
        sentence, is_closed = found
        self.tell(context.scene, sentence, is_bad=not is_closed)
        return {"FINISHED"}


def write_map(echinus, context, file):
    """A sentence about the file, and whether the mesh is closed."""
    require_mesh(context.object, "active object")
    if not file:
        raise Refusal("Name the file that takes the map")
    path = writable_place(file, "file")
    mesh = echinus.Mesh(*world_mesh(context, context.object))
    exact = echinus.ExactMap(mesh)
    exact.save(path)
    sentence = f"{path.name}: {len(mesh.faces)} faces, {exact.byte_count / 1e6:.2f} MB"
    is_closed = echinus.inspect(mesh).closed
    return sentence + ("" if is_closed else "; not closed, where inside is a guess"), is_closed
