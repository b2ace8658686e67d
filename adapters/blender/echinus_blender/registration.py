"""Which classes Blender knows, and where the settings are kept."""

import bpy

from . import motion_files
from .bake_map import BakeMap
from .check_collisions import CheckCollisions
from .check_mesh import CheckMesh
from .panel import ClothPanel, MeshPanel, SimulationPanel
from .preferences import Preferences
from .settings import Settings
from .simulate_cloth import SimulateCloth

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
