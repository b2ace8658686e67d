"""Answers of maps, against brute force over all faces and against the C++ program."""

import copy
import json
import multiprocessing
import pickle
import threading

import numpy as np
import pytest
from hypothesis import given, strategies

import echinus as ech
from support import SHARED_MESHES, open_torus, points_around, run_program, torus

MESHES = {
    "torus": torus(),
    "sphere": ech.make_sphere(2, 20, 10),
    "box": ech.make_box((1, 2, 3), 2),
}
if (SHARED_MESHES / "horse_6k.obj").exists():
    MESHES["horse"] = ech.read_mesh(SHARED_MESHES / "horse_6k.obj")


@pytest.fixture(params=MESHES)
def mesh(request):
    return MESHES[request.param]


def step_of(exact_map):
    return 4e-6 * exact_map.radius


def test_an_exact_map_agrees_with_the_winding_number(mesh):
    points = points_around(mesh, 2000)
    m = ech.ExactMap(mesh)
    far_from_surface = ech.unsigned_distance(mesh, points) > step_of(m)
    truth = ech.winding_number(mesh, points) > 0.5
    assert far_from_surface.mean() > 0.99
    assert np.array_equal(m.contains(points)[far_from_surface], truth[far_from_surface])


def test_depths_are_distances_to_the_nearest_point_of_the_surface(mesh):
    points = points_around(mesh, 1000)
    m = ech.ExactMap(mesh)
    contacts = m.contacts(points, np.inf)
    assert contacts.found.all() and contacts.certain.all()
    distance = ech.unsigned_distance(mesh, points)
    assert np.abs(np.abs(contacts.depth) - distance).max() < step_of(m)
    assert np.array_equal(contacts.depth > 0, contacts.inside)
    assert np.abs(np.linalg.norm(contacts.point - points, axis=1) - distance).max() < step_of(m)
    assert np.abs(np.linalg.norm(contacts.normal, axis=1) - 1).max() < 1e-5


def test_the_nearest_point_lies_on_the_face_that_is_named(mesh):
    m = ech.ExactMap(mesh)
    contacts = m.contacts(points_around(mesh, 300), np.inf)
    for point, face in zip(contacts.point, contacts.face):
        one_face = ech.Mesh(mesh.vertices, mesh.faces[[face]])
        assert ech.unsigned_distance(one_face, point) < step_of(m)


def test_signed_distances_are_negative_inside_and_as_long_as_the_way_out(mesh):
    m = ech.ExactMap(mesh)
    points = points_around(mesh, 3000)
    points[-100:] *= 1000
    distances, gradients = m.signed_distance(points, gradient=True)
    assert distances.dtype == gradients.dtype == np.float32 and gradients.shape == points.shape
    assert np.array_equal(np.signbit(distances), m.contains(points))
    assert np.array_equal(-distances, m.contacts(points, np.inf).depth)
    assert np.array_equal(m.signed_distance(points, threads=0), distances)
    truth = ech.unsigned_distance(mesh, points)
    assert (np.abs(np.abs(distances) - truth) <= step_of(m) + 1e-6 * truth).all()
    assert np.abs(np.linalg.norm(gradients, axis=1) - 1).max() < 1e-5


def test_gradients_lead_away_from_the_surface(mesh):
    m = ech.ExactMap(mesh)
    points = points_around(mesh, 2000)
    distances, gradients = m.signed_distance(points, gradient=True)
    clear = np.abs(distances) > 100 * step_of(m)
    foot = points - distances[:, None] * gradients
    assert ech.unsigned_distance(mesh, foot[clear]).max() < 10 * step_of(m)


def test_distances_of_points_that_are_not_finite_are_not_either():
    points = np.array([[np.nan, 0, 0], [0, np.inf, 0], [0, -np.inf, np.nan], [1, 0, 0]], np.float32)
    distances, gradients = EXACT_TORUS.signed_distance(points, gradient=True)
    assert np.isnan(distances[[0, 2]]).all() and distances[1] == np.inf and distances[3] < 0
    assert (gradients[:3] == 0).all()
    out = np.empty(4, np.float32)
    assert EXACT_TORUS.signed_distance(points, out=out) is out and np.array_equal(out, distances, equal_nan=True)


