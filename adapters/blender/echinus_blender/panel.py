"""The panels in the sidebar of the 3D view."""

import textwrap

import bpy

from . import library
from .bake_map import BakeMap
from .check_collisions import CheckCollisions
from .check_mesh import CheckMesh
from .simulate_cloth import SimulateCloth


class InSidebar:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Echinus"


class ClothPanel(InSidebar, bpy.types.Panel):
    bl_idname = "ECHINUS_PT_cloth"
    bl_label = "Cloth"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        problem = library.problem()
        if problem:
            draw_sentence(layout, problem, "ERROR", context)
            layout.operator("preferences.addon_show", text="Preferences").module = __package__
        settings = context.scene.echinus
        layout.prop(settings, "cloth")
        layout.prop(settings, "body")
        layout.prop(settings, "more_bodies")
        layout.operator(SimulateCloth.bl_idname, icon="PLAY")
        layout.operator(CheckCollisions.bl_idname)
        if settings.result:
            draw_sentence(layout, settings.result, "INFO", context)


class SimulationPanel(InSidebar, bpy.types.Panel):
    bl_idname = "ECHINUS_PT_simulation"
    bl_label = "Settings"
    bl_parent_id = "ECHINUS_PT_cloth"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        settings = context.scene.echinus
        for name in ("steps_per_second", "thickness", "friction", "air_drag", "bending_stiffness", "self_collision", "untangle"):
            layout.prop(settings, name)
        if settings.cloth:
            layout.prop_search(settings, "pin_group", settings.cloth, "vertex_groups")
            layout.prop(settings, "pins_follow_body")
        layout.prop(settings, "cache_path")


class MeshPanel(InSidebar, bpy.types.Panel):
    bl_idname = "ECHINUS_PT_mesh"
    bl_label = "Active Mesh"

    def draw(self, context):
        self.layout.operator(CheckMesh.bl_idname)
        self.layout.operator(BakeMap.bl_idname)


def draw_sentence(layout, sentence, icon, context):
    """Breaks a text into lines as wide as the sidebar, since a label that is too long is cut off."""
    column = layout.column(align=True)
    for line in textwrap.wrap(sentence, max(20, context.region.width // 8)):
        column.label(text=line, icon=icon)
        icon = "BLANK1"
