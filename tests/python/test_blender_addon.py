"""The parts of Blender's add-on that need no Blender; tests/blender/ has the rest."""

import dataclasses
import re
import sys

import numpy as np
import pytest
from hypothesis import given, strategies
from hypothesis.extra import numpy as arrays

import echinus as ech
from support import ROOT, torus

sys.path.append(str(ROOT / "adapters" / "blender"))

import echinus_blender  # noqa: E402
from echinus_blender import Refusal  # noqa: E402
from echinus_blender.faults import find_faults  # noqa: E402
from echinus_blender.motions import BodySamples, motion_of, quaternion_of  # noqa: E402
from echinus_blender.point_cache import write_point_cache  # noqa: E402
from echinus_blender.run import Garment, Run, RunOptions, in_words_of_the_panel  # noqa: E402

TRIANGLES = strategies.tuples(strategies.integers(1, 12), strategies.just(3)).flatmap(
    lambda shape: arrays.arrays(np.int64, shape, elements=strategies.integers(0, 5))
)
ON_A_GRID = arrays.arrays(np.float32, (6, 3), elements=strategies.integers(0, 2).map(float))
AXES = strategies.tuples(*[strategies.floats(-1, 1)] * 3).filter(lambda axis: np.linalg.norm(axis) > 0.1)


def matrix(linear=np.eye(3), position=(0, 0, 0)):
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = linear, position
    return whole


