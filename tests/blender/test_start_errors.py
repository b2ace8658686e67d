"""The library's sentences about starts, in the words of the panel."""

import pytest

import echinus as ech
from echinus_blender.run import in_words_of_the_panel


def sentence_of(mesh, *bodies, **options):
    colliders = [ech.Collider(ech.ExactMap(body), name="Ball") for body in bodies]
    with pytest.raises(ech.Error) as raised:
        ech.Simulation(ech.make_cloth_of_mesh(mesh, pins=options.pop("pins", [])), colliders, **options)
    return in_words_of_the_panel(str(raised.value), "Skirt")


BALL = ech.make_sphere(1, 32, 16)


def sheet(size, height):
    mesh = ech.make_cloth(column_count=9, row_count=9, width=size, height=size).mesh
    return ech.Mesh(mesh.vertices + [0, 0, height], mesh.faces)


def test_a_start_that_cuts_a_body():
    sentence = sentence_of(sheet(3, 0.5), BALL)
    assert sentence.startswith("Skirt begins intersecting Ball in ") and " pairs of faces: Check Collisions" in sentence
    assert sentence.endswith('in the first frame shows where; tick "Part the Start" or move them apart')


def test_a_start_inside_a_body():
    sentence = sentence_of(sheet(0.2, 0), BALL)
    assert sentence.startswith("81 vertices of Skirt begin inside Ball: Check Collisions in the first frame shows")


def test_a_pinned_start_inside_a_body():
    sentence = sentence_of(sheet(0.2, 0), BALL, pins=[0])
    assert sentence == (
        "81 vertices of Skirt begin inside Ball, 1 of them pinned there:"
        " Check Collisions in the first frame shows where; move them apart"
    )


def test_a_start_that_cuts_itself():
    flat = sheet(1, 5)
    upright = flat.vertices[:, [0, 2, 1]] + [0, -5.03, 5.02]
    crossing = ech.Mesh([*flat.vertices, *upright], [*flat.faces, *(flat.faces + len(upright))])
    sentence = sentence_of(crossing, BALL, self_collision=True)
    assert sentence.startswith("Skirt begins intersecting itself in ")
    assert sentence.endswith(
        ': Check Mesh shows where; tick "Part the Start" or move them apart or switch "Self Collision" off'
    )


def test_other_sentences_stay():
    assert in_words_of_the_panel("the thickness is too large", "Skirt") == "Skirt: the thickness is too large"
