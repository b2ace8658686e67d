"""A simulation of a cloth and bodies, frame by frame. This file does not need Blender."""

import re
from dataclasses import dataclass

import numpy as np

from . import Refusal
from .motions import motion_of


@dataclass(frozen=True)
class RunOptions:
    """The settings of the panel, in the units of the scene.

    Attributes
    ----------
    thickness
        0 lets the library choose.
    """

    steps_per_second: int = 60
    gravity: tuple = (0, 0, -9.81)
    thickness: float = 0
    friction: float = 0.5
    air_drag: float = 0.5
    bending_stiffness: float = 1e-5
    self_collision: bool = True
    untangle: bool = False
    pins_follow_body: bool = False


@dataclass(frozen=True)
class Garment:
    """The initial cloth, in the world.

    Attributes
    ----------
    threads
        (k, 2) edges that belong to no face.
    pins
        Vertices that are held.
    """

    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    threads: np.ndarray
    pins: list


class Run:
    """The frames of a simulation, computed step by step.

    Parameters
    ----------
    echinus
        The module.
    bodies : list of BodySamples
    frame_count
        Frames to compute after the first.
    frames_per_second
        The frame rate of the scene.

    Raises
    ------
    Refusal, echinus.Error
        The fault, in one sentence.
    """

    def __init__(self, echinus, garment, bodies, options, frame_count, frames_per_second):
        self.frame_count = frame_count
        self.steps_per_frame = max(1, round(options.steps_per_second / frames_per_second))
        motions = [motion_of(body) for body in bodies]
        colliders = [_collider(echinus, body, motion) for body, motion in zip(bodies, motions)]
        holds = garment.pins and options.pins_follow_body
        cloth = echinus.make_cloth_of_mesh(
            echinus.Mesh(garment.vertices, garment.triangles),
            threads=garment.threads,
            pins=[] if holds else garment.pins,
            attachments=_nearest_colliders(garment, colliders) if holds else [],
        )
        try:
            self.simulation = echinus.Simulation(
                cloth,
                colliders,
                time_step=1 / (frames_per_second * self.steps_per_frame),
                gravity=options.gravity,
                thickness=options.thickness or None,
                friction=options.friction,
                air_drag=options.air_drag,
                bending_stiffness=options.bending_stiffness,
                collision="surfaces_and_self" if options.self_collision else "surfaces",
                untangle=options.untangle,
            )
        except echinus.Error as error:
            raise Refusal(in_words_of_the_panel(str(error), garment.name)) from error
        for index, motion in enumerate(motions):
            _set_motion(echinus, self.simulation, index, motion, frames_per_second)
        self.recorded = [self.simulation.positions.copy()]

    @property
    def is_done(self):
        return len(self.recorded) > self.frame_count

    @property
    def share_done(self):
        """0 to 1"""
        return self.simulation.frame / max(1, self.frame_count * self.steps_per_frame)

    def step(self):
        """Computes a part of a frame; records the frame after its last part."""
        self.simulation.step()
        if self.simulation.frame % self.steps_per_frame == 0:
            self.recorded.append(self.simulation.positions.copy())


def _collider(echinus, body, motion):
    exact = echinus.ExactMap(echinus.Mesh(motion.vertices, body.triangles))
    return echinus.Collider(exact, position=motion.origin, name=body.name)


def _set_motion(echinus, simulation, index, motion, frames_per_second):
    if motion.shapes is not None:
        simulation.set_collider_cache(index, echinus.VertexCache(motion.shapes, 1 / frames_per_second))
    elif motion.poses:
        keys = [echinus.PoseKey(i / frames_per_second, *pose) for i, pose in enumerate(motion.poses)]
        simulation.set_collider_keyframes(index, keys)


def _nearest_colliders(garment, colliders):
    """(vertex, collider) for each pin."""
    points = garment.vertices[garment.pins]
    distances = [abs(each.map.signed_distance(points - each.position)) for each in colliders]
    return np.stack([garment.pins, np.argmin(distances, axis=0)], axis=1)


# The errors of the library about an initial state, in the words of the panel.

#: Numbers of triangles and particles, which Blender does not show.
PLACES = re.compile(r"(: (face|particle|the edge) |; the first is particle ).*")


def in_words_of_the_panel(sentence, cloth_name):
    """A sentence that names the cloth and, if its initial state intersects something, the remedy."""
    what, is_start, remedy = sentence.partition("; move the deformable until they are apart")
    if not is_start:
        return f"{cloth_name}: {sentence}"
    what = re.sub(r"( in \d+ pairs?)\b", r"\1 of faces", PLACES.sub("", what))
    what = what.replace("the deformable begins", f"{cloth_name} begins", 1)
    what = what.replace(" particles begin", f" vertices of {cloth_name} begin", 1)
    what = what.replace("untangle could not", '"Part the Start" could not', 1)
    is_itself = "do without self-collision" in remedy
    ways = ['tick "Part the Start"'] if "set untangle" in remedy else []
    ways += ["move them apart"] + (['switch "Self Collision" off'] if is_itself else [])
    finder = "Check Mesh" if is_itself else "Check Collisions in the first frame"
    shown = "" if " begins touching " in what else f"{finder} shows where; "
    return f"{what}: {shown}{' or '.join(ways)}"
