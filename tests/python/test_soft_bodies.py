"""Deformables, colliders and simulations that are put together in Python."""

import json
import pickle

import numpy as np
import pytest

import echinus as ech
from support import run_program, torus

BOX = ech.make_solid_box((0.4, 0.4, 0.4), (3, 3, 3))
FLOOR_MESH = ech.make_box((4, 4, 1))
FLOOR = ech.ExactMap(FLOOR_MESH)
#: Its upper side at z = 0.
BELOW = ech.Collider(FLOOR, position=(0, 0, -0.5))
BALL = ech.make_sphere(0.3, 24, 12)


def soft_box(**options):
    return ech.make_soft_body(BOX, **{"young_modulus": 2e4, "damping": 0.05, "position": (0, 0, 0.25), **options})


def cloth(**options):
    return ech.make_cloth(column_count=12, row_count=12, **options)


def refusal(call, *arguments, **options):
    with pytest.raises(ech.Error) as raised:
        call(*arguments, **options)
    return raised.value.code, str(raised.value)


def test_a_soft_body_weighs_what_its_density_and_volume_say():
    body = soft_box(density=500, scale=2, pins=[0, 1], attachments=[[2, 0]])
    assert len(body) == len(body.positions) == 64 and body.tetrahedra.shape == (135, 4)
    assert sorted(map(sorted, body.tetrahedra.tolist())) == sorted(map(sorted, BOX.tetrahedra.tolist()))
    assert np.flatnonzero(body.inverse_masses == 0).tolist() == [0, 1, 2]
    free = soft_box(density=500, scale=2)
    assert (1 / free.inverse_masses.astype(float)).sum() == pytest.approx(500 * 0.8**3)
    assert np.allclose(free.positions, BOX.vertices * 2 + [0, 0, 0.25])
    assert ech.inspect(free.mesh).closed and free.constraint_count == 0
    for array in (free.positions, free.inverse_masses, free.faces, free.tetrahedra):
        assert not array.flags.writeable


def test_parts_follow_one_another_in_one_deformable():
    sheet, body = cloth(position=(0, 0, 2)), soft_box()
    both = ech.combine([sheet, ech.with_masses_times(3, body)])
    assert len(both) == 144 + 64 and both.constraint_count == sheet.constraint_count
    assert np.array_equal(both.faces[len(sheet.faces) :], body.faces + 144)
    assert np.array_equal(both.tetrahedra, body.tetrahedra + 144)
    assert np.allclose(both.inverse_masses[144:] * 3, body.inverse_masses)


def test_a_cloth_is_made_of_a_mesh_as_of_a_scene():
    scene = {"model": {"torus": {}}, "cloth": {"mesh": "s.obj", "position": [0, 0, 2], "scale": 2}}
    expected = ech.Simulation.from_scene(scene, cloth=BALL)
    made = ech.make_cloth_of_mesh(BALL, position=(0, 0, 2), scale=2)
    simulation = ech.Simulation(made, [ech.Collider(ech.ExactMap(ech.make_torus()))])
    assert np.array_equal(simulation.positions, expected.positions)
    simulation.step(5)
    expected.step(5)
    assert simulation.state_hash == expected.state_hash
    needle = ech.Mesh(np.concatenate([BALL.vertices, [[0, 0, 1]]]), BALL.faces)
    threaded = ech.make_cloth_of_mesh(needle, threads=[[0, len(BALL.vertices)]], rest_vertices=needle.vertices)
    assert threaded.constraint_count == ech.make_cloth_of_mesh(BALL).constraint_count + 1


def test_the_defaults_are_those_of_a_scene():
    scene = {"model": {"torus": {}}, "cloth": {"size": [3, 3], "particles": [12, 12], "position": [0, 0, 1]}}
    by_scene = ech.Simulation.from_scene(scene)
    sheet = cloth(width=3, height=3, position=(0, 0, 1))
    made = ech.Simulation(sheet, [ech.Collider(ech.ExactMap(ech.make_torus()))])
    assert made.options == by_scene.options and made.frame_limit == by_scene.frame_limit
    made.step(25)
    by_scene.step(25)
    assert made.state_hash == by_scene.state_hash
    soft = ech.Simulation(soft_box(), [BELOW]).options
    assert (soft.solver, soft.time_step) == ("newton", 1 / 60)
    sampled = ech.Simulation(cloth(), [ech.Collider(ech.DistanceMap(torus()), position=(0, 0, 9))]).options
    assert sampled.collision == "surfaces_and_self"


