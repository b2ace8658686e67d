"""The motion of a cloth as a file and as a modifier that plays it."""

from dataclasses import dataclass

import bpy
import numpy as np

from . import Refusal
from .modifiers import MOTION, motion_modifier_of, place_motion
from .motion_files import place_of_motion, remember
from .point_cache import write_point_cache


def to_object_frame(recorded, matrices):
    """(frames, n, 3) float32: from the world to the object's frame in each frame."""
    frames = []
    for positions, matrix in zip(recorded, matrices):
        inverse = np.linalg.inv(matrix)
        frames.append(positions @ inverse[:3, :3].T + inverse[:3, 3])
    return np.array(frames, np.float32)


@dataclass(frozen=True)
class Destination:
    """The destination of a motion as chosen when its run began: the user may change the scene meanwhile.

    Attributes
    ----------
    cache
        The file as the user named it; empty for one next to the blend file.
    frame_length
        The length of a frame of the scene, in frames of Blender's animation: *Time Stretching*.
    """

    scene_name: str
    cloth_name: str
    cache: str
    first_frame: int
    frame_length: float


def destination_of(scene):
    """
    Raises
    ------
    Refusal
        The motion cannot be written, or the cloth cannot have a modifier.
    """
    cloth = scene.echinus.cloth
    if cloth.library:
        raise Refusal(f"{cloth.name} is linked from another file: simulate it there, or make a library override of it")
    place_of_motion(cloth, scene.echinus.cache_path)
    frame_length = scene.render.frame_map_old / scene.render.frame_map_new
    return Destination(scene.name, cloth.name, scene.echinus.cache_path, scene.frame_start, frame_length)


def play(cloth, destination, recorded, matrices):
    """Writes the motion, and makes a modifier of the cloth play it from the first frame on."""
    path = place_of_motion(cloth, destination.cache)
    write_point_cache(path, to_object_frame(recorded, matrices))
    if not destination.cache:
        remember(path)
    modifier = motion_modifier_of(cloth) or cloth.modifiers.new(MOTION, "MESH_CACHE")
    place_motion(cloth, modifier)
    modifier.cache_format = "PC2"
    modifier.filepath = bpy.path.relpath(str(path)) if bpy.data.filepath else str(path)
    modifier.frame_start = destination.first_frame
    modifier.frame_scale = 1 / destination.frame_length
    modifier.show_viewport = modifier.show_render = True
