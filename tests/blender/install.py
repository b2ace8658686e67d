"""Installs the add-on from its zip and enables it, as a user does in the preferences; run by scripts/blender."""

import pathlib

import addon_utils
import bpy

BUILD = pathlib.Path(__file__).resolve().parents[2] / "build"

bpy.ops.preferences.addon_install(filepath=str(BUILD / "blender" / "echinus_blender.zip"), overwrite=True)
bpy.ops.preferences.addon_enable(module="echinus_blender")
assert addon_utils.check("echinus_blender")[1], "the add-on does not load"
(module_folder,) = (BUILD / "python" / "venv").glob("lib/python*/site-packages")
bpy.context.preferences.addons["echinus_blender"].preferences.module_folder = str(module_folder)

from echinus_blender import library  # noqa: E402

library.load()  # the tests use it, too
