"""Where the Python module is, if Blender's Python does not find it by itself."""

import bpy


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    module_folder: bpy.props.StringProperty(
        name="Folder of the Module",
        description="The folder that has the Python module echinus, such as the site-packages of a virtual"
        " environment. Empty: Blender's Python finds it",
        subtype="DIR_PATH",
    )

    def draw(self, context):
        from . import library

        self.layout.prop(self, "module_folder")
        problem = library.problem()
        self.layout.label(text=problem or f"Echinus {library.load().__version__}", icon="ERROR" if problem else "INFO")
