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
    simulation = ech.Simulation.from_scene(scene, collision="surfaces_and_self")
    frames = []
    try:
        while not simulation.at_rest and simulation.profile.lost_count == 0:
            simulation.step()
            frames.append(simulation.positions.copy())
    except ech.Error as error:
        assert error.code == "diverged"
    return frames


def drop(path: str) -> list[ech.Load]:
    organ = ech.read_tetrahedra(path).mesh
    assert_type(organ.tetrahedra, NDArray[np.uint32])
    filled = ech.tetrahedralize(ech.ExactMap(ech.boundary(organ)), count=1000).mesh
    body = ech.make_soft_body(filled, young_modulus=5e3, pins=np.arange(3), position=np.zeros(3).tolist())
    table = ech.Collider(ech.ExactMap(ech.make_box()), position=(0, 0, -1), scale=2)
    both = ech.combine([body, ech.passing_through(0, ech.with_masses_times(0.1, ech.make_cloth(position=[0, 0, 1])))])
    simulation = ech.Simulation(both, [table, table], solver="newton", stretch_stiffness=500)
    simulation.set_collider_keyframes(0, [ech.PoseKey(1, (0, 0, 0), ech.rotation_about((0, 0, 1), 1))])
    simulation.set_collider_cache(1, ech.VertexCache(np.zeros((2, 8, 3)), 0.1))
    assert_type(ech.embed(filled, organ.vertices).carry(simulation.positions), NDArray[np.float32])
    return [simulation.load_on(0), simulation.load_on(1)]


ech.Simulation(ech.make_cloth(), solver="jacobi")  # type: ignore[arg-type]
ech.Collider(ech.make_torus())  # type: ignore[arg-type]
ech.ExactMap(ech.make_torus(), rule="odd")  # type: ignore[arg-type]
ech.ExactMap(3)  # type: ignore[arg-type]
