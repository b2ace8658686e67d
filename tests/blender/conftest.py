import bpy
import pytest


@pytest.fixture(autouse=True)
def empty_scene():
    """Every test begins with a scene of 24 frames a second without objects."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1
    scene.frame_start, scene.frame_end = 1, 13
    return scene
