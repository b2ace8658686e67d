"""The lines that the documents show first run as they stand."""

import numpy as np
import pytest

import guide

LINES = """
import echinus as ech
mesh = ech.read_mesh("horse.obj")              # or ech.Mesh(vertices, faces), or anything with .vertices and .faces
m = ech.ExactMap(mesh)                         # ech.DistanceMap(mesh, directions=(200, 200))
m.contains(points)                             # bool [n]
m.signed_distance(points)                      # float32 [n], for every point, however far; sign convention stated; gradient=True
m.contacts(points, margin=0.01)                # .inside .depth .normal .point .face .certain, arrays
m.sweep(start, end); m.save("horse.ech"); ech.load("horse.ech")
sim = ech.Simulation.from_scene("scenes/horse.json"); sim.step(); sim.positions      # a view, no copy
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    if not guide.HORSE.exists():
        pytest.skip("models/ has no horse: scripts/setup fetches it")
    guide.prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_lines_that_were_promised_run(folder):
    points = np.random.default_rng(1).uniform(-1, 1, (1000, 3))
    names = {"points": points, "start": points, "end": points + 1}
    exec(LINES, names)
    assert names["sim"].frame == 1 and len(names["sim"].positions) == 10_000
    assert (folder / "horse.ech").exists()


def test_the_lines_of_the_readme_run(folder):
    (lines,) = guide.programs_of("README.md")
    names = {}
    exec(lines, names)
    assert names["inside"].any() and np.array_equal(names["distance"] < 0, names["inside"])


def test_the_programs_of_the_guide_run_one_after_the_other(folder):
    guide.run_guide()
    assert {path.name for path in folder.glob("*.png")} == {
        "python_distance.png",
        "python_cloth.png",
        "python_soft_body.png",
    }
    assert np.load("horse_labels.npz")["occupancy"].shape == (100_000,)