def test_the_contacts_of_a_body_at_rest_sum_to_its_weight():
    simulation = ech.Simulation(soft_box(position=(0, 0, 0.22)), [BELOW])
    simulation.step()
    assert len(simulation.contact_points().gaps) == 0
    simulation.record_contacts()
    simulation.step(60)
    points = simulation.contact_points()
    assert set(points.colliders) == {0} and points.particles.shape == (len(points.gaps), 4)
    impulses = points.normals * points.normal_impulses[:, np.newaxis] + points.friction_impulses
    forces = impulses.sum(axis=0) / simulation.options.time_step
    assert np.allclose(forces, -np.array(simulation.load_on(0).force), rtol=1e-9, atol=1e-9)
    assert (points.gaps > 0).all() and np.allclose(np.linalg.norm(points.normals, axis=1), 1)


def test_a_free_model_falls_until_it_is_led_again():
    simulation = ech.Simulation(soft_box(position=(0, 0, 9)), [BELOW])
    simulation.set_collider_free(0, 2)
    simulation.step(30)
    fallen = simulation.colliders[0].position[2]
    assert fallen < -1
    simulation.set_collider_velocity(0, (0, 0, 0), (0, 0, 0))
    simulation.step()
    assert simulation.colliders[0].position[2] == fallen
    with pytest.raises(ech.Error, match="mass of -1"):
        simulation.set_collider_free(0, -1)


def test_a_body_bears_on_its_floor_and_is_lifted_by_what_deforms():
    simulation = ech.Simulation(soft_box(position=(0, 0, 0.22)), [BELOW])
    assert simulation.load_on(0) == ech.Load((0, 0, 0), (0, 0, 0))
    simulation.step(15)
    assert simulation.load_on(0).force[2] < 0
    height = simulation.positions[:, 2].mean()
    for rise in (0.01, 0.02, 0.03):
        simulation.set_collider_vertices(0, FLOOR_MESH.vertices + np.float32((0, 0, rise)))
        simulation.step()
    assert simulation.positions[:, 2].mean() > height


def test_a_stretched_collider_is_where_its_scale_says():
    turned = ech.rotation_about((1, 0, 0), np.pi / 2)
    collider = ech.Collider(ech.ExactMap(BALL), position=(0, 0, 1), scale=(1, 1, 2), rotation=turned)
    state = ech.Simulation(cloth(position=(0, 0, 5)), [collider]).colliders[0]
    assert state.scale == (1, 1, 2) and state.position == (0, 0, 1)
    assert state.rotation == pytest.approx((np.sqrt(0.5), np.sqrt(0.5), 0, 0))
    larger = ech.Collider(collider.map, position=(0, 0, 9), scale=np.float32(3))
    assert ech.Simulation(cloth(), [larger]).colliders[0].scale == (3, 3, 3)


def test_a_collider_goes_where_it_is_led():
    simulation = ech.Simulation(cloth(position=(0, 0, 5)), [BELOW], gravity=(0, 0, 0))
    turned = ech.rotation_about((0, 0, 1), 0.5)
    simulation.set_collider_pose(0, (0.1, 0, -0.5), turned)
    simulation.step()
    assert simulation.colliders[0].position == pytest.approx((0.1, 0, -0.5))
    assert simulation.colliders[0].rotation == pytest.approx(turned)
    keys = [ech.PoseKey(0, (0.1, 0, -0.5)), ech.PoseKey(1, (0.1, 0, 0.5), ech.rotation_about((0, 0, 1), 1))]
    simulation.set_collider_keyframes(0, keys)
    simulation.step(29)
    half = ech.pose_at(keys, 0.5)
    assert half.position == pytest.approx((0.1, 0, 0)) and half.rotation == pytest.approx(turned)
    assert simulation.colliders[0].position == pytest.approx(half.position)
    assert simulation.colliders[0].rotation == pytest.approx(half.rotation)
    assert ech.pose_at(keys, -3).position == keys[0].position and ech.pose_at(keys, 7).position == keys[1].position


