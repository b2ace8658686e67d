"""Registers classes and settings with Blender, and the folder of the Python module, for use if Blender does not find the
module by itself."""

import bpy

from . import library, motion_files
from .bake_map import BakeMap
from .check_collisions import CheckCollisions
from .check_mesh import CheckMesh
from .panel import ClothPanel, MeshPanel, SimulationPanel
from .settings import Settings
from .simulate_cloth import SimulateCloth


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    module_folder: bpy.props.StringProperty(
        name="Folder of the Module",
        description="The folder that contains the Python module echinus, such as the site-packages of a virtual"
        " environment. Empty: Blender's Python finds it",
        subtype="DIR_PATH",
    )

    def draw(self, context):
        self.layout.prop(self, "module_folder")
        problem = library.problem()
        self.layout.label(text=problem or f"Echinus {library.load().__version__}", icon="ERROR" if problem else "INFO")


CLASSES = [
    Preferences,
    Settings,
    CheckMesh,
    CheckCollisions,
    SimulateCloth,
    BakeMap,
    ClothPanel,
    SimulationPanel,
    MeshPanel,
]


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.echinus = bpy.props.PointerProperty(type=Settings)
    motion_files.register()


def unregister():
    motion_files.unregister()
    del bpy.types.Scene.echinus
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
