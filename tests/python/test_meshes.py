"""Meshes from arrays and files, their reports and repairs."""

import pickle
import types

import numpy as np
import pytest

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
    with pytest.raises(TypeError, match="mesh must have .vertices and .faces, which list has not: .* or echinus.read_mesh"):
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


def sheet_at(height):
    """A sheet of 20 x 20 vertices at the height that a function of x gives."""
    line = np.linspace(-0.6, 0.6, 20, dtype=np.float32)
    x, y = (grid.ravel() for grid in np.meshgrid(line, line))
    corners = np.array([[20 * i + j, 20 * i + j + 1, 20 * (i + 1) + j] for i in range(19) for j in range(19)])
    faces = np.concatenate([corners, np.stack([corners[:, 1], corners[:, 2] + 1, corners[:, 2]], axis=1)]).astype(np.uint32)
    return ech.Mesh(np.stack([x, y, height(x)], axis=1), faces)


def test_a_surface_is_parted_from_models_and_from_itself():
    sheet = sheet_at(lambda x: 0.1 + 0 * x)
    ball = ech.make_sphere(0.4, 24, 12)
    assert len(ech.intersecting_pairs(sheet, ball)) > 0
    parted = ech.part(sheet, [ball])
    assert parted.is_apart and parted.mesh.vertices.shape == sheet.vertices.shape
    assert not ech.ExactMap(ball).contains(parted.mesh.vertices).any()
    assert len(ech.intersecting_pairs(parted.mesh, ball)) == len(ech.self_intersecting_pairs(parted.mesh)) == 0
    assert parted.stretched_share < 0.02 and parted.largest_stretch < 0.1
    pinned = np.zeros(400, bool)
    pinned[190] = True  # inside the ball
    held = ech.part(sheet, [ball], pinned=pinned)
    assert not held.is_apart and 190 in held.inside
    assert np.array_equal(held.mesh.vertices[190], sheet.vertices[190])
    with pytest.raises(TypeError, match="pinned must be an array of booleans"):
        ech.part(sheet, pinned=[190])
    with pytest.raises(TypeError, match="mesh must be a mesh or a list of 1 to 256 meshes"):
        ech.part([])
    with pytest.raises(TypeError, match=r"models must be a list of meshes, such as \[body\]"):
        ech.part(sheet, ball)
    with pytest.raises(ech.Error, match="model 0: "):
        ech.part(sheet, [ech.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]])])


def test_layers_are_brought_into_the_order_in_which_they_are_given():
    lining, coat = sheet_at(lambda x: 0.05 * np.sin(9 * x)), sheet_at(lambda x: 0.05 * np.sin(9 * x + 2))
    assert len(ech.intersecting_pairs(lining, coat)) > 0
    for layers in ([lining, coat], [coat, lining]):
        parted = ech.part(layers)
        assert parted.is_apart and len(parted.meshes) == 2
        assert len(ech.intersecting_pairs(*parted.meshes)) == 0
        assert np.array_equal(np.concatenate([mesh.vertices for mesh in parted.meshes]), parted.mesh.vertices)
        assert np.array_equal(parted.meshes[1].faces, layers[1].faces)
        inner, outer = (mesh.vertices[:, 2].reshape(20, 20)[2:-2, 2:-2] for mesh in parted.meshes)
        assert (inner < outer).all()


def test_an_obj_whose_vertices_moved_keeps_its_other_statements(tmp_path):
    original, moved = tmp_path / "original.obj", tmp_path / "moved.obj"
    original.write_text("o dress\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1 4/1\n")
    mesh = ech.read_mesh(original)
    ech.write_mesh(moved, ech.Mesh(mesh.vertices + np.float32([0, 0, 2]), mesh.faces), original=original)
    assert moved.read_text() == "o dress\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nvt 0 0\nf 1/1 2/1 3/1 4/1\n"
    with pytest.raises(ech.Error, match="original.obj: the file has 4 vertices of faces"):
        ech.write_mesh(moved, ech.make_box(), original=original)


def test_meshes_are_checked_for_what_intersects_along_which_curves_and_how_deep():
    ball = ech.make_sphere(1, 60, 30)
    moved = ech.Mesh(ball.vertices + np.float32([1.5, 0, 0]), ball.faces)
    two = ech.intersections(ball, moved)
    assert np.array_equal(two.pairs, ech.intersecting_pairs(ball, moved))
    assert two.closed == (True,) and two.curves[0].shape[1] == 3 and two.curves[0].dtype == np.float32
    assert two.length == pytest.approx(2 * np.pi * np.sqrt(1 - 0.75**2), rel=0.01)
    assert np.abs(np.linalg.norm(two.curves[0], axis=1) - 1).max() < 0.02
    both = ech.Mesh(np.concatenate([ball.vertices, moved.vertices]), np.concatenate([ball.faces, moved.faces + len(ball.vertices)]))
    own = ech.intersections(both)
    assert len(own.pairs) == len(two.pairs) and own.length == pytest.approx(two.length)
    sheet = ech.Mesh([[-3, -3, 0.01], [3, -3, 0.01], [0, 6, 0.01]], [[0, 1, 2]])
    with_itself, with_sheet = sorted(ech.check([both, sheet]), key=lambda pair: pair.b)
    assert (with_itself.a, with_itself.b, with_itself.a_in_b) == (0, 0, None)
    assert (with_sheet.a, with_sheet.b, with_sheet.a_in_b) == (0, 1, None)  # no inside
    assert with_sheet.b_in_a == ech.Penetration(0, None, 0)
    (pair,) = ech.check([ball, moved], threads=1)
    assert pair.a_in_b.depth == pytest.approx(0.5, abs=0.01)
    assert moved.vertices[pair.b_in_a.deepest_vertex][0] == pytest.approx(0.5, abs=0.01)
    assert ech.check([]) == [] and ech.check([ball]) == []
    with pytest.raises(ech.Error, match="mesh 1: "):
        ech.check([ball, ech.Mesh([[0, 0, 0]], [[0, 0, 5]])])


def test_the_curves_of_meshes_far_from_0_are_in_their_frame():
    box = ech.make_box()
    far = ech.Mesh(np.concatenate([box.vertices, box.vertices + 0.5]) + np.float64([5e6, 0, 0]), np.concatenate([box.faces, box.faces + 8]))
    found = ech.intersections(far)
    assert found.curves[0].dtype == np.float64
    assert found.curves[0][:, 0].min() == pytest.approx(5e6, abs=0.01) and found.length == pytest.approx(3)


def test_the_judges_keep_leading_dimensions_and_say_what_nan_is():
    points = points_around(torus(), 60).reshape(3, 20, 3)
    assert ech.winding_number(torus(), points).shape == (3, 20)
    assert np.array_equal(ech.unsigned_distance(torus(), points, threads=0), ech.unsigned_distance(torus(), points))
    assert np.isnan(ech.winding_number(torus(), [np.nan, 0, 0]))
    assert ech.unsigned_distance(torus(), [np.nan, 0, 0]) == np.inf


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