def test_winding_numbers_are_those_of_the_sum_over_all_faces():
    mesh, points = open_torus(), points_around(torus(), 1000)
    m, truth = ech.ExactMap(mesh), ech.winding_number(mesh, points)
    clear = ech.unsigned_distance(mesh, points) > 100 * step_of(m)
    for tolerance in (0, 1e-3, 0.1):
        found = m.winding_number(points, tolerance=tolerance, threads=0)
        assert np.abs(found - truth)[clear].max() < tolerance + 1e-3
    assert set(EXACT_TORUS.winding_number(points)) == {0, 1}
    assert np.isnan(m.winding_number([np.nan, 0, 0])) and m.winding_number([np.inf, 0, 0]) == 0
    with pytest.raises(ValueError, match="tolerance must be 0 or more"):
        m.winding_number(points, tolerance=-1)


def test_a_margin_bounds_the_contacts_of_points_outside(mesh):
    m = ech.ExactMap(mesh)
    points = points_around(mesh, 2000)
    near, all_of_them = m.contacts(points, 0.05), m.contacts(points, np.inf)
    expected = all_of_them.inside | (all_of_them.depth >= -0.05)
    assert np.array_equal(near.found, expected)
    assert (near.array[expected] == all_of_them.array[expected]).all()
    assert np.array_equal(near.point[~expected], points[~expected])


def test_contacts_and_contains_agree(mesh):
    points = points_around(mesh, 5000)
    for m in (ech.ExactMap(mesh), ech.DistanceMap(mesh)):
        assert np.array_equal(m.contains(points), m.contacts(points).inside)


@pytest.mark.parametrize("kind", ["exact", "distance"])
def test_answers_are_those_of_the_c_plus_plus_program_bit_for_bit(kind, mesh, tmp_path):
    points = points_around(mesh, 20_000)
    m = ech.ExactMap(mesh) if kind == "exact" else ech.DistanceMap(mesh)
    ech.write_mesh(tmp_path / "mesh.ply", mesh)
    np.save(tmp_path / "points.npy", points)
    run_program("build", tmp_path / "mesh.ply", "--kind", kind, "-o", tmp_path / "map.ech")
    run_program("query", tmp_path / "map.ech", tmp_path / "points.npy", "--margin", "0.1", "-o", tmp_path / "answers.npy")
    answers = np.load(tmp_path / "answers.npy")
    contacts = m.contacts(points, 0.1)
    for name in ("inside", "depth", "normal", "point", "face", "certain"):
        assert np.array_equal(answers[name], getattr(contacts, name)), name
    assert ech.load(tmp_path / "map.ech").source_hash == m.source_hash


def test_neither_threads_nor_instructions_change_an_answer(mesh):
    points = points_around(mesh, 100_000)
    m = ech.ExactMap(mesh)
    inside, contacts = m.contains(points), m.contacts(points, 0.05)
    before = ech.instruction_set()
    try:
        for name in ech.available_instruction_sets()[:2]:
            ech.use_instruction_set(name)
            assert np.array_equal(m.contains(points, threads=0), inside)
            assert (m.contacts(points, 0.05, threads=2).array == contacts.array).all()
    finally:
        ech.use_instruction_set(before)


@given(strategies.integers(0, 2**32 - 1))
def test_a_segment_that_meets_nothing_stays_on_its_side(seed):
    random = np.random.default_rng(seed)
    m = EXACT_TORUS
    start, end = random.uniform(-1.5, 1.5, (2, 50, 3)).astype(np.float32)
    hits = m.sweep(start, end)
    sides = m.contains(start), m.contains(end)
    assert np.array_equal(sides[0][~hits.found], sides[1][~hits.found])
    assert np.array_equal(hits.entering[hits.found], ~sides[0][hits.found])
    assert (hits.fraction[~hits.found] == 1).all() and (hits.face[~hits.found] == -1).all()
    along = start + hits.fraction[:, None] * (end - start)
    assert np.abs(along - hits.point).max() < 1e-5
    assert ech.unsigned_distance(torus(), hits.point[hits.found]).max(initial=0) < 1e-5


