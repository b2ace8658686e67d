"""Modifiers of the cloth, before its motion and after it."""

import bpy
import numpy as np
import pytest

from objects import add_sheet, add_sphere, choose, cut_count, result, shown

FRAME_END = 20

STILL = [
    "DATA_TRANSFER",
    "NORMAL_EDIT",
    "WEIGHTED_NORMAL",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX",
    "VERTEX_WEIGHT_PROXIMITY",
    "TRIANGULATE",
    "COLLISION",
    "DYNAMIC_PAINT",
    "FLUID",
    "PARTICLE_SYSTEM",
]


def add_displacement(sheet, strength):
    displace = sheet.modifiers.new("Displace", "DISPLACE")
    displace.direction, displace.mid_level, displace.strength = "Z", 0, strength


def simulate():
    bpy.context.scene.frame_end = FRAME_END
    assert bpy.ops.echinus.simulate_cloth() == {"FINISHED"}


def assert_never_cut(sheet, sphere):
    for frame in range(1, FRAME_END + 1):
        assert cut_count(sheet, sphere, frame) == 0, f"frame {frame}"


@pytest.mark.parametrize("kind", STILL)
def test_a_modifier_that_neither_adds_nor_moves_leaves_those_after_it_before_the_motion(kind):
    sheet, sphere = add_sheet(height=1.7), add_sphere()
    sheet.modifiers.new("Still", kind)
    add_displacement(sheet, -0.4)
    choose(sheet, sphere)
    simulate()
    assert [m.name for m in sheet.modifiers][-2:] == ["Displace", "Echinus"]
    assert np.allclose(shown(sheet, 1).vertices[:, 2], 1.3)
    assert_never_cut(sheet, sphere)
    assert "Displace" not in result()


def test_a_modifier_that_moves_and_came_later_is_before_the_motion_of_the_next_run():
    sheet, sphere = add_sheet(height=1.7), add_sphere()
    choose(sheet, sphere)
    simulate()
    add_displacement(sheet, -0.4)
    assert [m.name for m in sheet.modifiers] == ["Echinus", "Displace"]
    simulate()
    assert [m.name for m in sheet.modifiers] == ["Displace", "Echinus"]
    assert np.allclose(shown(sheet, 1).vertices[:, 2], 1.3)
    assert_never_cut(sheet, sphere)


def test_an_ocean_that_only_moves_comes_before_the_motion():
    sheet, sphere = add_sheet(), add_sphere()
    sheet.modifiers.new("Ocean", "OCEAN").geometry_mode = "DISPLACE"
    choose(sheet, sphere)
    simulate()
    assert [m.name for m in sheet.modifiers] == ["Ocean", "Echinus"]


def test_a_modifier_that_moves_what_one_before_it_added_to_is_named():
    sheet, sphere = add_sheet(), add_sphere()
    sheet.modifiers.new("Finer", "SUBSURF")
    add_displacement(sheet, -0.4)
    choose(sheet, sphere)
    sentence = "Displace after Finer can move the cloth into bodies: put it before Finer"
    simulate()
    assert result().endswith(sentence)
    bpy.ops.echinus.check_collisions()
    assert result().endswith(sentence)
    sheet.modifiers["Displace"].show_viewport = sheet.modifiers["Displace"].show_render = False
    bpy.ops.echinus.check_collisions()
    assert "Displace" not in result()


def test_a_modifier_of_the_user_may_have_the_name_of_the_motions():
    sheet, sphere = add_sheet(), add_sphere()
    sheet.modifiers.new("Echinus", "SUBSURF")
    choose(sheet, sphere)
    for _ in range(3):
        simulate()
        assert [(m.name, m.type) for m in sheet.modifiers] == [("Echinus.001", "MESH_CACHE"), ("Echinus", "SUBSURF")]
