"""Finds the Python module ``echinus``, or explains how to get it."""

import importlib
import sys

import bpy

from . import Refusal

HOW_TO_INSTALL = (
    "The Python module echinus is missing. On Debian install the package python3-echinus; elsewhere build it for"
    " Blender's Python (docs/python.md) and name its folder in the preferences of this add-on"
)


def load():
    """Returns the module.

    Raises
    ------
    Refusal
        The module, or a library that it needs, is missing.
    """
    folder = bpy.path.abspath(bpy.context.preferences.addons[__package__].preferences.module_folder)
    if folder and folder not in sys.path:
        sys.path.append(folder)
        importlib.invalidate_caches()
    try:
        return importlib.import_module("echinus")
    except ModuleNotFoundError as error:
        if error.name != "echinus":
            raise Refusal(f"The Python module echinus cannot be used: {error}") from error
        raise Refusal(HOW_TO_INSTALL) from error
    except ImportError as error:
        raise Refusal(f"The Python module echinus cannot be used: {error}") from error


def problem():
    """Why the module cannot be used; empty if it can."""
    try:
        load()
    except Refusal as refusal:
        return str(refusal)
    return ""
