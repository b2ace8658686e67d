"""Meshes from arrays and files, their reports and repairs."""

import pickle
import types

import numpy as np
import pytest
from hypothesis import given, strategies
from hypothesis.extra import numpy as arrays

import echinus as ech
from support import open_torus, points_around, torus

TETRAHEDRON = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def test_a_mesh_is_made_of_lists():
    mesh = ech.Mesh(*TETRAHEDRON)
    assert mesh.vertices.dtype == np.float32 and mesh.faces.dtype == np.uint32
    assert ech.inspect(mesh).closed
    assert ech.inspect(mesh).signed_volume == pytest.approx(1 / 6)
    assert repr(mesh) == "<echinus.Mesh: 4 vertices, 4 faces>"


def test_arrays_of_the_right_types_are_shared_and_cannot_be_written_through_the_mesh():
    vertices, faces = np.array(TETRAHEDRON[0], np.float32), np.array(TETRAHEDRON[1], np.uint32)
    mesh = ech.Mesh(vertices, faces)
    assert np.shares_memory(mesh.vertices, vertices) and np.shares_memory(mesh.faces, faces)
    assert vertices.flags.writeable and not mesh.vertices.flags.writeable
    with pytest.raises(ValueError):
        mesh.vertices[0] = 1


def test_a_mesh_outlives_the_file_that_it_was_read_from(tmp_path):
    ech.write_mesh(tmp_path / "torus.obj", torus())
    vertices = ech.read_mesh(tmp_path / "torus.obj").vertices
    assert np.array_equal(vertices.copy(), vertices)


@pytest.mark.parametrize("extension", ["obj", "ply", "off", "stl"])
def test_a_mesh_that_was_written_reads_back(extension, tmp_path):
    path = tmp_path / f"torus.{extension}"
    ech.write_mesh(path, torus())
    again = ech.read_mesh(str(path))
    assert np.array_equal(again.vertices[again.faces], torus().vertices[torus().faces])


def test_anything_with_vertices_and_faces_is_a_mesh():
    theirs = types.SimpleNamespace(vertices=torus().vertices.astype(np.float64), faces=torus().faces.astype(np.int64))
    assert ech.ExactMap(theirs).source_hash == ech.ExactMap(torus()).source_hash
    assert ech.inspect(theirs) == ech.inspect(torus())
    with pytest.raises(TypeError, match="a mesh has .vertices and .faces; list does not"):
        ech.ExactMap([1, 2, 3])


def test_a_pickled_mesh_is_the_same():
    again = pickle.loads(pickle.dumps(torus()))
    assert np.array_equal(again.vertices, torus().vertices) and np.array_equal(again.faces, torus().faces)


