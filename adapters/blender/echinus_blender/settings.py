"""The settings that the panel shows and operators read, stored in each scene."""

import bpy

from .run import RunOptions

DEFAULTS = RunOptions()


def is_mesh(settings, candidate):
    return candidate.type == "MESH"


class Settings(bpy.types.PropertyGroup):
    cloth: bpy.props.PointerProperty(
        name="Cloth", description="The mesh that falls and folds", type=bpy.types.Object, poll=is_mesh
    )
    body: bpy.props.PointerProperty(
        name="Body",
        description="The mesh that the cloth collides with. It may move and deform",
        type=bpy.types.Object,
        poll=is_mesh,
    )
    more_bodies: bpy.props.PointerProperty(
        name="More Bodies", description="A collection, all of whose meshes are further bodies", type=bpy.types.Collection
    )

    steps_per_second: bpy.props.IntProperty(
        name="Steps per Second",
        description="More steps follow fast motion more closely, and take longer",
        default=DEFAULTS.steps_per_second,
        min=24,
        soft_max=1000,
    )
    thickness: bpy.props.FloatProperty(
        name="Thickness",
        description="The distance that the cloth keeps from bodies. 0: chosen according to the size of its faces",
        subtype="DISTANCE",
        default=0,
        min=0,
    )
    friction: bpy.props.FloatProperty(
        name="Friction", description="Coulomb's coefficient", default=DEFAULTS.friction, min=0, soft_max=1
    )
    air_drag: bpy.props.FloatProperty(
        name="Air Drag",
        description="The rate, per second, at which the cloth loses its speed in still air",
        default=DEFAULTS.air_drag,
        min=0,
        soft_max=10,
    )
    bending_stiffness: bpy.props.FloatProperty(
        name="Bending Stiffness",
        description="How stiffly the cloth resists folds, in N m: silk 1e-6, cotton 1e-5, denim 1e-4",
        default=DEFAULTS.bending_stiffness,
        min=0,
        soft_max=1e-3,
        precision=7,
    )
    self_collision: bpy.props.BoolProperty(
        name="Self Collision", description="Faces of the cloth do not meet each other", default=DEFAULTS.self_collision
    )
    untangle: bpy.props.BoolProperty(
        name="Part the Start",
        description="Move a cloth that begins inside a body, or in itself, until nothing intersects",
        default=DEFAULTS.untangle,
    )
    pin_group: bpy.props.StringProperty(
        name="Pin Group", description="Vertices of the cloth with a weight of at least a half are held"
    )
    pins_follow_body: bpy.props.BoolProperty(
        name="Pins Follow Bodies",
        description="Held vertices move with the nearest body. Otherwise they stay where they begin",
        default=False,
    )
    cache_path: bpy.props.StringProperty(
        name="Cache",
        description="The PC2 file to which every run writes the motion; undo does not restore the previous one."
        " Empty: every run writes a new file, in a folder next to the blend file",
        subtype="FILE_PATH",
    )

    result: bpy.props.StringProperty(
        name="Result", description="The result of the last operator", options={"SKIP_SAVE", "HIDDEN"}
    )
