"""Blender's add-on of Echinus (docs/blender.md). Blender reads ``bl_info`` without running this file."""

bl_info = {
    "name": "Echinus",
    "author": "The Echinus authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Echinus",
    "description": "Cloth that no face of a body ever cuts; faults of meshes; exact maps",
    "doc_url": "",
    "category": "Physics",
}


class Refusal(Exception):
    """The add-on cannot do the work; the text is one sentence for the user."""


# Imported late, so that the files that need no Blender can be imported without it.
def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()