EXACT_TORUS = ech.ExactMap(torus())


def test_a_sweep_broadcasts_its_ends():
    ends = points_around(torus(), 100)
    hits = EXACT_TORUS.sweep([0, 0, 0], ends)
    assert (hits.array == EXACT_TORUS.sweep(np.zeros_like(ends), ends, threads=0).array).all()
    assert EXACT_TORUS.sweep(np.zeros((4, 1, 3)), np.zeros((5, 3))).fraction.shape == (4, 5)
    with pytest.raises(ValueError, match=r"start and end must have shapes that fit each other, not \(4, 3\) and \(5, 3\)"):
        EXACT_TORUS.sweep(np.zeros((4, 3)), np.zeros((5, 3)))


def test_an_open_mesh_is_marked_uncertain_somewhere():
    m = ech.ExactMap(open_torus())
    contacts = m.contacts(points_around(torus(), 5000))
    assert 0 < m.statistics.certain_share < 1
    assert 0 < contacts.certain.mean() < 1


def test_the_answers_are_views_of_one_array():
    contacts = EXACT_TORUS.contacts(points_around(torus(), 10))
    for name in ("inside", "depth", "normal", "point", "face", "certain", "feature"):
        assert np.shares_memory(getattr(contacts, name), contacts.array), name


# ---- Building


def test_options_change_the_map_and_not_the_answers():
    points = points_around(torus(), 5000)
    finer = ech.ExactMap(torus(), cells_per_octant=4096, centre="search")
    assert finer.byte_count > EXACT_TORUS.byte_count
    assert np.array_equal(finer.contains(points), EXACT_TORUS.contains(points))
    assert ech.ExactMap(torus(), budget=200_000).byte_count <= 200_000


@pytest.mark.parametrize("value", [np.nan, np.float32(np.inf)])
def test_a_number_that_is_not_finite_is_refused_by_its_key(value):
    with pytest.raises(ValueError, match="budget must be finite"):
        ech.ExactMap(torus(), budget=value)
    with pytest.raises(ValueError, match=r"centre\[1\] must be finite"):
        ech.ExactMap(torus(), centre=[0, value, 0])


def test_a_path_with_a_null_byte_is_refused():
    with pytest.raises(ValueError, match="a path must have no null byte"):
        ech.load("horse.ech\0")


def test_rules_differ_where_parts_overlap():
    outer, inner = ech.make_box((2, 2, 2)), ech.make_box()
    both = ech.Mesh(np.concatenate([outer.vertices, inner.vertices]), np.concatenate([outer.faces, inner.faces + 8]))
    assert ech.ExactMap(both, rule="nonzero").contains([0.1, 0, 0])
    assert not ech.ExactMap(both, rule="parity").contains([0.1, 0, 0])


def test_the_distance_map_has_as_many_directions_as_asked():
    few, many = ech.DistanceMap(torus(), (20, 20)), ech.DistanceMap(torus(), directions=(200, 200))
    points = points_around(torus(), 20_000)
    truth = EXACT_TORUS.contains(points)
    assert few.byte_count < many.byte_count / 50
    assert (many.contains(points) != truth).mean() < (few.contains(points) != truth).mean() < 0.2
    assert ech.DistanceMap(torus(), grid="cube", divisions=50, entries="unorm16").byte_count < many.byte_count
    with pytest.raises(ech.Error, match="map.directions is 20; it must be an array of 2"):
        ech.DistanceMap(torus(), 20)


@pytest.mark.parametrize(
    "options, sentence",
    [
        ({"cells_per_octant": -1}, "cells_per_octant"),
        ({"budget": 1}, "budget"),
        ({"rule": "odd"}, "rule"),
        ({"centre": "middle"}, "centre"),
        ({"cells_per_octant": 4, "budget": 100_000}, "budget"),
    ],
)
def test_an_option_out_of_range_is_named(options, sentence):
    with pytest.raises(ech.Error, match=sentence) as raised:
        ech.ExactMap(torus(), **options)
    assert raised.value.code in ("invalid_scene", "invalid_options")


