"""Simulate Cloth, in Blender without a window: all at once, as scripts call it."""

import pathlib

import bpy
import numpy as np
import pytest

import echinus as ech
from echinus_blender import simulate_cloth
from objects import activate, add, add_sheet, add_sphere, choose, cut_count, result, shown

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def saved_file(tmp_path):
    """A saved file, beside which the cache goes."""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    return tmp_path


def simulate():
    assert bpy.ops.echinus.simulate_cloth() == {"FINISHED"}


def assert_never_cut(cloth, body):
    scene = bpy.context.scene
    for frame in range(scene.frame_start, scene.frame_end + 1):
        assert cut_count(cloth, body, frame) == 0, f"frame {frame}"


def test_a_sheet_on_a_sphere_plays_what_the_library_computes(saved_file):
    sheet, sphere = add_sheet(height=1.1), add_sphere()
    choose(sheet, sphere)
    start, body = shown(sheet, 1), shown(sphere, 1)
    simulate()
    mine = ech.Simulation(ech.make_cloth_of_mesh(start), [ech.Collider(ech.ExactMap(body))], time_step=1 / 48)
    for frame in range(1, 14):
        assert np.allclose(shown(sheet, frame).vertices, mine.positions, atol=1e-6), f"frame {frame}"
        mine.step(2)  # of the 60 a second that are asked for, what is a whole number a frame
    assert abs(shown(sheet, 13).vertices - start.vertices).max() > 0.3
    assert sheet.modifiers["Echinus"].filepath == "//echinus_cache/scene/Sheet.pc2"
    assert (saved_file / "echinus_cache" / "scene" / "Sheet.pc2").exists()
    assert result().startswith("Sheet: 13 frames in ")


def test_before_and_after_the_simulation_the_cloth_rests():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    simulate()
    assert np.array_equal(shown(sheet, -5).vertices, shown(sheet, 1).vertices)
    assert np.array_equal(shown(sheet, 13).vertices, shown(sheet, 40).vertices)


def test_the_frame_stays_where_it_was_and_the_rate_of_the_scene_counts():
    sheet, sphere = add_sheet(height=5), add_sphere()
    choose(sheet, sphere)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 60, 101, 131
    scene.echinus.air_drag = 0
    scene.frame_set(7)
    simulate()
    assert scene.frame_current == 7
    fallen = 5 - shown(sheet, 131).vertices[:, 2].mean()
    assert fallen == pytest.approx(9.81 * 0.5**2 / 2, rel=0.02)


def test_gravity_is_that_of_the_scene():
    sheet, sphere = add_sheet(height=5), add_sphere()
    choose(sheet, sphere)
    bpy.context.scene.gravity = (0, 0, 2)
    simulate()
    assert shown(sheet, 13).vertices[:, 2].mean() > 5.1
    bpy.context.scene.use_gravity = False
    simulate()
    assert np.allclose(shown(sheet, 13).vertices, shown(sheet, 1).vertices, atol=1e-5)


def test_a_second_simulation_takes_the_place_of_the_first():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    simulate()
    first = shown(sheet, 13).vertices
    bpy.context.scene.frame_set(13)
    simulate()
    assert [m.name for m in sheet.modifiers] == ["Echinus"]
    assert np.array_equal(shown(sheet, 13).vertices, first)


def test_scaled_turned_and_mirrored_objects_collide_where_they_are():
    turned = {"rotation_euler": (0.2, 0.1, 0.5), "scale": (1.2, 0.5, -1)}
    sheet, sphere = add_sheet(height=1.9, **turned), add_sphere(scale=(0.6, 1, 1.5), rotation_euler=(0, 0.4, 0))
    choose(sheet, sphere)
    bpy.context.scene.frame_end = 20
    simulate()
    assert_never_cut(sheet, sphere)
    assert shown(sheet, 20).vertices[:, 2].min() < 1
    assert shown(sheet, 20).vertices[:, 2].max() > 1.2


def test_a_body_that_moves_by_keyframes_is_met_where_it_is():
    sheet, sphere = add_sheet(height=1.1), add_sphere(scale=(1, 1, 1))
    choose(sheet, sphere)
    sphere.keyframe_insert("location", frame=1)
    sphere.keyframe_insert("rotation_euler", frame=1)
    sphere.location, sphere.rotation_euler = (0, 0, 0.8), (0, 0, 1)
    sphere.keyframe_insert("location", frame=13)
    sphere.keyframe_insert("rotation_euler", frame=13)
    simulate()
    assert_never_cut(sheet, sphere)
    assert shown(sheet, 13).vertices[:, 2].max() > 1.7