def test_a_cache_leads_the_vertices():
    samples = [BALL.vertices, BALL.vertices * np.float32(0.5), BALL.vertices]
    cache = ech.VertexCache(samples, 0.1)
    assert np.array_equal(cache.samples, samples) and not cache.samples.flags.writeable
    assert (cache.start_time, cache.sample_seconds, cache.end_time) == (0, 0.1, 0.2)
    assert np.allclose(cache.at(0.05), BALL.vertices * 0.75, atol=1e-6)
    assert np.array_equal(cache.at(-1), samples[0]) and np.array_equal(cache.at(9), samples[2])
    # Beside a cloth that lies on the ball, what shrinks leaves room that gravity fills.
    sheet = cloth(width=0.5, height=0.5, position=(0, 0, 0.35))
    led = ech.Simulation(sheet, [ech.Collider(ech.ExactMap(BALL))], time_step=0.01)
    led.set_collider_cache(0, cache)
    stays = ech.Simulation(sheet, [ech.Collider(ech.ExactMap(BALL))], time_step=0.01)
    led.step(10)
    stays.step(10)
    assert led.positions[:, 2].max() < stays.positions[:, 2].max() - 0.01
    assert len(ech.intersecting_pairs(led.mesh, ech.Mesh(cache.at(0.1), BALL.faces))) == 0


def test_a_folder_of_meshes_is_a_cache(tmp_path):
    for number, size in enumerate([1, 2]):
        ech.write_mesh(tmp_path / f"{number:03}.obj", ech.Mesh(BALL.vertices * np.float32(size), BALL.faces))
    cache = ech.read_vertex_cache(tmp_path, BALL, frames_per_second=10)
    assert cache.samples.shape == (2, len(BALL.vertices), 3) and cache.end_time == pytest.approx(0.1)
    assert refusal(ech.read_vertex_cache, tmp_path, torus(), frames_per_second=10)[0] == "invalid_mesh"
    assert refusal(ech.read_vertex_cache, tmp_path / "none.pc2", BALL, frames_per_second=10)[0] == "unreadable"
    with pytest.raises(ValueError, match="frames_per_second"):
        ech.read_vertex_cache(tmp_path, BALL, frames_per_second=0)


def test_one_part_passes_through_a_collider_that_holds_the_other():
    table = ech.Collider(ech.ExactMap(ech.make_box((4, 4, 0.2))))
    sheets = [ech.make_cloth(column_count=6, row_count=6, width=0.5, height=0.5, position=(x, 0, 0.2)) for x in (-1, 1)]
    both = ech.combine([ech.passing_through(0, sheets[0]), sheets[1]])
    run = ech.Simulation(both, [table], thickness=0.01)
    run.step(30)
    assert run.positions[:36, 2].max() < -0.1 and run.positions[36:, 2].min() > 0.1
    for collider, error in ((-1, ValueError), ("0", TypeError)):
        with pytest.raises(error, match="collider"):
            ech.passing_through(collider, sheets[0])
    assert refusal(ech.Simulation, ech.passing_through(1, sheets[0]), [table])[0] == "invalid_options"


def test_deformables_and_caches_are_pickled_whole():
    both = ech.combine([cloth(pins=[3], position=(0, 0, 2)), soft_box(attachments=[[0, 0]])])
    threaded = ech.make_cloth_of_mesh(BALL, position=(0, 0, 1))
    for deformable in (both, threaded, ech.passing_through(0, threaded)):
        again = pickle.loads(pickle.dumps(deformable))
        assert repr(again) == repr(deformable) and again.constraint_count == deformable.constraint_count
        runs = [ech.Simulation(d, [BELOW]) for d in (deformable, again)]
        for run in runs:
            run.step(5)
        assert runs[0].state_hash == runs[1].state_hash
        assert runs[1].restored(runs[0].save_state()).frame == 5
    cache = ech.VertexCache([BALL.vertices, BALL.vertices * 2], 0.5, start_time=1)
    again = pickle.loads(pickle.dumps(cache))
    assert np.array_equal(again.samples, cache.samples) and repr(again) == repr(cache)


@pytest.mark.parametrize(
    "options",
    [
        {"time_step": 0},
        {"time_step": np.nan},
        {"solver": "jakobsen"},
        {"drag": 2},
        {"gravity": (0, 0, np.nan)},
        {"iteration_count": 0},
        {"stretch_stiffness": 0},
        {"solver": "jakobsen", "collision": "surfaces"},
        {"collision": "particles", "untangle": True},
    ],
)
def test_options_out_of_range_are_refused_by_the_library(options):
    assert refusal(ech.Simulation, soft_box(), [BELOW], **options)[0] == "invalid_options"