def test_a_mesh_without_faces_has_no_map():
    with pytest.raises(ech.Error, match="face") as raised:
        ech.ExactMap(ech.Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)))
    assert raised.value.code == "invalid_mesh"


# ---- Files and other processes


@pytest.mark.parametrize("make", [ech.ExactMap, ech.DistanceMap])
def test_a_saved_map_loads_as_the_same(make, tmp_path):
    m = make(torus())
    m.save(tmp_path / "map.ech")
    loaded = ech.load(tmp_path / "map.ech")
    points = points_around(torus(), 1000)
    assert type(loaded) is make and loaded.source_hash == m.source_hash and loaded.statistics == m.statistics
    assert (loaded.contacts(points, 0.1).array == m.contacts(points, 0.1).array).all()


@pytest.mark.parametrize("make", [ech.ExactMap, ech.DistanceMap])
@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickled_map_is_the_same(make, protocol):
    m = make(torus())
    again = pickle.loads(pickle.dumps(m, protocol))
    points = points_around(torus(), 1000)
    assert type(again) is make
    assert (again.contacts(points, 0.1).array == m.contacts(points, 0.1).array).all()


def test_processes_share_a_map():
    points = points_around(torus(), 1000).reshape(4, 250, 3)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        answers = pool.map(EXACT_TORUS.contains, points)
    assert np.array_equal(answers, EXACT_TORUS.contains(points))


def test_a_copy_of_a_map_is_the_map():
    assert copy.copy(EXACT_TORUS) is EXACT_TORUS and copy.deepcopy(EXACT_TORUS) is EXACT_TORUS


def test_a_file_that_is_no_map_is_refused(tmp_path):
    (tmp_path / "text.ech").write_text("no map")
    EXACT_TORUS.save(tmp_path / "cut.ech")
    (tmp_path / "cut.ech").write_bytes((tmp_path / "cut.ech").read_bytes()[:-100])
    for name, code in {"text.ech": "wrong_format", "cut.ech": "damaged", "absent.ech": "unreadable"}.items():
        with pytest.raises(ech.Error, match=name) as raised:
            ech.load(tmp_path / name)
        assert raised.value.code == code


def test_a_damaged_pickle_is_refused():
    function, (data,) = EXACT_TORUS.__reduce__()
    for damaged in (b"", b"ECHN", data[:-8], data[:100] + b"\xff" * 8 + data[108:]):
        with pytest.raises(ech.Error):
            function(damaged)


# ---- Threads


def test_other_threads_run_while_a_batch_is_computed(huge_switch_interval):
    points = np.zeros((3_000_000, 3), np.float32) + [1.39, 0, 0]
    started, done = threading.Event(), threading.Event()

    def compute():
        started.set()
        EXACT_TORUS.contacts(points, 1)
        done.set()

    thread = threading.Thread(target=compute)
    thread.start()
    started.wait()
    ran_beside = not done.is_set()
    thread.join()
    assert ran_beside


def test_many_threads_may_query_one_map():
    points = points_around(torus(), 20_000)
    expected = EXACT_TORUS.contacts(points, 0.1).array
    answers = [None] * 8

    def compute(i):
        answers[i] = EXACT_TORUS.contacts(points, 0.1).array

    threads = [threading.Thread(target=compute, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((answer == expected).all() for answer in answers)


def test_a_map_says_what_it_is():
    assert repr(EXACT_TORUS) == f"<echinus.ExactMap: 720 faces, {EXACT_TORUS.byte_count} bytes>"
    assert EXACT_TORUS.radius == pytest.approx(1.4, rel=1e-5)
    assert EXACT_TORUS.centre == pytest.approx((0, 0, 0), abs=1e-6)
    assert json.dumps(EXACT_TORUS.statistics.__dict__)
