"""The motion of a cloth as a file and as a modifier that plays it."""

import pathlib

import bpy
import numpy as np

from .meshes import DEFORMING
from .point_cache import write_point_cache
from .sampling import MODIFIER


def to_object_frame(recorded, matrices):
    """(frames, n, 3) float32: from the world to the object's frame in each frame."""
    frames = []
    for positions, matrix in zip(recorded, matrices):
        inverse = np.linalg.inv(matrix)
        frames.append(positions @ inverse[:3, :3].T + inverse[:3, 3])
    return np.array(frames, np.float32)


def cache_path_of(settings):
    """Where the motion goes, and whether it lasts: a file that was never saved has no folder beside it."""
    if settings.cache_path:
        return pathlib.Path(bpy.path.abspath(settings.cache_path)), True
    file_name = bpy.path.clean_name(settings.cloth.name) + ".pc2"
    if bpy.data.filepath:
        return pathlib.Path(bpy.path.abspath("//")) / "echinus_cache" / file_name, True
    return pathlib.Path(bpy.app.tempdir) / file_name, False


def play(cloth, recorded, matrices, path, first_frame):
    """Writes the cache, and has a modifier of the cloth play it from ``first_frame`` on."""
    write_point_cache(path, to_object_frame(recorded, matrices))
    modifier = cloth.modifiers.get(MODIFIER)
    if modifier is None or modifier.type != "MESH_CACHE":
        modifier = cloth.modifiers.new(MODIFIER, "MESH_CACHE")
        _move_after_deformation(cloth, modifier)
    modifier.cache_format = "PC2"
    modifier.filepath = bpy.path.relpath(str(path)) if bpy.data.filepath else str(path)
    modifier.frame_start = first_frame
    modifier.show_viewport = modifier.show_render = True


def _move_after_deformation(cloth, modifier):
    """Before the first modifier that may change the number of vertices."""
    others = [each.type in DEFORMING for each in cloth.modifiers if each.name != modifier.name]
    if False in others:
        with bpy.context.temp_override(object=cloth):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=others.index(False))
