"""Tries the add-on in a window, by events as of a user: its panels are drawn, a simulation runs and plays, Ctrl-Z takes
it back, another one outlives an undo, and Esc cancels others. Run by scripts/blender.
"""

import os
import pathlib
import sys
import threading
import traceback

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
PANELS = ("ECHINUS_PT_cloth", "ECHINUS_PT_simulation", "ECHINUS_PT_mesh")


def trial():
    """Yields when Blender is to go on for a moment."""
    from objects import activate, add_sheet, add_sphere, choose, result

    user = User()
    bpy.data.batch_remove(bpy.data.objects)
    choose(add_sheet(), add_sphere())
    activate(cloth())
    bpy.context.scene.frame_end = 13
    for panel in PANELS:
        user.run(bpy.ops.wm.call_panel, name=panel)
        yield
        user.press("ESC")
        yield
    bpy.ops.ed.undo_push(message="before")
    yield

    user.run(bpy.ops.echinus.simulate_cloth)
    while is_running():
        yield
    assert "Echinus" in cloth().modifiers, "the simulation ended without its motion"
    assert result().startswith("Sheet: 13 frames in "), result()
    assert bpy.context.scene.frame_current == 1
    yield
    user.press("Z", ctrl=True)
    yield
    assert not cloth().modifiers, "Ctrl-Z left the motion"

    bpy.context.scene.frame_end, bpy.context.scene.echinus.steps_per_second = 40, 5000
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="edited")
    user.run(bpy.ops.echinus.simulate_cloth)
    while not is_computing():
        yield
    assert cloth().mode == "EDIT", "reading the frames left Edit mode"
    user.press("Z", ctrl=True)
    yield
    assert is_running(), "the simulation ended before the undo"
    bpy.context.scene.echinus.cloth = None
    while is_running():
        yield
    assert "Echinus" in cloth().modifiers, "an undo took what was being computed away"
    assert result().startswith("Sheet: 40 frames in "), result()
    cloth().modifiers.clear()
    bpy.context.scene.echinus.steps_per_second = 60
    bpy.context.scene.echinus.cloth = cloth()

    for frame_end, is_ready in ((100_000, is_running), (2000, is_computing)):
        bpy.context.scene.frame_end = frame_end
        mode = cloth().mode
        user.run(bpy.ops.echinus.simulate_cloth)
        yield
        while not is_ready():
            yield
        user.press("ESC")
        yield
        yield
        assert not is_running(), "Esc did not cancel"
        assert not cloth().modifiers and bpy.context.scene.frame_current == 1
        assert cloth().mode == mode, "Esc left another mode"


class User:
    """The acts of a user in the 3D view."""

    def __init__(self):
        self.window = bpy.context.window_manager.windows[0]
        self.view = next(area for area in self.window.screen.areas if area.type == "VIEW_3D")
        self.region = next(region for region in self.view.regions if region.type == "WINDOW")

    def run(self, operator, **properties):
        with bpy.context.temp_override(window=self.window, area=self.view, region=self.region):
            operator("INVOKE_DEFAULT", True, **properties)

    def press(self, key, **modifiers):
        place = {"x": self.view.x + self.view.width // 3, "y": self.view.y + self.view.height // 2}
        self.window.event_simulate(type="MOUSEMOVE", value="NOTHING", **place)
        self.window.event_simulate(type=key, value="PRESS", **place, **modifiers)
        self.window.event_simulate(type=key, value="RELEASE", **place, **modifiers)


def cloth():
    return bpy.data.objects["Sheet"]


def operator_class():
    from echinus_blender.simulate_cloth import SimulateCloth

    return SimulateCloth


def is_running():
    return operator_class().is_running


def is_computing():
    return any(thread.name == "Echinus" for thread in threading.enumerate())


STEPS = trial()


def go_on():
    try:
        next(STEPS)
        return 0.2
    except StopIteration:
        print("window: panels were drawn; a simulation was undone, another outlived an undo; two were cancelled by Esc")
        finish(0)
    except BaseException:
        traceback.print_exc()
        finish(1)


def finish(status):
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # Blender would ask about the file that was not saved


bpy.app.timers.register(go_on, first_interval=1)
