"""The add-on as a whole: without its module, disabled and enabled; and Bake Map, in Blender."""

import sys

import bpy
import pytest

import echinus as ech
from objects import activate, add, add_sphere, result, shown


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


def test_the_map_is_that_of_the_object_where_it_stands(tmp_path):
    sphere = add_sphere(location=(1, 2, 3), scale=(1, 2, -0.5), rotation_euler=(0, 0, 1))
    sphere.modifiers.new("Finer", "SUBSURF")
    activate(sphere)
    path = tmp_path / "sphere.ech"
    assert bpy.ops.echinus.bake_map(filepath=str(path)) == {"FINISHED"}
    mesh, baked = shown(sphere), ech.load(path)
    assert baked.statistics.face_count == len(mesh.faces)
    assert baked.contains([(1, 2, 3), (1, 2, 3.6)]).tolist() == [True, False]
    assert abs(baked.signed_distance(mesh.vertices)).max() < 1e-5
    assert result().startswith(f"sphere.ech: {len(mesh.faces)} faces, ")


def test_an_open_mesh_is_baked_and_said_to_be_open(tmp_path):
    sphere = ech.make_sphere(1, 16, 8)
    activate(add("Torn", ech.Mesh(sphere.vertices, sphere.faces[1:])))
    bpy.ops.echinus.bake_map(filepath=str(tmp_path / "torn.ech"))
    assert result().endswith("; not closed, where inside is a guess")


def test_a_place_that_cannot_be_written_is_refused(tmp_path):
    activate(add_sphere())
    with pytest.raises(RuntimeError, match="nowhere"):
        bpy.ops.echinus.bake_map(filepath=str(tmp_path / "nowhere" / "sphere.ech"))


def test_a_map_without_a_file_without_a_folder_or_in_place_of_one_is_refused(tmp_path):
    activate(add_sphere())
    for file, sentence in (
        ("", "Name the file that takes the map"),
        ("//sphere.ech", 'The file "//sphere.ech" has no folder: save the blend file first, or name a whole path'),
        (str(tmp_path), f"{tmp_path} is not a file that may be replaced: name another file"),
    ):
        with pytest.raises(RuntimeError, match=f"^Error: {sentence}$"):
            bpy.ops.echinus.bake_map(filepath=file)


def test_the_mode_is_what_it_was(tmp_path):
    activate(add_sphere())
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.echinus.bake_map(filepath=str(tmp_path / "sphere.ech"))
    assert bpy.context.object.mode == "EDIT"
