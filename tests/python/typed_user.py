"""Code of a user, for mypy --strict: what the package says about its types is enough, and it is right."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from typing_extensions import assert_type

import echinus as ech


def labels(path: str, count: int) -> NDArray[np.bool_]:
    mesh = ech.read_mesh(path)
    points = np.random.default_rng(1).uniform(-1, 1, (count, 3))
    exact = ech.ExactMap(mesh, rule="parity")
    sampled = ech.DistanceMap(mesh, directions=(100, 100), grid="ellipsoidal")
    assert_type(exact.contacts(points).normal, NDArray[np.float32])
    assert_type(exact.signed_distance(points), NDArray[np.float32])
    assert_type(exact.signed_distance(points, gradient=True), tuple[NDArray[np.float32], NDArray[np.float32]])
    assert_type(ech.load(path), ech.ExactMap | ech.DistanceMap)
    return exact.contains(points) & sampled.contains(points, threads=0)


def run(scene: dict[str, Any]) -> list[NDArray[np.float32]]:
    simulation = ech.Simulation.from_scene(scene, surface_collision=True)
    frames = []
    try:
        while not simulation.at_rest and simulation.profile.lost_count == 0:
            simulation.step()
            frames.append(simulation.positions.copy())
    except ech.Error as error:
        assert error.code == "diverged"
    return frames


ech.ExactMap(ech.make_torus(), rule="odd")  # type: ignore[arg-type]
ech.ExactMap(3)  # type: ignore[arg-type]
