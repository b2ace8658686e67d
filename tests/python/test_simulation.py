"""Simulations: those of C++, bit for bit; and views that live."""

import _thread
import copy
import json
import pathlib
import pickle
import threading

import numpy as np
import pytest

import echinus as ech
from support import ROOT, open_torus, run_program, torus

SCENE = ROOT / "scenes" / "torus_small.json"
SHEET = {
    "model": {"torus": {}},
    "cloth": {"size": [3, 3], "particles": [12, 12], "position": [0, 0, 0.5]},
    "collision": "particles",
}
HIGH = {**SHEET, "cloth": {**SHEET["cloth"], "position": [0, 0, 2]}}


def test_a_simulation_gives_the_positions_of_the_c_plus_plus_program(tmp_path):
    run_program("simulate", SCENE, "--frames", "20", "--obj", "-o", tmp_path / "run")
    simulation = ech.Simulation.from_scene(SCENE)
    simulation.step(20)
    theirs = (tmp_path / "run" / "frames" / "cloth_000020.obj").read_text().splitlines()
    vertices = np.array([line.split()[1:4] for line in theirs if line.startswith("v ")], np.float32)
    assert np.array_equal(simulation.positions, vertices)


def test_positions_are_a_view_that_lives_and_cannot_be_written():
    simulation = ech.Simulation.from_scene(HIGH)
    positions, before = simulation.positions, simulation.positions.copy()
    simulation.step(10)
    assert np.shares_memory(positions, simulation.positions)
    assert (positions[:, 2] < before[:, 2]).all()
    with pytest.raises(ValueError):
        positions[0] = 0
    assert positions.shape == (144, 3) and simulation.faces.shape == (242, 3)


def test_a_view_keeps_the_simulation_alive():
    positions = ech.Simulation.from_scene(SHEET).positions
    assert np.array_equal(positions, ech.Simulation.from_scene(SHEET).positions)


def test_velocities_are_those_of_falling():
    simulation = ech.Simulation.from_scene({**HIGH, "material": {"air_drag": 0}})
    simulation.step(6)
    assert simulation.velocities[:, 2].mean() == pytest.approx(-9.81 * 6 / 60, rel=0.02)


def test_it_runs_until_the_cloth_rests():
    simulation = ech.Simulation.from_scene(SHEET)
    assert simulation.run() and simulation.at_rest
    assert simulation.frame < simulation.frame_limit == 3000
    assert simulation.profile.contact_count > 0 and simulation.profile.lost_count == 0
    assert not ech.ExactMap(ech.make_torus()).contains(simulation.positions).any()
    assert not ech.Simulation.from_scene(SHEET).run(5)


def test_copies_are_independent():
    a = ech.Simulation.from_scene(SHEET)
    b = copy.copy(a)
    a.step()
    assert b.frame == 0 and a.frame == 1
    b.step()
    assert a.state_hash == b.state_hash and not np.shares_memory(a.positions, b.positions)


def test_a_simulation_cannot_be_pickled():
    with pytest.raises(TypeError):
        pickle.dumps(ech.Simulation.from_scene(SHEET))


def test_a_mesh_or_a_map_may_replace_the_model():
    expected = ech.Simulation.from_scene(SHEET)
    expected.step(25)
    for model in (ech.make_torus(), ech.ExactMap(ech.make_torus())):
        simulation = ech.Simulation.from_scene(SHEET, model=model)
        simulation.step(25)
        assert simulation.state_hash == expected.state_hash


def test_the_lines_of_a_file_are_threads(tmp_path: pathlib.Path):
    (tmp_path / "thread.obj").write_text("v -1 0 1\nv 0 0 1\nv 1 0 1\nl 1 2 3\n")
    scene = {"model": {"torus": {}}, "cloth": {"mesh": "thread.obj", "thickness": 0.02}}
    simulation = ech.Simulation.from_scene(scene, model_folders=[tmp_path])
    for one_folder in (str(tmp_path), tmp_path):
        assert ech.Simulation.from_scene(scene, model_folders=one_folder).state_hash == simulation.state_hash
    simulation.step(30)
    ends = simulation.positions
    assert ends.shape == (3, 3) and simulation.faces.shape == (0, 3)
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(1, abs=0.02), "held by its constraints"


def test_a_mesh_may_replace_the_file_of_the_cloth():
    scene = {"model": {"torus": {}}, "cloth": {"mesh": "sheet.obj", "position": [0, 0, 1]}}
    sheet = ech.make_sphere(0.3, 12, 6)
    simulation = ech.Simulation.from_scene(scene, cloth=sheet)
    assert np.allclose(simulation.positions, sheet.vertices + [0, 0, 1], atol=1e-6)


