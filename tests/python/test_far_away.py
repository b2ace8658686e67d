"""Meshes in coordinates that float32 cannot hold, such as those of a country."""

import pickle

import numpy as np
import pytest

import echinus as ech

PLACES = {"utm": (448262, 5411932, 112), "far": (1e7, -2e7, 3e6), "farther": (-1e9, 7, 1e9)}


@pytest.fixture(params=PLACES)
def place(request):
    return np.array(PLACES[request.param], float)


def moved(mesh, place):
    return ech.Mesh(mesh.vertices.astype(np.float64) + place, mesh.faces)


def test_vertices_stay_float64_where_float32_cannot_hold_the_shape(place):
    torus = ech.make_torus()
    far = moved(torus, place)
    assert far.vertices.dtype == np.float64
    assert np.abs(far.vertices - place - torus.vertices).max() < 1e-6
    assert ech.inspect(far).signed_volume == pytest.approx(ech.inspect(torus).signed_volume, rel=1e-6)
    assert np.allclose(ech.inspect(far).centre, place, atol=1e-6)
    assert moved(torus, (300, 0, 0)).vertices.dtype == np.float32


def test_maps_answer_about_points_in_the_frame_of_the_mesh(place):
    torus = ech.make_torus()
    far = ech.ExactMap(moved(torus, place))
    assert np.allclose(far.centre, place, atol=1e-6) and np.abs(np.subtract(far.origin, place)).max() <= 1
    points = np.random.default_rng(1).uniform(-1.5, 1.5, (2000, 3))
    distances = ech.unsigned_distance(torus, points)
    is_inside = ech.winding_number(torus, points) > 0.5
    tolerance = 4e-6 * far.radius + 4 * np.finfo(float).eps * np.abs(place).max()
    assert np.abs(np.abs(far.signed_distance(points + place)) - distances).max() < tolerance + 1e-6
    clear = distances > tolerance
    assert np.array_equal(far.contains(points + place)[clear], is_inside[clear])
    assert np.array_equal(ech.DistanceMap(moved(torus, place)).contains(points + place)[distances > 0.05], is_inside[distances > 0.05])
    contacts = far.contacts(points + place, np.inf)
    assert contacts.point.dtype == np.float64
    reach = np.linalg.norm(contacts.point - (points + place), axis=-1)
    assert np.abs(reach - distances).max() < tolerance + 1e-6
    hits = far.sweep(points[:100] + place, place)
    assert np.abs(hits.point[hits.found] - place).max() < 2
    assert np.array_equal(far.winding_number(points[:10] + place) > 0.5, is_inside[:10])


def test_maps_and_meshes_keep_their_place_in_files_and_pickles(place, tmp_path):
    far = moved(ech.make_torus(), place)
    exact = ech.ExactMap(far)
    exact.save(tmp_path / "far.ech")
    inside = place + (1, 0, 0)
    for again in (ech.load(tmp_path / "far.ech"), pickle.loads(pickle.dumps(exact))):
        assert again.origin == exact.origin and again.contains(inside) and again.contains(place) == exact.contains(place)
    assert np.array_equal(pickle.loads(pickle.dumps(far)).vertices, far.vertices)


def test_float32_says_how_coarse_it_is_there():
    box = ech.make_box((1, 0.9, 0.8))
    rounded = ech.Mesh((box.vertices + np.array(PLACES["utm"])).astype(np.float32), box.faces)
    assert ech.inspect(rounded).rounding_step == 0.5
    assert ech.inspect(moved(box, PLACES["utm"])).rounding_step == 0


def test_simulations_refuse_them():
    far = moved(ech.make_box(), PLACES["utm"])
    with pytest.raises(ech.Error, match="stands around"):
        ech.Simulation(ech.make_cloth(), [ech.Collider(ech.ExactMap(far))])
