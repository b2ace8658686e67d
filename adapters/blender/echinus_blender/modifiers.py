"""The modifiers of a cloth that come before its motion, and the one that plays the motion."""

import contextlib
import re

import bpy

#: The name of the modifier that plays the motion. Blender appends a number if the user has one of this name.
MOTION = "Echinus"

#: Modifiers that move vertices and keep their number.
MOVING = {
    "ARMATURE",
    "CAST",
    "CLOTH",
    "CORRECTIVE_SMOOTH",
    "CURVE",
    "DISPLACE",
    "DYNAMIC_PAINT",
    "HOOK",
    "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH",
    "LATTICE",
    "MESH_CACHE",
    "MESH_DEFORM",
    "OCEAN",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SMOOTH",
    "SOFT_BODY",
    "SURFACE_DEFORM",
    "WARP",
    "WAVE",
}

#: Modifiers that change neither the positions of vertices nor their number.
STILL = {
    "COLLISION",
    "DATA_TRANSFER",
    "FLUID",
    "NORMAL_EDIT",
    "PARTICLE_SYSTEM",
    "SURFACE",
    "TRIANGULATE",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX",
    "VERTEX_WEIGHT_PROXIMITY",
    "WEIGHTED_NORMAL",
}


def _may_add(modifier):
    """Whether the modifier may change the number of vertices."""
    if modifier.type == "FLUID":
        return modifier.fluid_type == "DOMAIN"
    if modifier.type == "OCEAN":
        return modifier.geometry_mode == "GENERATE"
    return modifier.type not in MOVING | STILL


def motion_modifier_of(cloth):
    """The modifier that plays the motion of a cloth; None if there is none."""
    mine = re.compile(rf"{MOTION}(\.\d+)?")
    return next((each for each in cloth.modifiers if each.type == "MESH_CACHE" and mine.fullmatch(each.name)), None)


def modifiers_after_motion(cloth):
    """The first modifier that may change the number of vertices, and all that follow it."""
    adding = [_may_add(modifier) for modifier in cloth.modifiers]
    return cloth.modifiers[adding.index(True) :] if True in adding else []


def place_motion(cloth, modifier):
    """Puts the modifier after those whose effect the motion contains, and before those that work on its result."""
    others = [_may_add(each) for each in cloth.modifiers if each.name != modifier.name]
    index = others.index(True) if True in others else len(others)
    with bpy.context.temp_override(object=cloth):
        bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=index)


def unchecked_movers(cloth):
    """The end of a sentence, about modifiers that move the cloth after its motion; empty if there are none."""
    adding, *later = list(modifiers_after_motion(cloth)) or [None]
    moving = [each for each in later if each.type in MOVING and not _may_add(each)]
    movers = [each.name for each in moving if each.show_viewport or each.show_render]
    if not movers:
        return ""
    return f"; {', '.join(movers)} after {adding.name} can move the cloth into bodies: put it before {adding.name}"


@contextlib.contextmanager
def without(modifiers):
    """Disables these modifiers in the view meanwhile."""
    shown = [modifier for modifier in modifiers if modifier.show_viewport]
    for modifier in shown:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in shown:
            modifier.show_viewport = True