def test_surfaces_collide_where_it_is_said():
    simulation = ech.Simulation.from_scene(SHEET, collision="surfaces_and_self")
    assert simulation.options.collision == "surfaces_and_self"
    simulation.step(20)
    assert len(ech.intersecting_pairs(simulation.mesh, ech.make_torus())) == 0
    assert simulation.profile.measured_pair_count > 0
    by_default = {key: value for key, value in SHEET.items() if key != "collision"}
    assert ech.Simulation.from_scene(by_default).options.collision == "surfaces_and_self"
    particles_only = ech.Simulation.from_scene({**by_default, "untangle": True}, collision="particles").options
    assert particles_only.collision == "particles" and not particles_only.untangle
    sampled = ech.DistanceMap(ech.make_torus())
    assert ech.Simulation.from_scene(by_default, model=sampled).options.collision == "particles"
    beside = ech.Simulation.from_scene({**SHEET, "map": {"kind": "distance"}}, collision="surfaces")
    beside.step(20)
    assert len(ech.intersecting_pairs(beside.mesh, ech.make_torus())) == 0


def test_an_open_model_is_refused_unless_it_is_said():
    with pytest.raises(ech.Error, match="not closed") as raised:
        ech.Simulation.from_scene(SHEET, model=open_torus())
    assert raised.value.code == "invalid_mesh"
    ech.Simulation.from_scene(SHEET, model=open_torus(), allow_open_colliders=True).step()
    ech.Simulation.from_scene(SHEET, model=open_torus(), collision="surfaces_and_self").step()


def test_models_are_looked_for_in_the_folders_that_are_named(tmp_path):
    ech.write_mesh(tmp_path / "mine.obj", ech.make_torus())
    scene = {**SHEET, "model": "mine.obj"}
    with pytest.raises(ech.Error, match="mine.obj") as raised:
        ech.Simulation.from_scene(scene)
    assert raised.value.code == "unreadable"
    ech.Simulation.from_scene(scene, model_folders=[tmp_path])
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    ech.Simulation.from_scene(tmp_path / "scene.json")


def test_numbers_of_a_scene_may_be_numpy_s_and_must_be_finite():
    sheet = {**SHEET, "gravity": np.array([0, 0, -1])}
    assert ech.Simulation.from_scene({**sheet, "frame_limit": np.int64(3)}).frame_limit == 3
    with pytest.raises(ValueError, match=r"gravity\[2\] must be finite, not nan"):
        ech.Simulation.from_scene({**SHEET, "gravity": [0, 0, np.nan]})


def test_models_hands_and_wind_move_what_they_should():
    simulation = ech.Simulation.from_scene({**SHEET, "gravity": [0, 0, 0]})
    simulation.set_collider_velocity(0, [0, 0, -1], [0, 0, 1])
    simulation.set_particle_velocity(0, [0, 0, 5])
    simulation.step()
    assert simulation.colliders[0].position == pytest.approx((0, 0, -1 / 60))
    assert simulation.positions[0, 2] > simulation.positions[100, 2]
    before = simulation.positions[:, 2].mean()
    simulation.blow([0, 0, 10], 5)
    simulation.step()
    assert simulation.positions[:, 2].mean() > before


def test_a_simulation_that_diverged_can_only_be_read():
    simulation = ech.Simulation.from_scene(SHEET)
    simulation.set_particle_velocity(0, [1e30, 0, 0])
    with pytest.raises(ech.Error, match="frame") as raised:
        simulation.step(10)
    assert raised.value.code == "diverged"
    for call in (simulation.step, lambda: simulation.blow([0, 0, 0], 0)):
        with pytest.raises(ech.Error, match="can only be read"):
            call()
    assert simulation.positions.shape == (144, 3)


def test_ctrl_c_ends_long_work():
    simulation = ech.Simulation.from_scene(SHEET)
    timer = threading.Timer(0.2, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.step(2**31)
    timer.join()
    frame = simulation.frame
    simulation.step()
    assert simulation.frame == frame + 1


def test_threads_may_share_a_simulation():
    shared, alone = (ech.Simulation.from_scene(SHEET) for _ in range(2))
    threads = [threading.Thread(target=shared.step, args=(10,)) for _ in range(4)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        assert shared.profile.query_count >= 0
    alone.step(40)
    assert shared.frame == 40 and shared.state_hash == alone.state_hash


def test_jakobsen_has_collision_of_particles_whether_that_is_said_or_not():
    sheet = ech.make_cloth(column_count=5, row_count=5)
    for given in ({}, {"collision": "particles"}):
        simulation = ech.Simulation(sheet, solver="jakobsen", time_step=1 / 240, **given)
        assert simulation.options.collision == "particles"
    with pytest.raises(ech.Error, match="only the newton solver has it"):
        ech.Simulation(sheet, solver="jakobsen", time_step=1 / 240, collision="surfaces")
    with pytest.raises(ech.Error, match='collision is .surfaces.*leave it out, or set "solver": "newton" in the scene'):
        ech.Simulation.from_scene({**SHEET, "solver": "jakobsen"}, collision="surfaces")


def test_a_scene_takes_no_mode_of_collision_but_the_three():
    for wrong, error in ((5, TypeError), (b"surfaces", TypeError), ("self", ValueError)):
        with pytest.raises(error, match="collision must be"):
            ech.Simulation.from_scene(SHEET, collision=wrong)
    with pytest.raises(ech.Error, match="untangle is True, and needs the collision of surfaces"):
        ech.Simulation.from_scene(SHEET, collision="particles", untangle=True)
