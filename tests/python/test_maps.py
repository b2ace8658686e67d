"""Answers of maps, against brute force over all faces and against the C++ program."""

import copy
import json
import multiprocessing
import pickle
import threading

import numpy as np
import pytest

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


EXACT_TORUS = ech.ExactMap(torus())


def test_a_sweep_broadcasts_its_ends():
    ends = points_around(torus(), 100)
    hits = EXACT_TORUS.sweep([0, 0, 0], ends)
    assert (hits.array == EXACT_TORUS.sweep(np.zeros_like(ends), ends, threads=0).array).all()
    assert EXACT_TORUS.sweep(np.zeros((4, 1, 3)), np.zeros((5, 3))).fraction.shape == (4, 5)
    with pytest.raises(ValueError, match=r"start and end must have compatible shapes, not \(4, 3\) and \(5, 3\)"):
        EXACT_TORUS.sweep(np.zeros((4, 3)), np.zeros((5, 3)))


def test_a_map_is_built_with_every_option_and_answers_by_it():
    both = ech.Mesh(np.concatenate([ech.make_box((2, 2, 2)).vertices, ech.make_box().vertices]), np.concatenate([ech.make_box().faces, ech.make_box().faces + 8]))
    assert ech.ExactMap(both).contains([0.1, 0, 0]) and not ech.ExactMap(both, rule="parity").contains([0.1, 0, 0])
    assert ech.ExactMap(torus(), cells_per_octant=4096, centre="search").byte_count > EXACT_TORUS.byte_count
    assert ech.ExactMap(torus(), budget=200_000).byte_count <= 200_000
    few, many = ech.DistanceMap(torus(), (20, 20)), ech.DistanceMap(torus(), directions=(200, 200), correction="none", pole_axis="x")
    assert few.byte_count < many.byte_count / 50
    assert ech.DistanceMap(torus(), grid="cube", divisions=50, entries="unorm16").byte_count < many.byte_count
    with pytest.raises(ech.Error, match="map.directions is 20; it must be an array of 2"):
        ech.DistanceMap(torus(), 20)


def test_each_instruction_set_is_used_that_is_named_and_gives_the_same_answers():
    points = points_around(torus(), 5000)
    before, contacts = ech.instruction_set(), EXACT_TORUS.contacts(points, 0.05)
    try:
        for name in ech.available_instruction_sets():
            ech.use_instruction_set(name)
            assert ech.instruction_set() == name
            assert (EXACT_TORUS.contacts(points, 0.05).array == contacts.array).all()
    finally:
        ech.use_instruction_set(before)


def test_the_answers_are_views_of_one_array():
    contacts = EXACT_TORUS.contacts(points_around(torus(), 10))
    for name in ("inside", "depth", "normal", "point", "face", "certain", "feature"):
        assert np.shares_memory(getattr(contacts, name), contacts.array), name


# ---- Building


@pytest.mark.parametrize("value", [np.nan, np.float32(np.inf)])
def test_a_number_that_is_not_finite_is_refused_by_its_key(value):
    with pytest.raises(ValueError, match="budget must be finite"):
        ech.ExactMap(torus(), budget=value)
    with pytest.raises(ValueError, match=r"centre\[1\] must be finite"):
        ech.ExactMap(torus(), centre=[0, value, 0])


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
