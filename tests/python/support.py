"""Shared by several tests: meshes, points around them, and the C++ program."""

import os
import pathlib
import re
import subprocess

import numpy as np
import pytest

import echinus as ech

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED_MESHES = ROOT / (os.environ.get("ECHINUS_SHARED") or "../shared") / "meshes"


def programs_of(document):
    """The programs in Python that a document shows."""
    return re.findall(r"^```python\n(.*?)^```", (ROOT / document).read_text(), re.MULTILINE | re.DOTALL)


def torus():
    return ech.make_torus(1, 0.4, 30, 12)


def points_around(mesh, count, seed=1):
    """Half of them anywhere in the bounding box and a little beyond, half within 2 % of a vertex."""
    random = np.random.default_rng(seed)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    anywhere = random.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low), (count // 2, 3))
    vertices = mesh.vertices[random.integers(len(mesh.vertices), size=count - count // 2)]
    near = vertices + random.normal(size=vertices.shape) * 0.02 * (high - low).max()
    return np.concatenate([anywhere, near]).astype(np.float32)


def open_torus():
    """Without the upper half: in the trench the winding number is near a half."""
    mesh = torus()
    is_above = (mesh.vertices[mesh.faces][:, :, 2] > 0.1).all(axis=1)
    return ech.Mesh(mesh.vertices, mesh.faces[~is_above])


def run_program(*arguments):
    """The C++ program, whose answers are those of the library without Python."""
    program = os.environ.get("ECHINUS_PROGRAM", ROOT / "build" / "release" / "tools" / "echinus")
    if not pathlib.Path(program).exists():
        pytest.skip("the program is not built; ECHINUS_PROGRAM may name it")
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def same_answers(a, b):
    """Are two structured arrays equal, NaN to NaN? Bytes between the fields may differ."""
    return all(np.array_equal(a[name], b[name], equal_nan=a[name].dtype.kind == "f") for name in a.dtype.names)