def test_a_body_bent_by_an_armature_is_met_where_it_is():
    limb = add("Limb", ech.make_box((3, 0.5, 0.5), 8))
    bpy.ops.object.armature_add(enter_editmode=True)
    armature = bpy.context.object
    bones = armature.data.edit_bones
    bones[0].head, bones[0].tail = (-1.5, 0, 0), (0, 0, 0)
    forearm = bones.new("Forearm")
    forearm.head, forearm.tail, forearm.parent = (0, 0, 0), (1.5, 0, 0), bones[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, is_member in (("Bone", lambda x: x <= 0), ("Forearm", lambda x: x > 0)):
        limb.vertex_groups.new(name=name).add([v.index for v in limb.data.vertices if is_member(v.co.x)], 1, "REPLACE")
    limb.modifiers.new("Armature", "ARMATURE").object = armature
    pose = armature.pose.bones["Forearm"]
    pose.rotation_mode = "XYZ"
    pose.keyframe_insert("rotation_euler", frame=1)
    pose.rotation_euler = (0.5, 0, 0) if abs(pose.bone.x_axis.y) > 0.5 else (0, 0, 0.5)
    pose.keyframe_insert("rotation_euler", frame=13)
    moved = abs(shown(limb, 13).vertices - shown(limb, 1).vertices).max()
    assert moved > 0.3, "the armature bends the limb"
    sheet = add_sheet(height=0.35, size=2)
    choose(sheet, limb)
    simulate()
    assert_never_cut(sheet, limb)


def test_modifiers_of_the_body_count():
    sheet, sphere = add_sheet(height=1.6), add_sphere()
    choose(sheet, sphere)
    grow = sphere.modifiers.new("Grow", "DISPLACE")
    grow.strength, grow.mid_level = 0.4, 0
    bpy.context.scene.frame_end = 20
    simulate()
    assert_never_cut(sheet, sphere)
    assert shown(sheet, 20).vertices[:, 2].max() > 1.4


def test_modifiers_that_add_vertices_to_the_cloth_come_after_its_motion():
    sheet, sphere = add_sheet(), add_sphere()
    sheet.modifiers.new("Wave", "WAVE").height = 0.01
    sheet.modifiers.new("Finer", "SUBSURF")
    choose(sheet, sphere)
    simulate()
    assert [m.name for m in sheet.modifiers] == ["Wave", "Echinus", "Finer"]
    assert sheet.modifiers["Finer"].show_viewport
    assert len(shown(sheet, 13).vertices) > len(sheet.data.vertices)
    assert shown(sheet, 13).vertices[:, 2].min() < 1.2


def test_pinned_vertices_stay():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    pins = sheet.vertex_groups.new(name="Pins")
    pins.add([0, 14], 1, "REPLACE")
    pins.add([1], 0.2, "REPLACE")
    bpy.context.scene.echinus.pin_group = "Pins"
    simulate()
    moved = np.linalg.norm(shown(sheet, 13).vertices - shown(sheet, 1).vertices, axis=1)
    assert moved[[0, 14]].max() < 1e-6 and moved[1] > 1e-3
    bpy.context.scene.echinus.pin_group = "Needles"
    with pytest.raises(RuntimeError, match='Sheet has no vertex group "Needles"'):
        bpy.ops.echinus.simulate_cloth()


def test_an_open_body_keeps_the_cloth_on_its_side():
    plate = add("Plate", ech.make_cloth(column_count=3, row_count=3, width=4, height=4).mesh)
    sheet = add_sheet(height=0.3)
    choose(sheet, plate)
    bpy.context.scene.frame_end = 20
    simulate()
    assert 0 < shown(sheet, 20).vertices[:, 2].min() < 0.2


def test_a_body_with_an_edge_of_three_faces_is_met():
    sphere = ech.make_sphere(1, 32, 16)
    a, b, _ = sphere.faces[200]
    tip = len(sphere.vertices)
    vertices = np.concatenate([sphere.vertices, sphere.vertices[[a]] * 1.5])
    fin = ech.Mesh(vertices, np.concatenate([sphere.faces, [[a, b, tip]]]))
    sheet, finned = add_sheet(height=1.6), add("Finned", fin)
    choose(sheet, finned)
    bpy.context.scene.frame_end = 20
    simulate()
    assert_never_cut(sheet, finned)


def test_a_cloth_that_begins_inside_is_refused_and_parted_on_request():
    sheet, sphere = add_sheet(height=0.5), add_sphere()
    choose(sheet, sphere)
    remedy = 'Check Collisions in the first frame shows where; tick "Part the Start" or move them apart'
    with pytest.raises(RuntimeError, match=rf"^Error: Sheet begins intersecting Sphere in \d+ pairs of .*: {remedy}$"):
        bpy.ops.echinus.simulate_cloth()
    assert not sheet.modifiers
    bpy.context.scene.echinus.untangle = True
    simulate()
    assert_never_cut(sheet, sphere)


def test_what_cannot_be_simulated_is_refused():
    with pytest.raises(RuntimeError, match="Choose a mesh as the cloth"):
        bpy.ops.echinus.simulate_cloth()
    sheet = add_sheet()
    choose(sheet, None)
    with pytest.raises(RuntimeError, match="Choose a mesh other than the cloth"):
        bpy.ops.echinus.simulate_cloth()
    nothing = ech.Mesh(np.empty((0, 3)), np.empty((0, 3), int))
    choose(sheet, add("Empty", nothing))
    with pytest.raises(RuntimeError, match="Empty has no faces"):
        bpy.ops.echinus.simulate_cloth()
    choose(add("Nothing", nothing), add_sphere())
    with pytest.raises(RuntimeError, match="Nothing has no faces"):
        bpy.ops.echinus.simulate_cloth()
    choose(sheet, bpy.data.objects["Sphere"])
    bpy.context.scene.frame_end = 1
    with pytest.raises(RuntimeError, match="nothing to simulate"):
        bpy.ops.echinus.simulate_cloth()


def test_a_body_whose_modifiers_change_its_vertices_is_refused_with_the_frame():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    finer = sphere.modifiers.new("Finer", "SUBSURF")
    for frame, shows in ((1, False), (5, True)):
        finer.show_viewport = shows
        finer.keyframe_insert("show_viewport", frame=frame)
    bpy.context.scene.frame_set(3)
    with pytest.raises(RuntimeError, match="Sphere has .* vertices in frame 5"):
        bpy.ops.echinus.simulate_cloth()
    assert bpy.context.scene.frame_current == 3


def test_undo_takes_the_motion_away():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    activate(sheet)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.echinus.simulate_cloth("EXEC_DEFAULT", True)
    assert len(bpy.data.objects["Sheet"].modifiers) == 1
    bpy.ops.ed.undo()
    assert len(bpy.data.objects["Sheet"].modifiers) == 0


def test_the_cloth_on_the_horse_is_never_cut():
    file = ROOT / "models" / "horse.3ds"
    if not file.exists():
        pytest.skip("models/ has no horse: scripts/setup fetches it")
    mesh, _ = ech.repair(ech.read_mesh(file))
    horse = add("Horse", mesh, rotation_euler=(np.pi / 2, 0, 0))  # its y is up
    sheet = add_sheet(height=0.9, count=40, size=2.2)
    choose(sheet, horse)
    scene = bpy.context.scene
    scene.frame_end = 36
    simulate()
    assert_never_cut(sheet, horse)
    assert not ech.ExactMap(shown(horse)).contains(shown(sheet, 36).vertices).any()
    assert len(ech.self_intersecting_pairs(shown(sheet, 36))) == 0
    assert shown(sheet, 36).vertices[:, 2].min() < 0.2


def change_while_computing(monkeypatch, change):
    """The next simulation meets this change of the scene, as by a user, once it is computed."""
    compute_at_once = simulate_cloth.compute_at_once

    def compute_and_change(*arguments):
        done = compute_at_once(*arguments)
        change()
        return done

    monkeypatch.setattr(simulate_cloth, "compute_at_once", compute_and_change)


def test_what_is_chosen_while_it_computes_is_for_the_next_run(monkeypatch):
    sheet, sphere, other = add_sheet(), add_sphere(), add_sheet(count=5)
    choose(sheet, sphere)
    scene = bpy.context.scene

    def change():
        scene.echinus.cloth, scene.echinus.cache_path, scene.frame_start = other, "//other.pc2", 11

    change_while_computing(monkeypatch, change)
    simulate()
    assert not other.modifiers and result().startswith("Sheet: 13 frames")
    assert sheet.modifiers["Echinus"].filepath == "//echinus_cache/scene/Sheet.pc2"
    assert sheet.modifiers["Echinus"].frame_start == 1


def test_the_cloth_may_be_cleared_while_it_computes(monkeypatch):
    sheet = add_sheet()
    choose(sheet, add_sphere())
    change_while_computing(monkeypatch, lambda: choose(None, None))
    simulate()
    assert sheet.modifiers["Echinus"].filepath == "//echinus_cache/scene/Sheet.pc2"


def test_the_result_is_kept_in_the_scene_that_was_simulated(monkeypatch):
    choose(add_sheet(), add_sphere())
    scene = bpy.context.scene

    def change():
        bpy.context.window.scene = bpy.data.scenes.new("Other")

    change_while_computing(monkeypatch, change)
    simulate()
    assert scene.echinus.result.startswith("Sheet: 13 frames") and not result()


def test_a_cloth_that_is_deleted_while_it_computes_is_named(monkeypatch):
    sheet = add_sheet()
    choose(sheet, add_sphere())
    change_while_computing(monkeypatch, lambda: bpy.data.objects.remove(sheet))
    with pytest.raises(RuntimeError, match="Error: Sheet is no longer in the scene Scene: simulate again"):
        bpy.ops.echinus.simulate_cloth()


def test_a_cloth_that_is_edited_while_it_computes_is_named(monkeypatch):
    sheet = add_sheet()
    choose(sheet, add_sphere())
    change_while_computing(monkeypatch, lambda: sheet.data.vertices.add(1))
    with pytest.raises(RuntimeError, match="Error: Sheet has other vertices than when the simulation began"):
        bpy.ops.echinus.simulate_cloth()


@pytest.mark.parametrize(("old", "new"), [(100, 200), (100, 50), (90, 70)])
def test_time_stretching_plays_each_frame_as_it_was_simulated(old, new):
    sheet, sphere = add_sheet(height=1.2), add_sphere()
    choose(sheet, sphere)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 5, 45
    scene.render.frame_map_old, scene.render.frame_map_new = old, new
    for frame, height in ((1, -0.5), (60, 1.5)):
        sphere.location.z = height
        sphere.keyframe_insert("location", frame=frame)
    simulate()
    assert_never_cut(sheet, sphere)
    fall = [1.2 - shown(sheet, frame).vertices[0, 2] for frame in (5, 9)]
    assert fall == pytest.approx([0, 9.81 * (4 / 24) ** 2 / 2], abs=0.02)


def delete(thing):
    """As the key X does: the panel still points to it."""
    bpy.ops.object.select_all(action="DESELECT")
    activate(thing)
    bpy.ops.object.delete()


def test_what_was_deleted_is_named():
    sheet, sphere = add_sheet(), add_sphere()
    choose(sheet, sphere)
    delete(sphere)
    for operator in (bpy.ops.echinus.simulate_cloth, bpy.ops.echinus.check_collisions):
        with pytest.raises(RuntimeError, match="^Error: Sphere is not in the scene: choose another object$"):
            operator()
    choose(sheet, add_sphere())
    delete(sheet)
    for operator in (bpy.ops.echinus.simulate_cloth, bpy.ops.echinus.check_collisions):
        with pytest.raises(RuntimeError, match="^Error: Sheet is not in the scene: choose another object$"):
            operator()


def test_a_cloth_that_is_scaled_to_nothing_is_refused_with_the_frame():
    sheet = add_sheet(scale=(1, 1, 0))
    choose(sheet, add_sphere())
    with pytest.raises(RuntimeError, match="Sheet is scaled to nothing in frame 1: give it a scale other than 0 there"):
        bpy.ops.echinus.simulate_cloth()
    sheet.scale.z = 1
    sheet.keyframe_insert("scale", frame=1)
    sheet.scale = (0, 0, 0)
    sheet.keyframe_insert("scale", frame=9)
    with pytest.raises(RuntimeError, match="^Error: Sheet is scaled to nothing in frame 9"):
        bpy.ops.echinus.simulate_cloth()


def test_a_linked_cloth_is_refused_and_its_override_is_simulated(saved_file):
    add_sheet().modifiers.new("Finer", "SUBSURF")
    bpy.ops.wm.save_as_mainfile(filepath=str(saved_file / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.frame_end = 5
    with bpy.data.libraries.load(str(saved_file / "library.blend"), link=True) as (_, taken):
        taken.objects = ["Sheet"]
    (linked,) = taken.objects
    scene.collection.objects.link(linked)
    choose(linked, add_sphere())
    with pytest.raises(RuntimeError, match="Sheet is linked from another file: .* library override"):
        bpy.ops.echinus.simulate_cloth()
    sheet = linked.override_create()
    scene.collection.objects.link(sheet)
    scene.collection.objects.unlink(linked)
    scene.echinus.cloth = sheet
    simulate()
    assert [m.name for m in sheet.modifiers] == ["Echinus", "Finer"]
    bpy.ops.wm.read_homefile(use_empty=True)


def test_the_mode_is_what_it_was():
    sheet = add_sheet()
    choose(sheet, add_sphere())
    activate(sheet)
    for mode in ("EDIT", "WEIGHT_PAINT", "SCULPT"):
        bpy.ops.object.mode_set(mode=mode)
        simulate()
        assert sheet.mode == mode
    bpy.context.scene.echinus.pin_group = "Needles"
    with pytest.raises(RuntimeError):
        bpy.ops.echinus.simulate_cloth()
    assert sheet.mode == "SCULPT"