def turn(axis, angle_rad):
    """A rotation matrix, by Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * cross @ cross


def samples_of(mesh, matrices, shapes=None):
    samples = BodySamples("body", mesh.faces)
    for i, each in enumerate(matrices):
        samples.add(mesh.vertices if shapes is None else shapes[i], each)
    return samples


def sheet(height=1.3, count=9, size=2):
    cloth = ech.make_cloth(column_count=count, row_count=count, width=size, height=size, position=(0, 0, height))
    return Garment("sheet", cloth.positions, cloth.faces, np.empty((0, 2), int), [])


@given(ON_A_GRID, TRIANGLES)
def test_faults_are_as_many_as_the_library_counts(vertices, faces):
    mesh = ech.weld(ech.Mesh(vertices, faces))  # the library takes vertices at one place for one, the add-on does not
    report, found = ech.inspect(mesh), find_faults(mesh.vertices, mesh.faces)
    assert len(found.border_edges) == report.border_edges.count
    assert len(found.nonmanifold_edges) == report.nonmanifold_edges.count
    assert len(found.misoriented_edges) == report.misoriented_edges.count
    assert len(found.duplicate_faces) == report.duplicate_faces.count
    assert len(found.degenerate_faces) == report.degenerate_faces.count
    assert tuple(found.degenerate_faces[:8]) == report.degenerate_faces.first_faces
    assert (len(found.nonmanifold_edges) == 0 and len(found.parted_vertices) == 0) == report.manifold


def test_a_torus_has_no_faults_and_one_with_a_hole_has_the_edges_around_it():
    faces = torus().faces
    assert not any(len(each) for each in vars(find_faults(torus().vertices, faces)).values())
    torn = find_faults(torus().vertices, faces[1:])
    assert set(map(tuple, torn.border_edges)) == {tuple(sorted(edge)) for edge in zip(faces[0], np.roll(faces[0], -1))}


def test_two_cones_that_share_their_tip_are_parted_there():
    cone = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    faces = np.concatenate([cone, np.where(cone == 0, 0, cone + 3)])
    found = find_faults(np.random.default_rng(1).random((7, 3)), faces)
    assert list(found.parted_vertices) == [0] and len(found.nonmanifold_edges) == 0


@given(AXES, strategies.floats(-3.1, 3.1))
def test_the_quaternion_of_a_rotation_is_that_of_its_axis_and_angle(axis, angle_rad):
    expected = ech.rotation_about(axis, angle_rad)
    assert abs(np.dot(quaternion_of(turn(axis, angle_rad)), expected)) == pytest.approx(1, abs=1e-12)


def test_a_body_that_turns_and_goes_keeps_its_scale_and_gets_poses():
    scale = np.diag([1, 2, 0.5])
    matrices = [matrix(turn((1, 2, 3), 0.3 * i) @ turn((0, 0, 1), 1) @ scale, (i, 0, 7)) for i in range(4)]
    motion = motion_of(samples_of(torus(), matrices))
    assert motion.shapes is None and len(motion.poses) == 4
    for (position, rotation), expected in zip(motion.poses, matrices):
        w, *axis = rotation
        half_angle = np.arctan2(np.linalg.norm(axis), w)
        turned = motion.vertices @ turn(axis, 2 * half_angle).T if half_angle else motion.vertices
        assert np.allclose(turned + position, torus().vertices @ expected[:3, :3].T + expected[:3, 3], atol=1e-6)


def test_a_body_at_rest_has_neither_poses_nor_shapes():
    motion = motion_of(samples_of(torus(), [matrix(position=(5, 0, 0))] * 3))
    assert motion.poses == [] and motion.shapes is None and list(motion.origin) == [5, 0, 0]


@pytest.mark.parametrize("last", [np.diag([2, 2, 2]), np.diag([-1, 1, 1]), np.diag([1, 1, 0])])
def test_a_body_whose_scale_changes_deforms(last):
    motion = motion_of(samples_of(torus(), [matrix(position=(9, 0, 0)), matrix(last, (9, 0, 1))]))
    assert motion.poses == []
    assert np.allclose(motion.shapes[1], torus().vertices @ last + [0, 0, 1], atol=1e-6)


def test_a_flat_body_that_moves_deforms():
    flat = np.diag([1, 1, 0])
    motion = motion_of(samples_of(torus(), [matrix(flat), matrix(flat, (1, 0, 0))]))
    assert motion.shapes is not None and np.allclose(motion.shapes[1] - motion.shapes[0], [1, 0, 0])


def test_a_body_whose_vertices_move_deforms():
    shapes = [torus().vertices, torus().vertices * np.float32(1.1)]
    motion = motion_of(samples_of(torus(), [matrix()] * 2, shapes))
    assert np.array_equal(motion.shapes, shapes)


def test_a_point_cache_is_read_as_it_was_written(tmp_path):
    samples = np.random.default_rng(1).random((3, len(torus().vertices), 3)).astype(np.float32)
    path = tmp_path / "new" / "folder" / "cloth.pc2"
    write_point_cache(path, samples)
    assert np.array_equal(ech.read_vertex_cache(path, torus(), frames_per_second=24).samples, samples)
    assert [each.name for each in path.parent.iterdir()] == ["cloth.pc2"]


def test_a_run_gives_the_frames_of_the_simulation_that_it_describes():
    garment, sphere = sheet(), ech.make_sphere(1, 24, 12)
    body = samples_of(sphere, [matrix(position=(0, 0, 0.25))] * 5)
    run = Run(ech, garment, [body], RunOptions(), frame_count=4, frames_per_second=24)
    while not run.is_done:
        run.step()
    collider = ech.Collider(ech.ExactMap(sphere), position=(0, 0, 0.25))
    mine = ech.Simulation(ech.make_cloth_of_mesh(ech.Mesh(garment.vertices, garment.triangles)), [collider], time_step=1 / 48)
    for frame, positions in enumerate(run.recorded):
        assert np.array_equal(positions, mine.positions), f"frame {frame}"
        mine.step(2)  # of the 60 a second that are asked for, what is a whole number a frame
    assert len(run.recorded) == 5 and run.share_done == 1


@pytest.mark.parametrize("deforms", [False, True])
def test_a_body_that_rises_takes_the_cloth_along(deforms):
    sphere = ech.make_sphere(1, 24, 12)
    scales = 1 + 0.01 * np.arange(7) * deforms
    body = samples_of(sphere, [matrix(np.eye(3) * s, (0, 0, 0.1 * i)) for i, s in enumerate(scales)])
    run = Run(ech, sheet(height=1.1), [body], RunOptions(), frame_count=6, frames_per_second=24)
    while not run.is_done:
        run.step()
    risen = ech.Mesh(sphere.vertices * np.float32(scales[-1]) + np.float32([0, 0, 0.6]), sphere.faces)
    assert len(ech.intersecting_pairs(run.simulation.mesh, risen)) == 0
    assert run.recorded[-1][:, 2].max() > 1.5 > run.recorded[0][:, 2].max()


def test_pins_stay_or_go_with_the_nearest_body():
    sphere = ech.make_sphere(0.2, 16, 8)
    far = samples_of(sphere, [matrix(position=(-5, 0, 0))] * 4)
    rising = samples_of(sphere, [matrix(position=(1, 0, 0.1 * i)) for i in range(4)])
    held = dataclasses.replace(sheet(height=0.5), pins=[0, 8])
    for follows, rise in ((False, 0), (True, 0.3)):
        run = Run(ech, held, [far, rising], RunOptions(pins_follow_body=follows), frame_count=3, frames_per_second=24)
        while not run.is_done:
            run.step()
        assert np.allclose(run.recorded[-1][8] - held.vertices[8], [0, 0, rise], atol=1e-5)


def test_a_cloth_that_begins_inside_is_refused_with_a_hint_and_parted_on_request():
    body = samples_of(ech.make_sphere(1, 24, 12), [matrix()] * 2)
    with pytest.raises(Refusal, match='sheet begins .*"Part the Start"'):
        Run(ech, sheet(height=0.5), [body], RunOptions(), frame_count=1, frames_per_second=24)
    parted = Run(ech, sheet(height=0.5), [body], RunOptions(untangle=True), frame_count=1, frames_per_second=24)
    assert len(ech.intersecting_pairs(parted.simulation.mesh, ech.make_sphere(1, 24, 12))) == 0


def test_the_add_on_has_the_version_of_the_library():
    header = (ROOT / "include" / "echinus" / "version.h").read_text()
    assert ".".join(map(str, echinus_blender.bl_info["version"])) == re.search(r'STRING "(.*)"', header)[1]


# The library's sentences about starts, in the words of the panel.


def start_error(mesh, *bodies, **options):
    colliders = [ech.Collider(ech.ExactMap(body), name="Ball") for body in bodies]
    with pytest.raises(ech.Error) as raised:
        ech.Simulation(ech.make_cloth_of_mesh(mesh, pins=options.pop("pins", [])), colliders, **options)
    return in_words_of_the_panel(str(raised.value), "Skirt")


BALL = ech.make_sphere(1, 32, 16)


def sheet_at(size, height):
    mesh = ech.make_cloth(column_count=9, row_count=9, width=size, height=size).mesh
    return ech.Mesh(mesh.vertices + [0, 0, height], mesh.faces)


def test_a_start_that_cuts_a_body():
    sentence = start_error(sheet_at(3, 0.5), BALL)
    assert sentence.startswith("Skirt begins intersecting Ball in ") and " pairs of faces: Check Collisions" in sentence
    assert sentence.endswith('in the first frame shows where; tick "Part the Start" or move them apart')


def test_a_start_inside_a_body():
    sentence = start_error(sheet_at(0.2, 0), BALL)
    assert sentence.startswith("81 vertices of Skirt begin inside Ball: Check Collisions in the first frame shows")


def test_a_pinned_start_inside_a_body():
    sentence = start_error(sheet_at(0.2, 0), BALL, pins=[0])
    assert sentence == (
        "81 vertices of Skirt begin inside Ball, 1 of them pinned there:"
        " Check Collisions in the first frame shows where; move them apart"
    )


def test_a_start_that_cuts_itself():
    flat = sheet_at(1, 5)
    upright = flat.vertices[:, [0, 2, 1]] + [0, -5.03, 5.02]
    crossing = ech.Mesh([*flat.vertices, *upright], [*flat.faces, *(flat.faces + len(upright))])
    sentence = start_error(crossing, BALL)
    assert sentence.startswith("Skirt begins intersecting itself in ")
    assert sentence.endswith(
        ': Check Mesh shows where; tick "Part the Start" or move them apart or switch "Self Collision" off'
    )


def test_other_sentences_stay():
    assert in_words_of_the_panel("the thickness is too large", "Skirt") == "Skirt: the thickness is too large"
