"""Check Collisions, in Blender."""

import bpy
import numpy as np
import pytest

import echinus as ech
from objects import activate, add, add_sheet, add_sphere, choose, result, shown


def members(thing, name):
    group = thing.vertex_groups[name]
    return [v.index for v in thing.data.vertices for g in v.groups if g.group == group.index and g.weight == 1]


def expected(cloth, body):
    cloth, body = shown(cloth), shown(body)
    inside = np.flatnonzero(ech.ExactMap(body).contains(cloth.vertices))
    cut = np.unique(ech.intersecting_pairs(cloth, body)[:, 0])
    return inside.tolist(), cut, np.unique(cloth.faces[cut]).tolist()


def assert_found(cloth, body):
    assert bpy.ops.echinus.check_collisions() == {"FINISHED"}
    inside, cut, cut_vertices = expected(cloth, body)
    assert members(cloth, "Echinus Inside") == inside
    assert members(cloth, "Echinus Cut") == cut_vertices
    assert result().startswith(f"Sheet: {len(inside)} vertices inside, {len(cut)} faces cut")
    return len(inside), len(cut)


def test_what_is_inside_and_cut_is_in_vertex_groups():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    inside, cut = assert_found(sheet, sphere)
    assert inside > 10 and cut > 10


def test_nothing_is_found_where_nothing_meets_and_old_groups_are_emptied():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    bpy.ops.echinus.check_collisions()
    sheet.location.z = 2
    assert assert_found(sheet, sphere) == (0, 0)


def test_scaled_turned_and_mirrored_objects_are_judged_where_they_are():
    place = {"rotation_euler": (0.4, 0.3, 0.2), "scale": (0.5, 2, -1)}
    sheet, sphere = add_sheet(height=0.3, **place), add_sphere(scale=(1.5, 0.4, 1), rotation_euler=(1, 0, 0))
    choose(sheet, sphere)
    inside, cut = assert_found(sheet, sphere)
    assert inside > 3 and cut > 3


def test_modifiers_of_the_body_count_and_those_of_the_cloth_that_only_add_vertices_do_not():
    sheet, sphere = add_sheet(height=1.05), add_sphere()
    choose(sheet, sphere)
    assert assert_found(sheet, sphere) == (0, 0)
    displace = sphere.modifiers.new("Grow", "DISPLACE")
    displace.strength = 0.4
    displace.mid_level = 0
    inside, _ = assert_found(sheet, sphere)
    assert inside > 3
    sheet.modifiers.new("Finer", "SUBSURF")
    bpy.ops.echinus.check_collisions()
    assert len(members(sheet, "Echinus Inside")) == inside
    assert sheet.modifiers["Finer"].show_viewport


def test_all_meshes_of_a_collection_are_bodies():
    collection = bpy.data.collections.new("Bodies")
    bpy.context.scene.collection.children.link(collection)
    sheet = add_sheet(height=0, size=8, count=30)
    for x in (-2, 2):
        collection.objects.link(add_sphere(location=(x, 0, 0)))
    collection.objects.link(sheet)
    bpy.context.scene.echinus.cloth, bpy.context.scene.echinus.more_bodies = sheet, collection
    bpy.ops.echinus.check_collisions()
    inside = shown(sheet).vertices[members(sheet, "Echinus Inside")]
    assert (inside[:, 0] > 1).any() and (inside[:, 0] < -1).any()


def test_an_open_body_is_judged_and_named():
    sphere = ech.make_sphere(1, 32, 16)
    sheet, bowl = add_sheet(height=0.5), add("Bowl", ech.Mesh(sphere.vertices, sphere.faces[:-100]))
    choose(sheet, bowl)
    bpy.ops.echinus.check_collisions()
    assert result().endswith("; Bowl not closed, where inside is a guess")


def test_missing_objects_are_refused():
    with pytest.raises(RuntimeError, match="Choose a mesh as the cloth"):
        bpy.ops.echinus.check_collisions()
    sheet = add_sheet()
    choose(sheet, None)
    with pytest.raises(RuntimeError, match="Choose a mesh other than the cloth as the body"):
        bpy.ops.echinus.check_collisions()
    choose(sheet, sheet)
    with pytest.raises(RuntimeError, match="other than the cloth"):
        bpy.ops.echinus.check_collisions()
    choose(sheet, add("Empty", ech.Mesh(np.empty((0, 3)), np.empty((0, 3), int))))
    with pytest.raises(RuntimeError, match="Empty has no faces"):
        bpy.ops.echinus.check_collisions()


def test_a_hidden_body_is_refused():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    sphere.hide_viewport = True
    with pytest.raises(RuntimeError, match="Sphere is hidden"):
        bpy.ops.echinus.check_collisions()


def test_undo_takes_the_groups_away():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    activate(sheet)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.echinus.check_collisions("EXEC_DEFAULT", True)
    assert len(bpy.data.objects["Sheet"].vertex_groups) == 2
    bpy.ops.ed.undo()
    assert len(bpy.data.objects["Sheet"].vertex_groups) == 0


def test_the_mode_is_what_it_was():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    activate(sheet)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.echinus.check_collisions()
    assert sheet.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(members(sheet, "Echinus Inside")) > 10
    bpy.ops.object.armature_add()
    bpy.ops.object.mode_set(mode="POSE")
    bpy.ops.echinus.check_collisions()
    assert bpy.context.object.mode == "POSE"
