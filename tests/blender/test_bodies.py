"""Bodies of a collection: which are met, and which are said to be left out."""

import bpy
import pytest

from objects import add_sheet, add_sphere, choose, result


def link_to(collection, thing):
    collection.objects.link(thing)
    bpy.context.scene.collection.objects.unlink(thing)
    return thing


@pytest.fixture
def more():
    """The collection that is chosen as More Bodies, beside a sphere and a cloth."""
    choose(add_sheet(), add_sphere())
    collection = bpy.data.collections.new("More")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.echinus.more_bodies = collection
    return collection


def ends_of_results():
    for operator in (bpy.ops.echinus.simulate_cloth, bpy.ops.echinus.check_collisions):
        assert operator() == {"FINISHED"}
        yield result().partition("; without ")[2]


def test_a_hidden_member_is_left_out_and_said_to_be(more):
    link_to(more, add_sphere(location=(3, 0, 0))).hide_set(True)
    assert set(ends_of_results()) == {"Sphere.001 (hidden in frame 1)"}


def test_members_excluded_from_the_view_layer_are_left_out_and_said_to_be(more):
    link_to(more, add_sphere(location=(3, 0, 0)))
    bpy.context.view_layer.layer_collection.children["More"].exclude = True
    assert set(ends_of_results()) == {"Sphere.001 (excluded from the view layer)"}


def test_members_with_surfaces_that_are_no_meshes_are_said_to_be_left_out(more):
    bpy.ops.object.text_add()
    link_to(more, bpy.context.object)
    instance = bpy.data.objects.new("Copy", None)
    instance.instance_type = "COLLECTION"
    more.objects.link(instance)
    bpy.ops.object.armature_add()
    link_to(more, bpy.context.object)
    assert set(ends_of_results()) == {"Text (not a mesh), Copy (an instance)"}


def test_without_any_body_what_was_left_out_is_in_the_error(more):
    bpy.context.scene.echinus.body = None
    link_to(more, add_sphere(location=(3, 0, 0))).hide_set(True)
    with pytest.raises(RuntimeError, match=r"as the body; without Sphere.001 \(hidden in frame 1\)$"):
        bpy.ops.echinus.simulate_cloth()


def test_a_body_that_is_excluded_from_the_view_layer_is_named(more):
    scene = bpy.context.scene
    scene.echinus.body, scene.echinus.more_bodies = link_to(more, add_sphere()), None
    bpy.context.view_layer.layer_collection.children["More"].exclude = True
    sentence = "Sphere.001 is excluded from the view layer: include its collection"
    with pytest.raises(RuntimeError, match=f"^Error: {sentence}$"):
        bpy.ops.echinus.check_collisions()
