"""The common parts of operators: errors, which Blender shows in its window or raises as a RuntimeError in scripts; and a
temporary object mode, since only in it the data of objects include the changes that the user made in other modes."""

import contextlib

import bpy

from . import Refusal, library


class Reporting:
    """For operators: a method that refuses its work ends the operator, and Blender shows the sentence."""

    def refused_by(self, function, *arguments):
        """Returns (the function's result, False), or (None, True) after the reason has been reported to Blender."""
        try:
            echinus = library.load()
        except Refusal as refusal:
            self.report({"ERROR"}, str(refusal))
            return None, True
        try:
            return function(echinus, *arguments), False
        except (Refusal, echinus.Error, OSError) as error:
            self.report({"ERROR"}, str(error))
            return None, True

    def tell(self, scene, sentence, is_bad=False):
        """Shows a result, and keeps it for the panel and for scripts."""
        scene.echinus.result = sentence
        self.report({"WARNING" if is_bad else "INFO"}, sentence)


@contextlib.contextmanager
def object_mode(context):
    """Afterwards returns the active object to its previous mode, if it is still the active one."""
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
