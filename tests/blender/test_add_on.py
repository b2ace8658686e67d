"""The add-on as a whole: without its module, disabled and enabled."""

import sys

import bpy
import pytest

from objects import activate, add_sphere, result


def test_without_the_module_operators_say_how_to_get_it(monkeypatch):
    activate(add_sphere())
    monkeypatch.setitem(sys.modules, "echinus", None)
    with pytest.raises(RuntimeError, match="install the package python3-echinus"):
        bpy.ops.echinus.check_mesh()


def test_it_works_again_after_it_was_disabled_and_enabled():
    preferences = bpy.context.preferences.addons["echinus_blender"].preferences
    module_folder = preferences.module_folder
    bpy.ops.preferences.addon_disable(module="echinus_blender")
    assert not hasattr(bpy.types.Scene, "echinus") and not hasattr(bpy.types, "ECHINUS_PT_cloth")
    bpy.ops.preferences.addon_enable(module="echinus_blender")
    bpy.context.preferences.addons["echinus_blender"].preferences.module_folder = module_folder
    activate(add_sphere())
    bpy.ops.echinus.check_mesh()
    assert result() == "Sphere: no faults"
