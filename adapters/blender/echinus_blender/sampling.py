"""Cloth and bodies in every frame of a scene, as arrays."""

from dataclasses import dataclass, field

import numpy as np

from . import Refusal
from .bodies import bodies_of
from .meshes import (
    evaluated_mesh,
    in_world,
    matrix_of,
    outwards,
    require_mesh,
    triangles_of,
    vertices_of,
    loose_edges_of,
)
from .modifiers import modifiers_after_motion, motion_modifier_of, without
from .motions import BodySamples
from .playing import Destination, destination_of
from .run import Garment


@dataclass
class Sampled:
    """The input of a run.

    Attributes
    ----------
    skipped
        The omitted objects that were meant to be bodies, with reasons, as texts.
    matrices
        (4, 4) of the cloth in each frame: its motion is stored in its own frame.
    """

    destination: Destination
    garment: Garment
    bodies: list
    skipped: list
    matrices: list = field(default_factory=list)


def sample(context):
    """Goes through the frames of the scene; yields the completed share, 0 to 1, and finally the :class:`Sampled`.

    Afterwards the scene returns to its previous frame. Objects are looked up again in each frame, since the user may undo
    in between.

    Raises
    ------
    Refusal
        The fault of an object, naming the object and the frame.
    """
    scene = context.scene
    first, last = scene.frame_start, scene.frame_end
    if last <= first:
        raise Refusal(f"The scene ends with frame {last}, where it begins: there is nothing to simulate")
    require_mesh(scene.echinus.cloth, "cloth")
    destination = destination_of(scene)
    present = scene.frame_current, scene.frame_subframe
    try:
        scene.frame_set(first)
        bodies, skipped = bodies_of(context)
        samples = [_first_sample(context, body) for body in bodies]
        sampled = Sampled(destination, _garment(context), samples, skipped)
        for frame in range(first, last + 1):
            scene.frame_set(frame)
            _add_frame(context, sampled, frame)
            yield (frame - first + 1) / (last - first + 1), None
    finally:
        scene.frame_set(present[0], subframe=present[1])
    yield 1.0, sampled


def played_modifiers(cloth):
    """The modifiers that the initial cloth omits: its earlier motion, and those that may change the number of vertices."""
    mine = motion_modifier_of(cloth)
    return list(modifiers_after_motion(cloth)) + ([mine] if mine else [])


def _garment(context):
    settings = context.scene.echinus
    cloth = settings.cloth
    with without(played_modifiers(cloth)), evaluated_mesh(context, cloth) as (evaluated, mesh):
        matrix = matrix_of(evaluated)
        triangles, _ = triangles_of(mesh)
        return Garment(
            name=cloth.name,
            vertices=in_world(vertices_of(mesh), matrix),
            triangles=outwards(triangles, matrix),
            threads=loose_edges_of(mesh),
            pins=_members(cloth, settings.pin_group),
        )


def _members(thing, group_name):
    """The vertices with a weight of at least 0.5 in a group."""
    if not group_name:
        return []
    group = thing.vertex_groups.get(group_name)
    if group is None:
        raise Refusal(f'{thing.name} has no vertex group "{group_name}"')
    weights = ((v.index, g) for v in thing.data.vertices for g in v.groups)
    return [vertex for vertex, g in weights if g.group == group.index and g.weight >= 0.5]


def _first_sample(context, body):
    with evaluated_mesh(context, body) as (evaluated, mesh):
        triangles, _ = triangles_of(mesh)
        if len(triangles) == 0:
            raise Refusal(f"{body.name} has no faces once its modifiers have worked")
        return BodySamples(body.name, outwards(triangles, matrix_of(evaluated)))


def _add_frame(context, sampled, frame):
    scene = context.scene
    depsgraph = context.evaluated_depsgraph_get()
    cloth = _existing(scene, sampled.garment.name)
    matrix = matrix_of(cloth.evaluated_get(depsgraph))
    if not np.isfinite(matrix).all() or np.linalg.matrix_rank(matrix[:3, :3]) < 3:
        raise Refusal(f"{cloth.name} is scaled to nothing in frame {frame}: give it a scale other than 0 there")
    sampled.matrices.append(matrix)
    for body in sampled.bodies:
        with evaluated_mesh(context, _existing(scene, body.name)) as (evaluated, mesh):
            shape = vertices_of(mesh)
            if body.shapes and len(shape) != len(body.shapes[0]):
                raise Refusal(
                    f"{body.name} has {len(shape)} vertices in frame {frame} and {len(body.shapes[0])} before:"
                    " its modifiers must keep their number"
                )
            matrix = matrix_of(evaluated)
            if not (np.isfinite(shape).all() and np.isfinite(matrix).all()):
                raise Refusal(f"{body.name} has a vertex that is nowhere (not a number) in frame {frame}")
            body.add(shape, matrix)


def _existing(scene, name):
    if name not in scene.objects:
        raise Refusal(f"{name} is no longer in the scene")
    return scene.objects[name]
