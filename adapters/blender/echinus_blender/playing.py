"""The motion of a cloth as a file and as a modifier that plays it."""

import pathlib

import bpy
import numpy as np

from .modifiers import MOTION, motion_modifier_of, place_motion
from .point_cache import write_point_cache


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
    modifier = motion_modifier_of(cloth) or cloth.modifiers.new(MOTION, "MESH_CACHE")
    place_motion(cloth, modifier)
    modifier.cache_format = "PC2"
    modifier.filepath = bpy.path.relpath(str(path)) if bpy.data.filepath else str(path)
    modifier.frame_start = first_frame
    modifier.show_viewport = modifier.show_render = True
