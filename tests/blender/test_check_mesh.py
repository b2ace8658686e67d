"""Check Mesh, in Blender."""

import bmesh
import bpy
import numpy as np
import pytest

import echinus as ech
from objects import activate, add, add_sheet, add_sphere, result


def selected(kind):
    """Edges by their vertices, or faces by their numbers."""
    shape = bmesh.from_edit_mesh(bpy.context.object.data)
    if kind == "faces":
        return [face.index for face in shape.faces if face.select]
    return [tuple(sorted(v.index for v in edge.verts)) for edge in shape.edges if edge.select]


def check(thing, **options):
    activate(thing)
    assert bpy.ops.echinus.check_mesh(**options) == {"FINISHED"}
    assert bpy.context.object.mode == "EDIT"


def test_a_closed_mesh_has_no_faults_and_nothing_is_selected():
    check(add_sphere())
    assert result() == "Sphere: no faults"
    assert not selected("edges") and not selected("faces")


def test_the_open_edges_of_a_hole_are_selected():
    sphere = ech.make_sphere(1, 32, 16)
    torn = ech.Mesh(sphere.vertices, sphere.faces[1:])
    check(add("Torn", torn))
    assert result() == f"Torn: {ech.inspect(torn).border_edges.count} open edges; selected"
    assert set(selected("edges")) == {tuple(sorted(e)) for e in zip(sphere.faces[0].tolist(), np.roll(sphere.faces[0], -1).tolist())}


def test_edges_with_three_faces_are_selected():
    fins = ech.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    check(add("Fins", fins), kinds={"NONMANIFOLD"})
    assert result() == "Fins: 1 edges with more than two faces; selected"
    assert selected("edges") == [(0, 1)]


def test_faces_that_intersect_are_selected():
    """Two quadrilaterals that cross: each counts once, though it is drawn as two triangles."""
    data = bpy.data.meshes.new("Cross")
    flat = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    upright = [(-0.5, 0, -0.5), (0.5, 0, -0.5), (0.5, 0, 0.5), (-0.5, 0, 0.5)]
    data.from_pydata(flat + upright + [(5, 5, 5), (6, 5, 5), (5, 6, 5)], [], [(0, 1, 2, 3), (4, 5, 6, 7), (8, 9, 10)])
    cross = bpy.data.objects.new("Cross", data)
    bpy.context.scene.collection.objects.link(cross)
    check(cross, kinds={"INTERSECTING"})
    assert result() == "Cross: 2 intersecting faces; selected"
    assert selected("faces") == [0, 1]


def test_only_the_kinds_that_are_asked_for_are_looked_at():
    check(add_sheet(), kinds={"NONMANIFOLD", "DUPLICATE"})
    assert result() == "Sheet: no faults"


def test_faults_are_found_from_edit_mode_as_it_is_there():
    sphere = add_sphere()
    activate(sphere)
    bpy.ops.object.mode_set(mode="EDIT")
    shape = bmesh.from_edit_mesh(sphere.data)
    shape.faces.ensure_lookup_table()
    bmesh.ops.delete(shape, geom=[shape.faces[0]], context="FACES_ONLY")
    bmesh.update_edit_mesh(sphere.data)
    check(sphere)
    assert result() == "Sphere: 3 open edges; selected"


def test_a_mesh_without_faces_and_what_is_no_mesh_are_refused():
    activate(add("Empty", ech.Mesh(np.empty((0, 3)), np.empty((0, 3), int))))
    with pytest.raises(RuntimeError, match="Empty has no faces"):
        bpy.ops.echinus.check_mesh()
    bpy.ops.object.camera_add()
    with pytest.raises(RuntimeError, match="Camera is not a mesh"):
        bpy.ops.echinus.check_mesh()


def test_a_vertex_that_is_nowhere_is_refused():
    sphere = add_sphere()
    sphere.data.vertices[0].co = (float("nan"), 0, 0)
    activate(sphere)
    with pytest.raises(RuntimeError, match="not finite|finite"):
        bpy.ops.echinus.check_mesh()


def test_undo_brings_mode_and_selection_back():
    sheet = add_sheet()
    activate(sheet)
    sheet.data.vertices.foreach_set("select", [i == 100 for i in range(225)])
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.echinus.check_mesh("EXEC_DEFAULT", True)
    assert bpy.context.object.mode == "EDIT" and len(selected("edges")) == 56
    bpy.ops.ed.undo()
    assert bpy.context.object.mode == "OBJECT"
    assert [v.index for v in bpy.context.object.data.vertices if v.select] == [100]


def test_hidden_faults_are_shown_and_selected():
    sheet = add_sheet(count=4)
    for elements in (sheet.data.vertices, sheet.data.edges, sheet.data.polygons):
        elements.foreach_set("hide", [True] * len(elements))
    check(sheet)
    assert result() == "Sheet: 12 open edges; selected"
    assert len(selected("edges")) == 12


def test_no_kind_of_fault_is_refused():
    activate(add_sheet())
    with pytest.raises(RuntimeError, match="^Error: Choose at least one kind of fault to look for$"):
        bpy.ops.echinus.check_mesh(kinds=set())


def test_a_linked_mesh_is_refused(tmp_path):
    add_sheet()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, taken):
        taken.objects = ["Sheet"]
    (linked,) = taken.objects
    override = linked.override_create()
    for thing in (linked, override):
        bpy.context.scene.collection.objects.link(thing)
        bpy.context.view_layer.objects.active = thing
        with pytest.raises(RuntimeError, match="^Error: Sheet is linked from another file, .*: check it there$"):
            bpy.ops.echinus.check_mesh()


def test_a_refusal_leaves_the_mode():
    activate(add_sheet())
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError):
        bpy.ops.echinus.check_mesh(kinds=set())
    assert bpy.context.object.mode == "EDIT"
