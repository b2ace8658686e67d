"""The programs that the documents show run as they stand, and draw the pictures of docs/python.md.

    python3 tests/python/test_first_lines.py FOLDER    writes the pictures into the folder
"""

import os
import pathlib
import shutil
import sys
import tempfile

import numpy as np
import pytest

import echinus as ech
from support import ROOT, programs_of

HORSE = ROOT / "models" / "horse.3ds"
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


def prepare(folder):
    """A folder as the documents suppose it: a horse, a scene, and its model."""
    horse, _ = ech.repair(ech.read_mesh(HORSE))
    ech.write_mesh(folder / "horse.obj", horse)
    shutil.copytree(ROOT / "scenes", folder / "scenes")
    (folder / "models").mkdir()
    shutil.copy(HORSE, folder / "models")


def run_guide():
    """One program after the other, as in one session."""
    os.environ.setdefault("MPLBACKEND", "agg")
    names = {}
    for program in programs_of("docs/python.md"):
        exec(program, names)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    if not HORSE.exists():
        pytest.skip("models/ has no horse: scripts/setup fetches it")
    prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_lines_that_were_promised_run(folder):
    points = np.random.default_rng(1).uniform(-1, 1, (1000, 3))
    names = {"points": points, "start": points, "end": points + 1}
    exec(LINES, names)
    assert names["sim"].frame == 1 and len(names["sim"].positions) == 10_000
    assert (folder / "horse.ech").exists()


def test_the_lines_of_the_readme_run(folder):
    (lines,) = programs_of("README.md")
    names = {}
    exec(lines, names)
    assert names["inside"].any() and np.array_equal(names["distance"] < 0, names["inside"])


def test_the_programs_of_the_guide_run_one_after_the_other(folder):
    run_guide()
    assert {path.name for path in folder.glob("*.png")} == {
        "python_distance.png",
        "python_cloth.png",
        "python_soft_body.png",
    }
    assert np.load("horse_labels.npz")["occupancy"].shape == (100_000,)


if __name__ == "__main__":
    images = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder)
        os.chdir(folder)
        run_guide()
        for picture in folder.glob("python_*.png"):
            shutil.copy(picture, images)