def test_options_of_another_kind_are_refused_by_their_names():
    for options, error, words in (
        ({"solver": "jacobi"}, ValueError, "solver must be"),
        ({"iteration_count": -1}, ValueError, "iteration_count must be a whole number from 0 to 4294967295, not -1"),
        ({"time_step": "1"}, TypeError, "time_step must be a number, not '1'"),
        ({"gravity": (0, 0)}, ValueError, "gravity must be three numbers"),
        ({"gravity": 9.81}, TypeError, "gravity must be three numbers"),
        ({"thickness": "thin"}, TypeError, "thickness must be a number or None"),
    ):
        with pytest.raises(error, match=words):
            ech.Simulation(soft_box(), [BELOW], **options)
    turned = refusal(ech.Simulation, soft_box(), [ech.Collider(FLOOR, rotation=(2, 0, 0, 0))])[1]
    assert "a quaternion of length 2; it must be 1: cos(a / 2)" in turned and "::" not in turned
    for wrong in ({"scale": 0}, {"rotation": (2, 0, 0, 0)}, {"position": (np.nan, 0, 0)}):
        assert refusal(ech.Simulation, soft_box(), [ech.Collider(FLOOR, **wrong)])[0] == "invalid_options"
    with pytest.raises(ValueError):
        ech.Simulation(soft_box(), [ech.Collider(FLOOR, scale=(1, 2))])
    assert refusal(ech.Simulation, soft_box(attachments=[[0, 1]]), [BELOW])[0] == "invalid_options"
    assert "begins intersecting collider 0" in refusal(ech.Simulation, soft_box(position=(0, 0, 0)), [BELOW])[1]


def test_what_steers_no_collider_is_refused_and_changes_nothing():
    simulation = ech.Simulation(soft_box(), [BELOW])
    for index in (1, -1):
        for call in (
            lambda: simulation.set_collider_pose(index, (0, 0, 0)),
            lambda: simulation.set_collider_keyframes(index, []),
            lambda: simulation.set_collider_vertices(index, FLOOR_MESH.vertices),
            lambda: simulation.load_on(index),
        ):
            with pytest.raises(IndexError, match=f"there is no collider {index}; there is 1"):
                call()
    few, bad = FLOOR_MESH.vertices[1:], FLOOR_MESH.vertices.copy()
    bad[3] = np.nan
    for call in (
        lambda: simulation.set_collider_pose(0, (np.nan, 0, 0)),
        lambda: simulation.set_collider_pose(0, (0, 0, 0), (1, 1, 0, 0)),
        lambda: simulation.set_collider_keyframes(0, [ech.PoseKey(1, (0, 0, 0)), ech.PoseKey(1, (0, 0, 0))]),
        lambda: simulation.set_collider_vertices(0, few),
        lambda: simulation.set_collider_vertices(0, bad),
        lambda: simulation.set_collider_cache(0, ech.VertexCache([few], 1)),
    ):
        assert refusal(call)[0] == "invalid_options"
    untouched = ech.Simulation(soft_box(), [BELOW])
    simulation.step(3)
    untouched.step(3)
    assert simulation.state_hash == untouched.state_hash


def test_caches_and_keys_that_have_no_meaning_are_refused():
    for samples in (BALL.vertices, np.zeros((0, 4, 3)), np.zeros((2, 0, 3)), np.zeros((2, 4, 2))):
        with pytest.raises(ValueError, match="samples must have the shape"):
            ech.VertexCache(samples, 1)
    for seconds in (0, -1, np.nan, np.inf):
        with pytest.raises(ValueError, match="sample_seconds"):
            ech.VertexCache([BALL.vertices], seconds)
    with pytest.raises(ValueError, match="finite"):
        ech.VertexCache([BALL.vertices], 1).at(np.nan)
    bad = np.array([BALL.vertices] * 3)
    bad[2, 5, 1] = np.nan
    with pytest.raises(ValueError, match="samples must be finite; vertex 5 of sample 2 is not"):
        ech.VertexCache(bad, 1)
    later, long = ech.PoseKey(1, (0, 0, 0)), ech.PoseKey(0, (0, 0, 0), (2, 0, 0, 0))
    for keys in ([], [later, later._replace(time=0)], [long]):
        with pytest.raises(ValueError, match="key"):
            ech.pose_at(keys, 0)
    with pytest.raises(ValueError, match="axis"):
        ech.rotation_about((0, 0, 0), 1)


def test_a_saved_state_goes_on_with_the_same_bits():
    def made():
        return ech.Simulation(soft_box(position=(0, 0, 0.3)), [BELOW])

    first = made()
    first.step(8)
    state, positions = first.save_state(), first.positions
    first.step(5)
    before = positions.copy()
    for simulation in (first, made()):
        again = simulation.restored(state)
        assert again.frame == 8
        again.step(5)
        assert again.state_hash == first.state_hash
    assert np.array_equal(positions, before) and np.shares_memory(positions, first.positions)


