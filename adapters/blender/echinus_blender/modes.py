"""Object mode for a while: only there are the data of objects what the user sees in other modes."""

import contextlib

import bpy


@contextlib.contextmanager
def object_mode(context):
    """Afterwards the active object is in its mode again, if it still is the active one."""
    thing = context.object
    mode = thing.mode if thing else "OBJECT"
    if mode == "OBJECT":
        yield
        return
    name = thing.name
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        if context.object and context.object.name == name:
            bpy.ops.object.mode_set(mode=mode)
