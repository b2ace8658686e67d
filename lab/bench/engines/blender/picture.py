"""Draws a part of one frame of a recording of cloth.py, for docs/blender.md. Faces of the cloth that the model cuts, as
Check Collisions of the add-on finds them, are red.

  scripts/blender --run lab/bench/engines/blender/picture.py --model FILE --cloth FILE --frame N --out FILE DIR
"""

import argparse
import math
import pathlib
import struct
import sys

import bpy
import numpy as np

sys.path.append(str(pathlib.Path(__file__).parent))
from cloth import add  # noqa: E402

TILT_DEG = 60  # of the camera: 0 looks down


def parse(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", type=pathlib.Path, required=True)
    parser.add_argument("--cloth", type=pathlib.Path, required=True)
    parser.add_argument("--frame", type=int, required=True)
    parser.add_argument("--middle", type=float, nargs=3, default=(0.1, 0.85, 0.12), help="what to look at; y is up")
    parser.add_argument("--width", type=float, default=0.8, help="of what is seen")
    parser.add_argument("--turn", type=float, default=0, help="of the camera about the upright axis, degrees")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("recording", type=pathlib.Path)
    return parser.parse_args(arguments)


def positions_in(recording, frame):
    """(3 vertex_count,) of a sample of a PC2 file."""
    content = (recording / "cloth.pc2").read_bytes()
    (count,) = struct.unpack_from("<i", content, 16)
    return np.frombuffer(content, "<f4", 3 * count, 32 + 12 * count * frame)


def paint(thing, *colour):
    material = bpy.data.materials.new(thing.name)
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*colour, 1)
    inputs["Roughness"].default_value = 0.6
    thing.data.materials.append(material)


def add_objects(arguments):
    """y is up in recordings, z in Blender."""
    model, cloth = add("Model", arguments.model), add("Cloth", arguments.cloth)
    cloth.data.vertices.foreach_set("co", positions_in(arguments.recording, arguments.frame))
    for thing in (model, cloth):
        thing.rotation_euler.x = math.pi / 2
    paint(model, 0.75, 0.62, 0.42)
    paint(cloth, 0.10, 0.27, 0.52)
    paint(cloth, 0.9, 0.02, 0.02)
    mark_cut_faces(cloth, model)


def mark_cut_faces(cloth, model):
    """The second colour for faces whose vertices are all in the group."""
    settings = bpy.context.scene.echinus
    settings.cloth, settings.body = cloth, model
    bpy.ops.echinus.check_collisions()
    group = cloth.vertex_groups["Echinus Cut"].index
    cut = {v.index for v in cloth.data.vertices if any(g.group == group for g in v.groups)}
    for face in cloth.data.polygons:
        face.material_index = int(cut.issuperset(face.vertices))


def add_light():
    scene = bpy.context.scene
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 2.5, 0.1
    sun.rotation_euler = (0.6, -0.3, 0.4)
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    inputs = scene.world.node_tree.nodes["Background"].inputs
    inputs["Color"].default_value, inputs["Strength"].default_value = (1, 1, 1, 1), 0.5


def add_camera(middle, width, turn_deg):
    tilt, turn, distance = math.radians(TILT_DEG), math.radians(turn_deg), 6
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", width
    camera.rotation_euler = (tilt, 0, turn)
    x, y, z = middle
    towards = (math.sin(tilt) * math.sin(turn), -math.sin(tilt) * math.cos(turn), math.cos(tilt))
    camera.location = [place + distance * step for place, step in zip((x, -z, y), towards)]
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def render(path, samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.render.resolution_x, scene.render.resolution_y = 440, 360
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.color_mode, scene.render.image_settings.compression = "RGB", 100
    scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)


def main():
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_objects(arguments)
    add_light()
    add_camera(arguments.middle, arguments.width, arguments.turn)
    render(arguments.out, arguments.samples)


main()