def test_bytes_that_are_no_state_of_it_are_refused():
    simulation = ech.Simulation(soft_box(), [BELOW])
    state = simulation.save_state()
    assert refusal(simulation.restored, b"")[0] == "wrong_format"
    assert refusal(simulation.restored, b"no state" * 100)[0] == "wrong_format"
    assert refusal(simulation.restored, state[:-5])[0] == "damaged"
    changed = bytearray(state)
    changed[len(state) // 2] ^= 1
    assert refusal(simulation.restored, bytes(changed))[0] == "damaged"
    assert refusal(ech.Simulation(soft_box(), [BELOW], friction=0).restored, state)[0] == "invalid_options"
    with pytest.raises(TypeError):
        simulation.restored("text")


# ---- Scenes


SCENE = {
    "colliders": [
        {"model": {"box": {"size": [4, 4, 1]}}, "position": [0, 0, -0.5]},
        {"model": "ball.obj", "position": [0.5, 0, 0.4], "cache": {"file": "cache", "frames_per_second": 24}},
    ],
    "cloth": {"size": [1, 1], "particles": [10, 10], "position": [0.3, 0, 0.9], "density": 0.3},
    "bodies": [
        {"mesh": "ball.obj", "element": 0.15, "position": [-0.3, 0, 0.4]},
        {"mesh": {"box": {"size": [0.2, 0.2, 0.2]}}, "element": 0.1, "position": [-1, 0, 0.2]},
    ],
}


@pytest.fixture
def folder(tmp_path):
    ech.write_mesh(tmp_path / "ball.obj", BALL)
    (tmp_path / "cache").mkdir()
    for number in range(3):
        grown = ech.Mesh(BALL.vertices * np.float32(1 + 0.05 * number), BALL.faces)
        ech.write_mesh(tmp_path / "cache" / f"{number}.obj", grown)
    return tmp_path


def test_scenes_may_have_several_colliders_bodies_and_caches(folder):
    (folder / "scene.json").write_text(json.dumps(SCENE))
    run_program("simulate", folder / "scene.json", "--frames", "10", "--obj", "-o", folder / "run")
    simulation = ech.Simulation.from_scene(folder / "scene.json")
    assert len(simulation.colliders) == 2 and len(simulation.tetrahedra) > 100
    simulation.step(10)
    theirs = (folder / "run" / "frames" / "cloth_000010.obj").read_text().splitlines()
    vertices = np.array([line.split()[1:4] for line in theirs if line.startswith("v ")], np.float32)
    assert np.array_equal(simulation.positions[np.unique(simulation.faces)], vertices)


def test_a_body_may_be_a_file_of_tetrahedra(folder):
    filled = ech.tetrahedralize(ech.ExactMap(BALL), size=0.15).mesh
    ech.write_tetrahedra(folder / "ball.msh", filled)
    simulations = []
    for body in ({"mesh": "ball.msh"}, {"mesh": "ball.obj", "element": 0.15}):
        scene = {"model": {"box": {}}, "bodies": [{**body, "position": [0, 0, 0.9]}]}
        simulations.append(ech.Simulation.from_scene(scene, model_folders=[folder]))
        simulations[-1].step(5)
    assert len(simulations[0].tetrahedra) == len(filled.tetrahedra)
    assert simulations[0].state_hash == simulations[1].state_hash


def test_each_collider_may_have_another_model(folder):
    floor, _ = SCENE["colliders"]
    without_cache = {**SCENE, "colliders": [floor, {"model": "ball.obj", "position": [0.5, 0, 0.4]}]}
    expected = ech.Simulation.from_scene(without_cache, model_folders=[folder])
    given = ech.Simulation.from_scene(without_cache, model=[None, ech.ExactMap(BALL)], model_folders=[folder])
    expected.step(5)
    given.step(5)
    assert given.state_hash == expected.state_hash
    with pytest.raises(ValueError, match="2 colliders, and model has 1"):
        ech.Simulation.from_scene(without_cache, model=BALL, model_folders=[folder])
    with pytest.raises(ValueError, match="collider 1 has a vertex cache"):
        ech.Simulation.from_scene(SCENE, model=[None, ech.ExactMap(BALL)], model_folders=[folder])
