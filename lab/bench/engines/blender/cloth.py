"""Blender's own cloth, or with --echinus the add-on's, as a runner of scripts/bench engines (lab/bench/engines/runners.py).

  blender --background --factory-startup --python-exit-code 1 --python lab/bench/engines/blender/cloth.py -- OPTIONS...
  scripts/blender --run lab/bench/engines/blender/cloth.py OPTIONS... --echinus
"""

import argparse
import json
import pathlib
import sys
import time

import bpy
import numpy as np

FRAMES_PER_SECOND = 60
FIRST = 1
#: What falls freely in Blender's cloth falls as far in a frame as in this time, whatever the scene's frame rate.
SECONDS_OF_A_FRAME = 1000**-0.5


def parse(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", type=pathlib.Path, required=True)
    parser.add_argument("--cloth", type=pathlib.Path, required=True)
    parser.add_argument("--setup", choices=["recommended", "matched"], required=True)
    parser.add_argument("--frames", type=int, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--echinus", action="store_true")
    return parser.parse_args(arguments)


def read_obj(path):
    """Vertices and polygons."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = [tuple(map(float, line[1:4])) for line in lines if line[:1] == ["v"]]
    polygons = [tuple(int(corner.split("/")[0]) - 1 for corner in line[1:]) for line in lines if line[:1] == ["f"]]
    return vertices, polygons


def add(name, path):
    data = bpy.data.meshes.new(name)
    vertices, polygons = read_obj(path)
    data.from_pydata(vertices, [], polygons)
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def set_up_scene(frame_count):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = FRAMES_PER_SECOND, 1
    scene.frame_start, scene.frame_end = FIRST, FIRST + frame_count
    scene.gravity = (0, -9.81, 0)


def make_blenders_cloth(cloth, model, setup):
    """Physics as the properties editor adds them; what differs from its defaults is returned in words."""
    model.modifiers.new("Collision", "COLLISION")
    modifier = cloth.modifiers.new("Cloth", "CLOTH")
    settings, collisions = modifier.settings, modifier.collision_settings
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = FIRST, bpy.context.scene.frame_end
    settings.time_scale = 1 / (FRAMES_PER_SECOND * SECONDS_OF_A_FRAME)
    collisions.use_self_collision = True
    if setup == "matched":
        settings.quality = 1
        collisions.collision_quality = 10
        collisions.distance_min, model.collision.thickness_outer = 0.009, 0.001  # which are added
        collisions.self_distance_min = 0.01
    return {
        "steps a frame": settings.quality,
        "collision quality": collisions.collision_quality,
        "distance": f"{collisions.distance_min:.3g} + {model.collision.thickness_outer:.3g} of the model",
        "self-collision": f"distance {collisions.self_distance_min:.3g}",
        "stiffness": f"tension {settings.tension_stiffness:g}, compression {settings.compression_stiffness:g},"
        f" shear {settings.shear_stiffness:g}, bending {settings.bending_stiffness:g}",
        "mass of a vertex": f"{settings.mass:g}",
        "friction": f"{collisions.friction:g}, of the model {model.collision.cloth_friction:g}",
        "time scale": f"{settings.time_scale:g}: a frame is 1/{FRAMES_PER_SECOND} s",
    }


def positions_of(cloth):
    """As the view shows them."""
    evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", positions.ravel())
    evaluated.to_mesh_clear()
    return positions


def play(cloth):
    """The positions in all frames, and the processor seconds that Blender took to show each after the first."""
    scene = bpy.context.scene
    scene.frame_set(FIRST)
    samples, seconds = [positions_of(cloth)], []
    for frame in range(FIRST + 1, scene.frame_end + 1):
        began = time.process_time()
        scene.frame_set(frame)
        seconds.append(time.process_time() - began)
        samples.append(positions_of(cloth))
    return np.array(samples), seconds


def simulate_with_echinus(cloth, model, out):
    """The operator of the add-on, sampling and writing included; its time is spread evenly over the frames."""
    scene = bpy.context.scene
    scene.echinus.cloth, scene.echinus.body = cloth, model
    scene.echinus.cache_path = str(out.resolve() / "cloth.pc2")
    began = time.process_time()
    bpy.ops.echinus.simulate_cloth()
    seconds = time.process_time() - began
    frame_count = scene.frame_end - FIRST
    return play(cloth)[0], [seconds / frame_count] * frame_count


def write(out, samples, run):
    header = np.array([(b"POINTCACHE2\0", 1, samples.shape[1], 0, 1, len(samples))], "S12,<i4,<i4,<f4,<f4,<i4")
    (out / "cloth.pc2").write_bytes(header.tobytes() + samples.astype("<f4").tobytes())
    (out / "run.json").write_text(json.dumps(run, indent=1) + "\n")


def main():
    arguments = parse(sys.argv[sys.argv.index("--") + 1 :])
    set_up_scene(arguments.frames)
    model, cloth = add("Model", arguments.model), add("Cloth", arguments.cloth)
    if arguments.echinus:
        settings, steps = {"settings": "the add-on's defaults: 240 steps a second"}, 4
        samples, seconds = simulate_with_echinus(cloth, model, arguments.out)
    else:
        settings = make_blenders_cloth(cloth, model, arguments.setup)
        steps = cloth.modifiers["Cloth"].settings.quality
        samples, seconds = play(cloth)
    write(
        arguments.out,
        samples,
        {
            "engine": "Blender",
            "version": bpy.app.version_string,
            "configuration": "Simulate Cloth of the add-on" if arguments.echinus else arguments.setup,
            "platform": "native",
            "substeps": steps,
            "settings": settings,
            "frame_seconds": seconds,
        },
    )


if __name__ == "__main__":
    main()