@pytest.mark.parametrize(
    "vertices, faces, error, sentence",
    [
        (np.zeros((3, 2)), [[0, 1, 2]], ValueError, r"vertices must have the shape \(n, 3\), not \(3, 2\)"),
        (np.zeros(3), [[0, 1, 2]], ValueError, "vertices must have the shape"),
        (np.zeros((3, 3), complex), [[0, 1, 2]], TypeError, "vertices must be an array of real numbers"),
        (np.zeros((3, 3)), [[0, 1, 2, 3]], ValueError, "cut polygons into triangles first"),
        (np.zeros((3, 3)), [0, 1, 2], ValueError, "faces must have the shape"),
        (np.zeros((3, 3)), [[0.0, 1, 2]], TypeError, "faces must be an array of whole numbers"),
        (np.zeros((3, 3)), [[0, 1, 2], [0, 1, -1]], ValueError, "face 1 names the vertex -1"),
        (np.zeros((3, 3)), [[0, 1, 2**32]], ValueError, "face 0 names the vertex 4294967296"),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(vertices, faces, error, sentence):
    with pytest.raises(error, match=sentence):
        ech.Mesh(vertices, faces)


@pytest.mark.parametrize(
    "vertices, faces",
    [
        (np.zeros((3, 3)), [[0, 1, 3]]),
        (np.zeros((3, 3)), np.zeros((0, 3), int)),
        (np.full((3, 3), np.nan), [[0, 1, 2]]),
        ([[0, 0, 0], [1e39, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    ],
)
def test_what_reads_a_mesh_refuses_an_invalid_one(vertices, faces):
    mesh = ech.Mesh(vertices, faces)
    calls = [
        lambda: ech.inspect(mesh),
        lambda: ech.repair(mesh),
        lambda: ech.ExactMap(mesh),
        lambda: ech.DistanceMap(mesh),
        lambda: ech.winding_number(mesh, [0, 0, 0]),
        lambda: ech.unsigned_distance(mesh, [0, 0, 0]),
        lambda: ech.self_intersecting_pairs(mesh),
        lambda: ech.intersecting_pairs(torus(), mesh),
    ]
    for call in calls:
        with pytest.raises(ech.Error) as raised:
            call()
        assert raised.value.code == "invalid_mesh"


@given(
    arrays.arrays(np.float32, strategies.tuples(strategies.integers(0, 8), strategies.just(3)), elements=strategies.floats(width=32)),
    arrays.arrays(np.int64, strategies.tuples(strategies.integers(0, 8), strategies.just(3)), elements=strategies.integers(-1, 9)),
)
def test_any_arrays_give_a_map_or_an_error(vertices, faces):
    try:
        m = ech.ExactMap(ech.Mesh(vertices, faces), threads=1)
    except (ech.Error, ValueError):
        return
    assert m.contains(np.full((10, 3), 1e30)).sum() == 0


def test_the_faults_of_a_mesh_are_counted_with_their_faces():
    report = ech.inspect(open_torus())
    assert not report.closed and report.border_edges.count > 0
    assert report.border_edges.first_faces == tuple(sorted(report.border_edges.first_faces))


def test_repairs_are_done_and_reported():
    mesh = torus()
    faulty = ech.Mesh(mesh.vertices, np.concatenate([mesh.faces, mesh.faces[:3]])[:, ::-1])
    mended, report = ech.repair(faulty)
    assert report.duplicate_faces_dropped == (720, 721, 722) and report.components_flipped == 1
    assert report.changed_anything and ech.inspect(mended).closed
    same, nothing = ech.repair(faulty, drop_duplicate_faces=False, drop_doubled_patches=False, flip_inside_out=False)
    assert not nothing.changed_anything and np.array_equal(same.faces, faulty.faces)


def test_a_repair_closes_seams_and_turns_faces():
    mesh = torus()
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)  # each face with corners of its own
    faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    faces[::3] = faces[::3, ::-1]
    torn = ech.Mesh(corners + np.float32([1e-7, 0, 0]) * (np.arange(len(corners)) % 2)[:, None], faces)
    mended, report = ech.repair(torn)
    assert report.vertices_welded == len(corners) - len(mesh.vertices) and report.faces_turned == len(faces[::3])
    assert report.changed_anything and ech.inspect(mended).closed and ech.inspect(mended).orientable
    assert not ech.inspect(ech.repair(torn, orient_faces=False)[0]).closed

    box = ech.make_box((1, 1, 1))
    vertices = np.concatenate([box.vertices, box.vertices[box.faces[0, :1]] + np.float32([0, 0, 1e-3])])
    cracked = ech.Mesh(vertices, np.concatenate([[[8, *box.faces[0, 1:]]], box.faces[1:]]))
    assert not ech.inspect(ech.repair(cracked)[0]).closed
    assert ech.inspect(ech.repair(cracked, weld_distance=2e-3)[0]).closed
    with pytest.raises(ech.Error, match="welded within 9"):
        ech.repair(cracked, weld_distance=9)


def test_a_mesh_is_made_solid_on_request():
    mesh = torus()
    holed = ech.Mesh(mesh.vertices, mesh.faces[5:])
    assert not ech.inspect(ech.repair(holed)[0]).closed
    filled, report = ech.repair(holed, close_holes=16)
    assert report.holes_closed >= 1 and report.holes_left == 0 and report.changed_anything
    assert ech.inspect(filled).closed and np.array_equal(filled.faces[: len(holed.faces)], holed.faces)

    engine = ech.make_box((0.1, 0.1, 0.1))
    vertices = np.concatenate([mesh.vertices, engine.vertices + np.float32([1, 0, 0])])
    car = ech.Mesh(vertices, np.concatenate([mesh.faces, engine.faces + np.uint32(len(mesh.vertices))]))
    body, report = ech.repair(car, drop_inner_faces=True)
    assert report.inner_faces_dropped == tuple(range(len(mesh.faces), len(car.faces)))
    assert np.array_equal(body.faces, mesh.faces)

    sheet = ech.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    plate, report = ech.repair(sheet, sheet_thickness=0.1)
    assert report.sheets_thickened == 1 and report.faces_added == 7
    assert ech.inspect(plate).signed_volume == pytest.approx(0.05)
    assert ech.ExactMap(plate).contains([[0.2, 0.2, 0.04], [0.2, 0.2, 0.06]]).tolist() == [True, False]


def test_an_impossible_repair_is_an_error():
    sheet = ech.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(ValueError, match="close_holes"):
        ech.repair(sheet, close_holes=-1)
    with pytest.raises(ech.Error, match="holes of up to 257 edges"):
        ech.repair(sheet, close_holes=257)
    for thickness in (-1, np.nan, np.inf, 1e-9, 100):
        with pytest.raises(ech.Error, match="thickness") as raised:
            ech.repair(sheet, sheet_thickness=thickness)
        assert raised.value.code == "invalid_options"


def test_welding_joins_equal_positions():
    mesh = torus()
    soup = ech.Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    assert ech.inspect(soup).closed  # seams without width are none
    assert ech.inspect(ech.weld(soup)).closed and len(ech.weld(soup).vertices) == len(mesh.vertices)


def test_intersections_are_listed_by_pairs():
    box = ech.make_box()
    moved = ech.Mesh(box.vertices + np.float32(0.5), box.faces)
    pairs = ech.intersecting_pairs(box, moved)
    assert pairs.shape[1] == 2 and len(pairs) > 0
    assert len(ech.self_intersecting_pairs(box)) == 0
    assert len(ech.intersecting_pairs(box, ech.Mesh(box.vertices + np.float32(3), box.faces))) == 0


def test_the_judges_keep_leading_dimensions_and_say_what_nan_is():
    points = points_around(torus(), 60).reshape(3, 20, 3)
    assert ech.winding_number(torus(), points).shape == (3, 20)
    assert np.array_equal(ech.unsigned_distance(torus(), points, threads=0), ech.unsigned_distance(torus(), points))
    assert np.isnan(ech.winding_number(torus(), [np.nan, 0, 0]))
    assert ech.unsigned_distance(torus(), [np.nan, 0, 0]) == np.inf


def test_generators_refuse_what_is_no_shape():
    for call in (lambda: ech.make_torus(1, 2), lambda: ech.make_sphere(-1), lambda: ech.make_box((0, 1, 1))):
        with pytest.raises(ech.Error) as raised:
            call()
        assert raised.value.code == "invalid_options"


def test_generators_name_the_size_that_is_too_large():
    for call, words in (
        (lambda: ech.make_torus(np.inf, 1), "the major radius of a torus is inf"),
        (lambda: ech.make_sphere(1e39), "the radius of a sphere is 1e[+]39; it must be positive and finite"),
        (lambda: ech.make_box((1, np.inf, 1)), "the edge length of a box is inf"),
    ):
        with pytest.raises(ech.Error, match=words):
            call()


def test_an_error_names_the_file(tmp_path):
    (tmp_path / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    for name, code in {"bad.obj": "invalid_mesh", "absent.obj": "unreadable", "model.xyz": "wrong_format"}.items():
        with pytest.raises(ech.Error, match=name) as raised:
            ech.read_mesh(tmp_path / name)
        assert raised.value.code in (code, "unreadable"), name
    with pytest.raises(ech.Error) as raised:
        ech.write_mesh(tmp_path / "no folder" / "a.obj", torus())
    assert raised.value.code == "unwritable"


def test_a_name_that_is_not_utf_8_is_shown_as_python_shows_it(tmp_path):
    with pytest.raises(ech.Error) as raised:
        ech.read_mesh(bytes(tmp_path) + b"/\xff.obj")
    assert "\udcff.obj" in str(raised.value)


def test_errors_pickle():
    error = pickle.loads(pickle.dumps(ech.Error("a sentence", "damaged")))
    assert str(error) == "a sentence" and error.code == "damaged"
