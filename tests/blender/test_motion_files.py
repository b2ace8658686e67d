"""The files of motions: which one a run writes, and which stay."""

import os
import pathlib
import subprocess

import bpy
import pytest

from objects import activate, add_sheet, add_sphere, choose, result, shown


@pytest.fixture
def folder(tmp_path):
    """Of a saved blend file, scene.blend."""
    save(tmp_path / "scene.blend")
    return tmp_path


def save(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def simulate(gravity=-9.81):
    bpy.context.scene.gravity.z = gravity
    assert bpy.ops.echinus.simulate_cloth() == {"FINISHED"}


def set_up():
    sheet = add_sheet()
    choose(sheet, add_sphere())
    return sheet


def height(name="Sheet"):
    """The mean one in the last frame."""
    return shown(bpy.data.objects[name], bpy.context.scene.frame_end).vertices[:, 2].mean()


def motion_file(name="Sheet"):
    modifier = bpy.data.objects[name].modifiers["Echinus"]
    return pathlib.Path(bpy.path.abspath(modifier.filepath))


def test_undo_brings_the_earlier_motion_back_and_redo_the_later(folder):
    activate(set_up())
    bpy.ops.ed.undo_push(message="before")
    heights = []
    for gravity in (-9.81, 5):
        simulate(gravity)
        bpy.ops.ed.undo_push(message="simulated")
        heights.append(height())
    assert heights[0] < heights[1] - 0.5
    bpy.ops.ed.undo()
    assert height() == pytest.approx(heights[0], abs=1e-6)
    bpy.ops.ed.redo()
    assert height() == pytest.approx(heights[1], abs=1e-6)


def test_a_file_saved_under_another_name_has_motions_of_its_own(folder):
    set_up()
    simulate()
    fallen = height()
    save(folder / "scene.blend")
    save(folder / "other.blend")
    simulate(gravity=5)
    assert motion_file() == folder / "echinus_cache" / "other" / "Sheet.pc2"
    save(folder / "other.blend")
    bpy.ops.wm.open_mainfile(filepath=str(folder / "scene.blend"))
    assert height() == pytest.approx(fallen, abs=1e-6)


def test_a_file_saved_under_another_name_keeps_its_motion_when_the_first_is_simulated_again(folder):
    set_up()
    simulate()
    fallen = height()
    for name in ("scene.blend", "other.blend"):
        save(folder / name)
    bpy.ops.wm.open_mainfile(filepath=str(folder / "scene.blend"))
    simulate(gravity=5)
    save(folder / "scene.blend")
    bpy.ops.wm.open_mainfile(filepath=str(folder / "other.blend"))
    assert height() == pytest.approx(fallen, abs=1e-6)


def test_names_that_differ_only_in_what_no_file_name_has_share_no_motion(folder):
    set_up().name = "Skirt 1"
    simulate()
    fallen = height("Skirt 1")
    other = add_sheet(count=9)
    other.name = "Skirt:1"
    bpy.context.scene.echinus.cloth = other
    simulate(gravity=5)
    assert motion_file("Skirt 1").name == "Skirt_1.pc2" and motion_file("Skirt:1").name == "Skirt_1_2.pc2"
    assert height("Skirt 1") == pytest.approx(fallen, abs=1e-6)


def test_what_no_saved_file_plays_is_removed_when_another_file_is_opened(folder):
    set_up()
    simulate()
    first = motion_file()
    simulate()
    saved = motion_file()
    save(folder / "scene.blend")
    simulate()
    last = motion_file()
    assert len({first, saved, last}) == 3 and all(file.exists() for file in (first, saved, last))
    bpy.ops.wm.open_mainfile(filepath=str(folder / "scene.blend"))
    assert [file.exists() for file in (first, saved, last)] == [False, True, False]
    assert motion_file() == saved


def test_what_neither_a_saved_file_nor_the_scene_plays_is_removed_when_blender_closes(tmp_path):
    files = [tmp_path / "unsaved.pc2", tmp_path / "saved.pc2", tmp_path / "last.pc2"]
    script = f"""
import bpy, pathlib
from echinus_blender import motion_files
for file in {[str(file) for file in files]}:
    pathlib.Path(file).touch()
    motion_files.remember(pathlib.Path(file))
cube = bpy.data.objects["Cube"]
cache = cube.modifiers.new("Echinus", "MESH_CACHE")
cache.filepath = {str(files[1])!r}
bpy.ops.wm.save_as_mainfile(filepath={str(tmp_path / "scene.blend")!r})
cache.filepath = {str(files[2])!r}
"""
    options = ["--background", "--factory-startup", "--addons", "echinus_blender", "--python-exit-code", "1"]
    subprocess.run([bpy.app.binary_path, *options, "--python-expr", script], check=True, timeout=100)
    assert [file.exists() for file in files] == [False, True, True]


def test_the_motion_of_a_file_that_is_saved_only_afterwards_lasts(tmp_path):
    set_up()
    simulate()
    assert "save the blend file to keep the motion" in result()
    fallen = height()
    save(tmp_path / "scene.blend")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert height() == pytest.approx(fallen, abs=1e-6)
    motion_file().unlink()


def test_the_motion_of_a_file_that_is_never_saved_goes_with_it():
    set_up()
    simulate()
    file = motion_file()
    assert file.exists()
    bpy.ops.wm.read_homefile(use_empty=True)
    assert not file.exists()


def test_a_file_that_the_user_names_is_replaced_and_never_removed(tmp_path):
    set_up()
    bpy.context.scene.echinus.cache_path = str(tmp_path / "mine" / "motion.pc2")
    for _ in range(2):
        simulate()
    assert motion_file() == tmp_path / "mine" / "motion.pc2"
    assert os.listdir(tmp_path / "mine") == ["motion.pc2"]
    assert "save the blend file" not in result()
    bpy.ops.wm.read_homefile(use_empty=True)
    assert (tmp_path / "mine" / "motion.pc2").exists()


def test_a_file_that_another_cloth_plays_is_refused(folder):
    set_up()
    bpy.context.scene.echinus.cache_path = "//motion.pc2"
    simulate()
    other = add_sheet(height=3)
    bpy.context.scene.echinus.cloth = other
    with pytest.raises(RuntimeError, match=f"motion.pc2 has the motion of Sheet: name another cache for {other.name}"):
        bpy.ops.echinus.simulate_cloth()


@pytest.mark.parametrize("text", ["//motion.pc2", "motion.pc2"])
def test_a_path_that_begins_nowhere_is_refused(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    set_up()
    bpy.context.scene.echinus.cache_path = text
    with pytest.raises(RuntimeError, match=f'The cache "{text}" has no folder: .*name a whole path'):
        bpy.ops.echinus.simulate_cloth()
    assert not os.listdir(tmp_path)


def test_only_files_are_replaced(tmp_path):
    set_up()
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("pipe")
    for place in (tmp_path, tmp_path / "link", tmp_path / "pipe"):
        bpy.context.scene.echinus.cache_path = str(place)
        with pytest.raises(RuntimeError, match=f"{place} is not a file that may be replaced"):
            bpy.ops.echinus.simulate_cloth()
    assert set(os.listdir(tmp_path)) == {"link", "pipe"}


def test_a_file_in_the_way_of_the_folder_is_named_before_the_run(folder):
    (folder / "echinus_cache").touch()
    set_up()
    with pytest.raises(RuntimeError, match="echinus_cache is not a folder: remove it"):
        bpy.ops.echinus.simulate_cloth()


def test_nothing_unfinished_is_left_where_a_file_cannot_be_written(tmp_path):
    from echinus_blender.point_cache import write_point_cache

    with pytest.raises(OSError):
        write_point_cache(tmp_path, [[(0, 0, 0)]])
    assert not os.path.exists(f"{tmp_path}.unfinished")
