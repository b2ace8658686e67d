"""Objects for tests, and what Blender shows of them."""

import bpy
import numpy as np

import echinus as ech


def add(name, mesh, **place):
    """An object with the vertices and faces, linked to the scene; ``place`` are attributes, as ``location``."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(np.asarray(mesh.vertices).tolist(), [], np.asarray(mesh.faces).tolist())
    thing = bpy.data.objects.new(name, data)
    for key, value in place.items():
        setattr(thing, key, value)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.update()
    return thing


def add_sheet(height=1.3, count=15, size=2.4, **place):
    cloth = ech.make_cloth(column_count=count, row_count=count, width=size, height=size)
    return add("Sheet", cloth.mesh, location=(0, 0, height), **place)


def add_sphere(**place):
    return add("Sphere", ech.make_sphere(1, 32, 16), **place)


def choose(cloth, body):
    bpy.context.scene.echinus.cloth, bpy.context.scene.echinus.body = cloth, body


def activate(thing):
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)


def shown(thing, frame=None):
    """The object as Blender shows it in a frame, in the world."""
    if frame is not None:
        bpy.context.scene.frame_set(frame)
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    vertices = [evaluated.matrix_world @ v.co for v in mesh.vertices]
    result = ech.Mesh(np.array(vertices), [list(t.vertices) for t in mesh.loop_triangles])
    evaluated.to_mesh_clear()
    return result


def cut_count(cloth, body, frame):
    return len(ech.intersecting_pairs(shown(cloth, frame), shown(body, frame)))


def result():
    return bpy.context.scene.echinus.result
