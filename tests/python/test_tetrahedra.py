"""Bodies of tetrahedra: made, read, written, reported, and followed by finer points."""

import pickle

import numpy as np
import pytest

import echinus as ech
from support import torus

CORNER = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1, 3]]


def body_of_torus(**options):
    return ech.tetrahedralize(ech.ExactMap(torus()), **options)


def same(a, b):
    return np.array_equal(a.vertices, b.vertices) and np.array_equal(a.tetrahedra, b.tetrahedra)


def refusal(call, *arguments, **options):
    with pytest.raises(ech.Error) as raised:
        call(*arguments, **options)
    return raised.value.code, str(raised.value)


def test_a_body_is_made_of_lists_and_shares_arrays_of_the_right_types():
    mesh = ech.TetrahedralMesh(*CORNER)
    assert mesh.vertices.dtype == np.float32 and mesh.tetrahedra.dtype == np.uint32
    assert repr(mesh) == "<echinus.TetrahedralMesh: 4 vertices, 1 tetrahedra>"
    vertices, tetrahedra = np.array(CORNER[0], np.float32), np.array(CORNER[1], np.uint32)
    shared = ech.TetrahedralMesh(vertices, tetrahedra)
    assert np.shares_memory(shared.vertices, vertices) and np.shares_memory(shared.tetrahedra, tetrahedra)
    assert not shared.tetrahedra.flags.writeable and tetrahedra.flags.writeable
    assert same(pickle.loads(pickle.dumps(mesh)), mesh)


def test_the_report_of_a_corner_of_a_cube_is_that_of_geometry():
    mesh = ech.TetrahedralMesh(CORNER[0], [[0, 1, 2, 3]])
    ech.require_valid_tetrahedra(mesh)
    report = ech.inspect_tetrahedra(mesh)
    assert report.tetrahedron_count == 1 and report.vertex_count == 4
    assert report.volume == report.least_volume == pytest.approx(1 / 6)
    assert (report.shortest_edge, report.longest_edge) == pytest.approx((1, np.sqrt(2)))
    assert report.least_angle_deg == pytest.approx(np.degrees(np.arccos(1 / np.sqrt(3))))
    assert report.greatest_angle_deg == pytest.approx(90)
    assert report.boundary.closed and report.boundary.signed_volume == pytest.approx(1 / 6)


def test_a_torus_is_filled_by_as_many_tetrahedra_as_were_asked_for():
    made = body_of_torus(count=3000)
    assert len(made.mesh.tetrahedra) == pytest.approx(3000, rel=0.1)
    report = ech.inspect_tetrahedra(made.mesh)
    assert 9.3 <= report.least_angle_deg and report.greatest_angle_deg <= 161.7
    assert report.boundary.closed and report.boundary.manifold
    assert report.volume == pytest.approx(ech.inspect(torus()).signed_volume, rel=0.05)
    assert same(body_of_torus(size=made.size, threads=2).mesh, made.mesh)
    distance = ech.measure_distance(made.mesh, ech.ExactMap(torus()))
    assert 0 < distance.mean_to_model < distance.greatest_to_model < made.size
    assert 0 < distance.mean_to_boundary < distance.greatest_to_boundary < made.size


def test_a_boundary_is_a_closed_mesh_for_maps():
    box = ech.make_solid_box((2, 1, 1), (4, 2, 2))
    surface = ech.boundary(box)
    assert np.array_equal(surface.vertices, box.vertices)
    assert ech.inspect(surface).signed_volume == pytest.approx(2)
    assert ech.ExactMap(surface).contains([[0.99, 0, 0], [1.01, 0, 0]]).tolist() == [True, False]


@pytest.mark.parametrize("extension", ["msh", "vtk"])
def test_what_is_written_reads_back_with_the_same_bits(tmp_path, extension):
    made = body_of_torus(size=0.2).mesh
    ech.write_tetrahedra(tmp_path / f"torus.{extension}", made)
    read = ech.read_tetrahedra(tmp_path / f"torus.{extension}")
    assert same(read.mesh, made) and read.turned_tetrahedra == read.dropped_vertices == 0


def test_a_file_of_tetgen_tells_what_was_changed(tmp_path):
    (tmp_path / "a.node").write_text("5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 9 9 9\n")
    (tmp_path / "a.ele").write_text("1 4 0\n1 1 3 2 4\n")
    read = ech.read_tetrahedra(tmp_path / "a.ele")
    assert (read.turned_tetrahedra, read.dropped_vertices) == (1, 1)


def test_files_that_are_none_are_refused(tmp_path):
    assert refusal(ech.read_tetrahedra, tmp_path / "none.msh")[0] == "unreadable"
    (tmp_path / "torn.msh").write_text("$MeshFormat\n")
    code, sentence = refusal(ech.read_tetrahedra, tmp_path / "torn.msh")
    assert code in ("damaged", "wrong_format") and sentence.startswith(str(tmp_path / "torn.msh"))
    assert refusal(ech.write_tetrahedra, tmp_path / "a.obj", ech.TetrahedralMesh(*CORNER))[0] == "wrong_format"
    inverted = ech.TetrahedralMesh(*CORNER)
    assert refusal(ech.write_tetrahedra, tmp_path / "a.msh", inverted)[0] == "invalid_mesh"
    assert not (tmp_path / "a.msh").exists()


def test_embedded_points_go_along_with_every_affine_motion():
    body = body_of_torus(size=0.2).mesh
    points = torus().vertices
    embedding = ech.embed(body, points)
    assert len(embedding) == len(points) and embedding.vertices.shape == (len(points), 4)
    assert np.allclose(embedding.weights.sum(axis=1), 1, atol=1e-5)
    turn = np.array([[0.5, -2, 0], [1, 0.3, 0.1], [0, 0, 3]], np.float32)
    moved = embedding.carry(body.vertices @ turn.T + 4)
    assert np.allclose(moved, points @ turn.T + 4, atol=1e-4)
    kept = np.empty_like(moved)
    assert embedding.carry(body.vertices @ turn.T + 4, out=kept, threads=2) is kept
    assert np.array_equal(kept, moved)


def test_positions_of_another_body_carry_nothing():
    embedding = ech.embed(ech.make_solid_box(), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="8 vertices; there are 7"):
        embedding.carry(np.zeros((7, 3)))
    with pytest.raises(ValueError, match="out must be"):
        embedding.carry(np.zeros((8, 3)), out=np.zeros((3, 3), np.float32))
    assert refusal(ech.embed, ech.make_solid_box(), [[np.nan, 0, 0]])[0] == "invalid_mesh"
    with pytest.raises(TypeError, match=r"embed\(\)"):
        ech.Embedding()
