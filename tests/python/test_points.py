"""Arrays of points: every layout and type gives the answers of a plain float32 array, or a clear error."""

import pickle
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, strategies
from hypothesis.extra import numpy as arrays

import echinus as ech
from support import points_around, same_answers, torus

MAP = ech.ExactMap(torus())
POINTS = points_around(torus(), 3000)
INSIDE = MAP.contains(POINTS)


def as_field_of_structs(points):
    structs = np.zeros(len(points), [("id", "i4"), ("position", "f4", 3), ("weight", "f8")])
    structs["position"] = points
    return structs["position"]


def misaligned(points):
    packed = np.zeros(len(points), np.dtype([("flag", "u1"), ("position", "f4", 3)], align=False))
    packed["position"] = points
    return packed["position"]


LAYOUTS = {
    "plain": lambda p: p,
    "every second of twice as many": lambda p: np.repeat(p, 2, axis=0)[::2],
    "first three of four columns": lambda p: np.hstack([p, p[:, :1]])[:, :3],
    "column by column": np.asfortranarray,
    "backwards": lambda p: p[::-1].copy()[::-1],
    "coordinates backwards": lambda p: p[:, ::-1].copy()[:, ::-1],
    "field of structs": as_field_of_structs,
    "misaligned": misaligned,
    "other byte order": lambda p: p.astype(">f4"),
    "float64": lambda p: p.astype(np.float64),
    "long double": lambda p: p.astype(np.longdouble),
    "list": lambda p: p.tolist(),
    "read-only": lambda p: np.frombuffer(p.tobytes(), np.float32).reshape(-1, 3),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_layout_of_the_points_does_not_change_an_answer(layout):
    points = LAYOUTS[layout](POINTS)
    assert (MAP.contains(points) == INSIDE).all()
    assert (MAP.contacts(points, 0.1).array == MAP.contacts(POINTS, 0.1).array).all()
    assert np.array_equal(MAP.signed_distance(points), MAP.signed_distance(POINTS))


def test_large_answers_are_their_own_and_what_replaces_them_is_right():
    many = np.tile(POINTS, (30, 1))  # answers of 4 MB, whose memory waits for the next ones
    first = MAP.contacts(many)
    kept = first.depth
    second = MAP.contacts(many[::-1])
    assert not np.shares_memory(first.array, second.array)
    assert np.array_equal(second.depth, kept[::-1])
    address = first.array.ctypes.data
    del first
    third = MAP.contacts(many + 1)
    assert third.array.ctypes.data != address  # a view still has it
    assert np.array_equal(kept, np.tile(MAP.contacts(POINTS).depth, 30))
    del kept
    fourth = MAP.contacts(many)
    assert fourth.array.ctypes.data == address
    assert (fourth.array == np.tile(MAP.contacts(POINTS).array, 30)).all()
    fourth.array["depth"] = 0  # it can be written to


@pytest.mark.parametrize("shape", [(3000,), (30, 100), (2, 3, 500), (3000, 1), (1, 3000)])
def test_leading_dimensions_are_kept(shape):
    points = POINTS.reshape(*shape, 3)
    assert np.array_equal(MAP.contains(points), INSIDE.reshape(shape))
    contacts = MAP.contacts(points)
    assert contacts.depth.shape == shape and contacts.normal.shape == (*shape, 3)


def test_leading_dimensions_may_be_strided():
    blocks = POINTS.reshape(30, 100, 3)
    assert np.array_equal(MAP.contains(blocks[::2, ::3]), INSIDE.reshape(30, 100)[::2, ::3])
    assert np.array_equal(MAP.contains(blocks.transpose(1, 0, 2)), INSIDE.reshape(30, 100).T)


def test_a_single_point_has_a_single_answer():
    assert MAP.contains([1, 0, 0]).shape == ()
    assert MAP.contains([1, 0, 0]) and not MAP.contains([0, 0, 0])
    assert MAP.contacts([1, 0, 0]).normal.shape == (3,)


def test_one_point_repeated_without_memory_is_read_in_place():
    assert MAP.contains(np.broadcast_to(np.float32([1, 0, 0]), (1000, 3))).all()


@pytest.mark.parametrize("shape", [(0, 3), (5, 0, 3)])
def test_no_points_have_no_answers(shape):
    points = np.zeros(shape, np.float32)
    assert MAP.contains(points).shape == shape[:-1]
    assert MAP.contacts(points).depth.shape == shape[:-1]
    assert MAP.sweep(points, points).fraction.shape == shape[:-1]
    distances, gradients = MAP.signed_distance(points, gradient=True)
    assert distances.shape == shape[:-1] and gradients.shape == shape


def test_half_precision_and_whole_numbers_are_real_numbers():
    assert np.array_equal(MAP.contains(POINTS.astype(np.float16)), MAP.contains(POINTS.astype(np.float16).astype(np.float32)))
    assert MAP.contains(np.array([[1, 0, 0], [0, 0, 0]], np.int64)).tolist() == [True, False]


def test_numbers_beyond_float32_are_outside_without_a_warning():
    assert not MAP.contains([[1e300, 0, 0]]).any()


def test_answers_go_where_out_says():
    out = np.ones(len(POINTS), bool)
    assert MAP.contains(POINTS, out=out) is out
    assert np.array_equal(out, INSIDE)


def test_points_that_out_overlaps_are_read_first():
    points = POINTS.copy()
    expected = MAP.signed_distance(POINTS)
    assert np.array_equal(MAP.signed_distance(points, out=points.ravel()[: len(points)]), expected)


def test_contacts_go_where_earlier_ones_were():
    contacts = MAP.contacts(POINTS)
    depth = contacts.depth
    again = MAP.contacts(POINTS + np.float32(0.01), 0.2, out=contacts)
    assert np.shares_memory(again.array, contacts.array)
    assert np.array_equal(depth, MAP.contacts(POINTS + np.float32(0.01), 0.2).depth)
    with pytest.raises(ValueError, match="out must be a writeable, contiguous array of type"):
        MAP.contacts(POINTS[1:], out=contacts)


@pytest.mark.parametrize(
    "out", [np.ones(2999, bool), np.ones(3000, np.uint8), np.ones(6000, bool)[::2], np.ones((3000, 1), bool), [True] * 3000]
)
def test_an_out_that_does_not_fit_is_refused(out):
    with pytest.raises(ValueError, match="out must be a writeable, contiguous array of type bool"):
        MAP.contains(POINTS, out=out)


def test_an_out_that_is_read_only_is_refused():
    out = np.ones(len(POINTS), bool)
    out.flags.writeable = False
    with pytest.raises(ValueError, match="out must be a writeable"):
        MAP.contains(POINTS, out=out)


@given(
    arrays.arrays(
        strategies.sampled_from([np.float32, np.float64, np.float16]),
        arrays.array_shapes(min_dims=1, max_dims=3, max_side=5).map(lambda shape: (*shape, 3)),
        elements=strategies.floats(width=16),
    ),
    strategies.floats(0, 2),
)
def test_points_of_any_values_and_shape_are_answered_as_one_by_one(points, margin):
    inside, contacts = MAP.contains(points), MAP.contacts(points, margin)
    assert inside.shape == contacts.array.shape == points.shape[:-1]
    for index in np.ndindex(inside.shape):
        assert inside[index] == MAP.contains(points[index])
        assert same_answers(contacts.array[index], MAP.contacts(points[index], margin).array[()])


@given(arrays.basic_indices((20, 30), allow_ellipsis=False))
def test_any_slice_of_points_is_answered_like_its_copy(index):
    points = POINTS[:600].reshape(20, 30, 3)[index]
    assert np.array_equal(MAP.contains(points), MAP.contains(points.copy()))


# Meshes in coordinates that float32 cannot hold, such as those of a country.

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


def test_files_tetrahedra_and_brute_force_take_them(place, tmp_path):
    box = ech.make_box((1, 2, 3))
    far = moved(box, place)
    ech.write_mesh(tmp_path / "far.ply", far)
    again = ech.read_mesh(tmp_path / "far.ply")
    assert again.vertices.dtype == np.float64
    assert np.abs(again.vertices[again.faces] - far.vertices[far.faces]).max() < 2e-7
    points = np.random.default_rng(2).uniform(-2, 2, (50, 3))
    assert np.allclose(ech.unsigned_distance(far, points + place), ech.unsigned_distance(box, points), atol=1e-6)
    assert np.allclose(ech.winding_number(far, points + place), ech.winding_number(box, points), atol=1e-5)
    body = ech.tetrahedralize(ech.ExactMap(far), size=0.4).mesh
    assert body.vertices.dtype == np.float64
    assert ech.measure_distance(body, ech.ExactMap(far)).greatest_to_model < 0.4


def test_float32_says_how_coarse_it_is_there():
    box = ech.make_box((1, 0.9, 0.8))
    rounded = ech.Mesh((box.vertices + np.array(PLACES["utm"])).astype(np.float32), box.faces)
    assert ech.inspect(rounded).rounding_step == 0.5
    assert ech.inspect(moved(box, PLACES["utm"])).rounding_step == 0


def test_simulations_refuse_them():
    far = moved(ech.make_box(), PLACES["utm"])
    with pytest.raises(ech.Error, match="is located around"):
        ech.Simulation(ech.make_cloth(), [ech.Collider(ech.ExactMap(far))])


def test_a_numpy_whose_arrays_the_module_cannot_read_is_refused():
    """Its answers were wrong without an error, and a million contacts ended the process."""
    program = "import numpy; numpy.__version__ = '2.4.6'; import echinus"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.returncode == 1
    assert "needs NumPy 1, but NumPy 2.4.6 is installed" in result.stderr
