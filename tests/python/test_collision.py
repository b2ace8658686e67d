"""Collision for a solver of one's own; the solver is a line of each test."""

import numpy as np
import pytest

import echinus as ech
from support import programs_of

SECONDS = 1 / 60
BALL = ech.make_sphere(1, 40, 20)
MAP = ech.ExactMap(BALL)


def particles(count=500):
    return np.random.default_rng(1).uniform(-1, 1, (count, 3)).astype(np.float32) + np.float32([0, 0, 2.5])


def test_particles_that_fall_on_a_ball_end_outside_and_slow_down():
    positions = particles()
    velocities = np.zeros_like(positions)
    masses = np.ones(len(positions))
    masses[0] = 0
    collision = ech.ParticleCollision([ech.Collider(MAP)], 0.01, friction=0.3)
    corrected = 0
    for step in range(40):
        previous = positions.copy()
        velocities[:, 2] -= 9.81 * SECONDS
        positions += velocities * np.float32(SECONDS)
        sent = positions.copy()
        collision.set_collider_pose(0, (0, 0, 0.01 * step))
        moved = collision.correct(previous, positions, velocities, masses, seconds=SECONDS)
        assert moved.dtype == np.uint32
        assert np.array_equal(moved, np.flatnonzero((positions != sent).any(axis=1)))
        assert 0 not in moved
        corrected += len(moved)
        inside = MAP.contains(positions - np.float32([0, 0, 0.01 * step]))
        inside[0] = False
        assert not inside.any()
    assert corrected > 500
    assert collision.lost_count == 0
    collision.set_collider_friction(0, 1)
    collision.place_collider(0, (50, 0, 0))
    assert len(collision.correct(positions, positions.copy(), seconds=SECONDS)) == 0


def test_faces_that_fall_on_a_ball_meet_neither_it_nor_each_other():
    sheet = ech.make_cloth(column_count=8, row_count=8, width=2, height=2, position=(0, 0, 1.1))
    positions, faces = sheet.positions.copy(), sheet.faces
    velocities = np.zeros_like(positions)
    collision = ech.SurfaceCollision(positions, faces, [ech.Collider(MAP)], 0.02)
    corrected = 0
    for step in range(30):
        velocities[:, 2] -= 9.81 * SECONDS
        positions += velocities * np.float32(SECONDS)
        collision.set_collider_pose(0, (0, 0, 0.002 * step))
        corrected += len(collision.correct(positions, velocities, seconds=SECONDS))
        ball = ech.Mesh(BALL.vertices + np.float32([0, 0, 0.002 * step]), BALL.faces)
        assert len(ech.intersecting_pairs(ech.Mesh(positions, faces), ball)) == 0
        assert len(ech.self_intersecting_pairs(ech.Mesh(positions, faces))) == 0
    assert corrected > 30
    assert collision.unresolved_count == 0


def test_the_program_of_the_documents_leaves_nothing_inside():
    names = {}
    for program in programs_of("docs/own_solver.md"):
        exec(program, names)
    seen_from_the_torus = names["positions"] - np.float32([0, 0, 0.2 * 119 / 60])
    assert not names["torus"].contains(seen_from_the_torus).any()
    assert len(names["corrected"]) > 0


def test_arrays_that_cannot_be_corrected_in_place_are_refused():
    collision = ech.ParticleCollision([ech.Collider(MAP)], 0.01)
    good = particles(2)
    with pytest.raises(TypeError, match="positions must be a contiguous array of float32"):
        collision.correct(good, good.astype(np.float64), seconds=SECONDS)
    read_only = good.copy()
    read_only.flags.writeable = False
    with pytest.raises(ValueError, match="writeable"):
        collision.correct(good, read_only, seconds=SECONDS)
    with pytest.raises(ech.Error, match="1 previous positions"):
        collision.correct(good[:1], good.copy(), seconds=SECONDS)
    with pytest.raises(ech.Error, match="a step takes -1e-09 seconds"):
        collision.correct(good, good.copy(), seconds=-1e-9)
    with pytest.raises(ValueError, match="must be different arrays: copy the positions"):
        collision.correct(good, good, seconds=SECONDS)
